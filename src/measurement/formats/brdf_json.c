/* Readings as BRDF JSON, the exchange format of national metrology institutes (BiRD, BxDiff;
 * Color Research and Application 47 (2022) 1177): columns of angles, wavelengths, polarisations and
 * values in the object `data`. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../import.h"
#include "../long_table.h"
#include "brdf_json.h"
#include "json_text.h"

enum { ANGLES = 4, MOST_CHANNELS = 4096 };

/* A column: an array of numbers, or one number for all rows. */
typedef struct column {
    const json_t *values; /* NULL: there is none */
    double scale;         /* to degrees; 1 */
} column;

typedef struct columns {
    column angle[ANGLES];
    column wavelength;
    column value;
    column deviation;
    const json_t *analysed; /* polarisations of what is detected */
    const json_t *channel;  /* names or numbers of channels without wavelengths; NULL: none */
    size_t channels;        /* of these */
    size_t rows;
    int wavelengths; /* gonio_wavelength_unit */
} columns;

/* ---- finding columns ---- */

static const json_t *values_of(const json_t *object)
{
    const json_t *values = gonio_i_json_member(object, "values");
    values = values != NULL ? values : gonio_i_json_member(object, "value");
    return json_is_array(object) || json_is_number(object) ? object : values;
}

static const char *unit_of(const json_t *object)
{
    const char *unit = json_string_value(gonio_i_json_member(object, "unit"));
    return unit != NULL ? unit : "";
}

static gonio_status find_angle(const gonio_i_readings_file *file, const json_t *data,
                               const char *name, column *c)
{
    const json_t *object = gonio_i_json_member(data, name);
    const char *unit = unit_of(object);
    c->values = values_of(object);
    c->scale = strncasecmp(unit, "rad", 3) == 0 ? 180.0 / M_PI : 1.0;
    if (c->values == NULL) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: no data.%s with values; theta_i, phi_i, theta_r and phi_r are "
                            "needed",
                            file->path, name);
    }
    if (c->scale == 1.0 && *unit != '\0' && strncasecmp(unit, "deg", 3) != 0 &&
        strcmp(unit, "\u00B0") != 0) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: data.%s: the unit '%.20s' is neither degrees nor radians",
                            file->path, name, unit);
    }
    return GONIO_OK;
}

/* The unit of a wavelength; 0 for one that is not known. */
static int wavelength_unit(const char *unit)
{
    return strcasecmp(unit, "nm") == 0 || *unit == '\0' ? GONIO_NANOMETRES
           : strcasecmp(unit, "um") == 0 || strcmp(unit, "\u00B5m") == 0 ||
                   strcmp(unit, "\u03BCm") == 0
               ? GONIO_MICROMETRES
           : strcmp(unit, "m") == 0 ? GONIO_METRES
                                    : GONIO_AS_STATED;
}

static gonio_status find_wavelength(const gonio_i_readings_file *file, const json_t *data,
                                    columns *c)
{
    const json_t *object = gonio_i_json_member(data, "wavelength_i");
    object = object != NULL ? object : gonio_i_json_member(data, "wavelength_r");
    object = object != NULL ? object : gonio_i_json_member(data, "wavelength");
    c->wavelength = (column){values_of(object), 1.0};
    c->wavelengths = wavelength_unit(unit_of(object));
    return c->wavelengths != GONIO_AS_STATED
               ? GONIO_OK
               : gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                              "%s: the unit '%.20s' of wavelengths is not known", file->path,
                              unit_of(object));
}

/* Expanded uncertainties are divided by their coverage factor, where it is stated. */
static void find_deviation(const json_t *data, const json_t *brdf, columns *c)
{
    const json_t *object = gonio_i_json_member(brdf, "uncertainty");
    object = object != NULL ? object : gonio_i_json_member(data, "uBRDF");
    const json_t *factor = gonio_i_json_member(object, "coverage_factor");
    factor = factor != NULL ? factor : gonio_i_json_member(object, "k");
    const double k = gonio_i_json_double(factor);
    c->deviation = (column){values_of(object), k > 0.0 ? 1.0 / k : 1.0};
}

/* R, G, B are 0, 1, 2; numbers are counted from 1. MOST_CHANNELS for what is neither. */
static size_t channel_at(const columns *c, size_t row)
{
    const json_t *entry = json_array_get(c->channel, row);
    const char *name = json_string_value(entry);
    const char *colour =
        name != NULL && name[0] != '\0' && name[1] == '\0' ? strchr("RGB", name[0]) : NULL;
    if (colour != NULL) {
        return *colour == 'R' ? 0 : *colour == 'G' ? 1 : 2;
    }
    const json_int_t number = json_integer_value(entry);
    return number >= 1 && number <= MOST_CHANNELS ? (size_t)number - 1 : MOST_CHANNELS;
}

/* The channels of a file without wavelengths: what gonio writes of colours and of sensors. */
static gonio_status find_channels(const gonio_i_readings_file *file, const json_t *data, columns *c)
{
    c->channel = c->wavelength.values == NULL
                     ? values_of(gonio_i_json_member(gonio_i_json_member(data, "adhoc_variables"),
                                                     "channel"))
                     : NULL;
    c->channels = c->wavelength.values == NULL ? 1 : 0;
    for (size_t k = 0; k < json_array_size(c->channel); k++) {
        const size_t channel = channel_at(c, k);
        if (channel == MOST_CHANNELS) {
            return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                                "%s: entry %zu: a channel is R, G, B or a number from 1",
                                file->path, k + 1);
        }
        const bool colour = json_is_string(json_array_get(c->channel, k));
        const size_t least = colour ? GONIO_CHANNELS : channel + 1;
        c->channels = least > c->channels ? least : c->channels;
    }
    return GONIO_OK;
}

