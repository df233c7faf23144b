/* The options that correct readings: see correction_options.h. */
#include "correction_options.h"

#include <stdlib.h>

#include "inputs.h"

/* The reference's factors: of a number, one row. */
static gonio_status read_reference(const tool *t, const char *text, gonio_reference_row **row,
                                   size_t *rows)
{
    char *end = NULL;
    const double factor = strtod(text, &end);
    if (*end != '\0') {
        return gonio_reference_read(t->context, text, row, rows);
    }
    if (!(factor > 0.0 && factor < 1e6)) {
        tool_refuse(t, "--reference-brf: '%s' is no reflectance factor above 0", text);
        return GONIO_ERROR_ARGUMENT;
    }
    *rows = 1;
    *row = calloc(1, sizeof **row);
    if (*row == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    (*row)->factor = factor;
    return GONIO_OK;
}

/* Reads a file, with values relative to a reference unless something else is said. */
static gonio_status read_one(const tool *t, const char *path, const gonio_readings_options *options,
                             const correction_options *o, gonio_readings **readings)
{
    gonio_readings_options how = *options;
    if (o->reference != NULL) { /* in place of the instrument's */
        how.as.values = GONIO_VALUE_RELATIVE;
        how.instrument = NULL;
    }
    return tool_read_readings(t, path, &how, readings);
}

static gonio_status subtract_blank(const tool *t, const gonio_readings_options *options,
                                   const correction_options *o, double noise, double floor,
                                   gonio_readings *readings)
{
    gonio_readings_options any = *options;
    gonio_readings *dark = NULL;
    any.values_needed = true;
    any.average_repeats = true;
    any.negative_to_zero = true;
    gonio_status status = read_one(t, o->blank, &any, o, &dark);
    if (status == GONIO_OK) {
        status = gonio_readings_subtract_blank(t->context, readings, dark, noise, floor);
    }
    gonio_readings_free(&dark);
    return status;
}

static gonio_status relate(const tool *t, const correction_options *o, gonio_readings *readings)
{
    gonio_reference_row *row = NULL;
    size_t rows = 0;
    gonio_status status = read_reference(t, o->reference, &row, &rows);
    if (status == GONIO_OK) {
        status = gonio_readings_times_reference(t->context, readings, row, rows);
    }
    free(row);
    return status;
}

gonio_status tool_read_corrected(const tool *t, const char *path,
                                 const gonio_readings_options *options, const correction_options *o,
                                 double noise, double floor, gonio_readings **readings)
{
    gonio_readings *made = NULL;
    gonio_status status = read_one(t, path, options, o, &made);
    if (status == GONIO_OK && o->blank != NULL) {
        status = subtract_blank(t, options, o, noise, floor, made);
    }
    if (status == GONIO_OK && o->reference != NULL) {
        status = relate(t, o, made);
    }
    if (status != GONIO_OK) {
        gonio_readings_free(&made);
        return status;
    }
    *readings = made;
    return GONIO_OK;
}