/* As many rows as values; every other column has as many, or one number. */
static gonio_status check_lengths(const gonio_i_readings_file *file, columns *c)
{
    const column *const all[] = {&c->angle[0], &c->angle[1],   &c->angle[2],
                                 &c->angle[3], &c->wavelength, &c->deviation};
    static const char *const names[] = {"theta_i", "phi_i",      "theta_r",
                                        "phi_r",   "wavelength", "the uncertainty"};
    c->rows = json_array_size(c->value.values);
    if (c->channel != NULL && json_array_size(c->channel) != c->rows) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: %zu values of the BRDF, but %zu channels", file->path, c->rows,
                            json_array_size(c->channel));
    }
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        const json_t *values = all[k]->values;
        if (json_is_array(values) && json_array_size(values) != c->rows) {
            return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                                "%s: %zu values of the BRDF, but %zu of %s", file->path, c->rows,
                                json_array_size(values), names[k]);
        }
    }
    return GONIO_OK;
}

static gonio_status find_columns(const gonio_i_readings_file *file, const json_t *root, columns *c)
{
    static const char *const angles[ANGLES] = {"theta_i", "phi_i", "theta_r", "phi_r"};
    const json_t *data = gonio_i_json_member(root, "data");
    const json_t *brdf = gonio_i_json_member(data, "BRDF");
    gonio_status status = GONIO_OK;
    for (int k = 0; k < ANGLES && status == GONIO_OK; k++) {
        status = find_angle(file, data, angles[k], &c->angle[k]);
    }
    c->value = (column){values_of(brdf), 1.0};
    if (status == GONIO_OK && !json_is_array(c->value.values)) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT, "%s: no data.BRDF with values",
                            file->path);
    }
    if (status == GONIO_OK) {
        status = find_wavelength(file, data, c);
        find_deviation(data, brdf, c);
        c->analysed = values_of(gonio_i_json_member(data, "polarization_r"));
    }
    if (status == GONIO_OK) {
        status = find_channels(file, data, c);
    }
    return status == GONIO_OK ? check_lengths(file, c) : status;
}

/* ---- rows ---- */

static double number_at(const column *c, size_t row)
{
    const json_t *value = json_is_array(c->values) ? json_array_get(c->values, row) : c->values;
    return gonio_i_json_double(value) * c->scale;
}

static bool has_state(const json_t *states, const char *state)
{
    for (size_t k = 0; k < json_array_size(states); k++) {
        const char *word = json_string_value(json_array_get(states, k));
        if (word != NULL && strcasecmp(word, state) == 0) {
            return true;
        }
    }
    return false;
}

/* What is detected of s and of p adds up; what is lit by s and by p is averaged. */
static double analysers(const columns *c)
{
    return has_state(c->analysed, "s") && has_state(c->analysed, "p") ? 2.0 : 1.0;
}

static double nine_digits(double degrees)
{
    return nearbyint(degrees * 1e7) / 1e7;
}

static gonio_status add_row(const gonio_i_readings_file *file, const columns *c, double factor,
                            size_t k, gonio_i_long_table *table)
{
    gonio_i_long_row row = {.value = factor * number_at(&c->value, k),
                            .deviation = factor * number_at(&c->deviation, k),
                            .line = k + 1};
    for (int a = 0; a < ANGLES; a++) {
        const double degrees = number_at(&c->angle[a], k);
        row.degrees[a] = c->angle[a].scale == 1.0 ? degrees : nine_digits(degrees);
        if (!isfinite(row.degrees[a])) {
            return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                                "%s: entry %zu: an angle is not a number", file->path, k + 1);
        }
    }
    row.wavelength = c->channel != NULL ? (double)channel_at(c, k)
                     : c->channels > 0  ? 0.0
                                        : number_at(&c->wavelength, k);
    if (isnan(row.wavelength)) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: entry %zu: the wavelength is not a number", file->path, k + 1);
    }
    return gonio_i_long_table_add(table, &row);
}

static gonio_status read_rows(const gonio_i_readings_file *file, const columns *c,
                              gonio_i_import *in)
{
    gonio_i_long_table table = {.context = file->context, .numbered = c->channels};
    const double factor = analysers(c);
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < c->rows && status == GONIO_OK; k++) {
        status = add_row(file, c, factor, k, &table);
    }
    if (status == GONIO_OK) {
        status = gonio_i_long_table_import(&table, in);
    }
    gonio_i_long_table_free(&table);
    return status;
}

static gonio_status read_root(const gonio_i_readings_file *file, const json_t *root,
                              gonio_readings *readings)
{
    columns c = {0};
    gonio_i_import in;
    gonio_status status = find_columns(file, root, &c);
    const gonio_convention stated = {
        .angles = GONIO_DEGREES, .values = GONIO_VALUE_BRDF, .wavelengths = c.wavelengths};
    gonio_i_import_begin(&in, file->context, readings, "BRDF JSON", &stated);
    gonio_i_import_leniently(&in);
    if (status == GONIO_OK) {
        status = read_rows(file, &c, &in);
    }
    return gonio_i_import_end(&in, status);
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    json_t *root = gonio_i_json_parse(file);
    if (root == NULL) {
        return GONIO_ERROR_FORMAT;
    }
    const gonio_status status = read_root(file, root, readings);
    json_decref(root);
    return status;
}

static bool probe(const char *text, size_t size)
{
    return gonio_i_json_has(text, size, "BRDF");
}

const gonio_i_readings_format gonio_i_readings_brdf_json = {.word = "json",
                                                            .name = "BRDF JSON",
                                                            .extensions = {".json", ".brdf"},
                                                            .probe = probe,
                                                            .read = read,
                                                            .print = gonio_i_brdf_json_print};
