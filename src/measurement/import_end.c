/* The end of an import: rows that repeat others, and the note on what was made of the file. See
 * import.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/memory_stream.h"
#include "convention.h"
#include "horizon.h"
#include "import.h"

static const double SAME = 1e-9; /* relative: values that repeat others */

/* ---- rows that repeat others ---- */

static bool same_number(double a, double b)
{
    return (isnan(a) && isnan(b)) || fabs(a - b) <= SAME * fabs(a);
}

static bool same_values(gonio_readings *r, size_t a, size_t b)
{
    bool same = r->planned[a] == r->planned[b];
    for (size_t k = 0; k < r->channels && same; k++) {
        same = same_number(gonio_i_readings_values(r, a)[k], gonio_i_readings_values(r, b)[k]);
    }
    return same;
}

static void move(gonio_readings *r, size_t from, size_t to)
{
    const size_t bytes = r->channels * sizeof *r->value;
    r->pair[to] = r->pair[from];
    r->planned[to] = r->planned[from];
    r->line[to] = r->line[from];
    memmove(&r->value[to * r->channels], &r->value[from * r->channels], bytes);
    if (r->deviation != NULL) {
        memmove(&r->deviation[to * r->channels], &r->deviation[from * r->channels], bytes);
    }
    if (r->time != NULL) {
        r->time[to] = r->time[from];
    }
    memmove(r->given[to], r->given[from], sizeof *r->given);
}

/* Removes the marked readings and counts them. */
static void take_out(gonio_i_import *in, const bool *marked, gonio_i_reason reason)
{
    gonio_readings *r = in->readings;
    size_t kept = 0;
    for (size_t k = 0; k < r->count; k++) {
        in->left_out[reason] += marked[k];
        if (!marked[k]) {
            move(r, k, kept++);
        }
    }
    r->count = kept;
}

/* Marks readings that have the same values as the first reading of the same directions. */
static gonio_status find_repeats(gonio_context *context, gonio_readings *r, bool *repeated)
{
    const gonio_status status = gonio_i_readings_group(context, r);
    for (size_t k = 0; k < r->count && status == GONIO_OK; k++) {
        repeated[k] = r->first_same[k] != k && same_values(r, k, r->first_same[k]);
    }
    return status;
}

static gonio_status drop_useless(gonio_i_import *in)
{
    bool *marked = gonio_i_allocate(in->context, in->readings->count, sizeof *marked);
    if (marked == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = find_repeats(in->context, in->readings, marked);
    if (status == GONIO_OK) {
        take_out(in, marked, GONIO_I_REPEATED);
    }
    if (status == GONIO_OK && in->how.zeros == GONIO_ZEROS_MISSING) {
        status = gonio_i_horizon_find(in->context, in->readings, marked);
        if (status == GONIO_OK) {
            take_out(in, marked, GONIO_I_LOST);
        }
    }
    free(marked);
    return status;
}

/* ---- the note ---- */

static const char *const reasons[GONIO_I_REASONS] = {
    [GONIO_I_BELOW_HORIZON] = "at or below the horizon",
    [GONIO_I_NOT_MEASURED] = "not measured",
    [GONIO_I_LOST] = "too low or too high near the horizon",
    [GONIO_I_REPEATED] = "repeated with the same values",
    [GONIO_I_EXTRAPOLATED] = "extrapolated",
    [GONIO_I_NOT_THE_SAMPLE] = "of the reference or the dark level",
};

static void print_left_out(const gonio_i_import *in, FILE *stream)
{
    const char *between = "; left out: ";
    for (int k = 0; k < GONIO_I_REASONS; k++) {
        if (in->left_out[k] > 0) {
            fprintf(stream, "%s%zu %s", between, in->left_out[k], reasons[k]);
            between = ", ";
        }
    }
    if (in->negative > 0) {
        fprintf(stream, "; %zu value%s below zero taken as 0", in->negative,
                in->negative > 1 ? "s" : "");
    }
    if (in->negative_theta > 0) {
        fprintf(stream, "; %zu with theta below zero (phi turned by 180)", in->negative_theta);
    }
}

static bool anything_changed(const gonio_i_import *in)
{
    size_t changed = in->negative + in->negative_theta;
    for (int k = 0; k < GONIO_I_REASONS; k++) {
        changed += in->left_out[k];
    }
    return changed > 0;
}

/* Prints what the instrument says of relative values: ", times its reflectance factor, 0.91 to
 * 1.07". */
static void print_reference(const gonio_i_value_unit *unit, FILE *stream)
{
    double least = INFINITY;
    double most = 0.0;
    for (size_t k = 0; k < unit->rows; k++) {
        least = fmin(least, unit->row[k].factor);
        most = fmax(most, unit->row[k].factor);
    }
    if (unit->kind == GONIO_VALUE_RELATIVE && unit->rows > 0) {
        fprintf(stream, ", times its reflectance factor, %.4g to %.4g", least, most);
    }
}

/* Writes the note: "taken as Zemax BSDF: angles in degrees, values in 1/sr; 812 readings; left out:
 * ...". */
static gonio_status write_note(gonio_i_import *in)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = gonio_i_memory_stream(&text, &size);
    if (stream == NULL) {
        return gonio_i_fail(in->context, GONIO_ERROR_MEMORY, "%s: out of memory",
                            in->readings->path);
    }
    fprintf(stream, "taken as %s: ", in->taken_as);
    gonio_i_convention_print(&in->how, stream);
    print_reference(&in->readings->unit, stream);
    fprintf(stream, "; %zu reading%s", in->readings->count, in->readings->count > 1 ? "s" : "");
    print_left_out(in, stream);
    const gonio_status status = fclose(stream) == 0
                                    ? gonio_i_readings_note(in->context, in->readings, "%s", text)
                                    : gonio_i_fail(in->context, GONIO_ERROR_MEMORY,
                                                   "%s: out of memory", in->readings->path);
    free(text);
    return status;
}

static gonio_status note_backwards(const gonio_i_import *in)
{
    return in->backwards == 0
               ? GONIO_OK
               : gonio_i_readings_note(in->context, in->readings,
                                       "the time runs backwards in %zu row%s (first in line %zu)",
                                       in->backwards, in->backwards > 1 ? "s" : "",
                                       in->first_backwards);
}

/* ---- the end ---- */

static gonio_status refuse_nothing(const gonio_i_import *in)
{
    size_t rows = 0;
    for (int k = 0; k < GONIO_I_REASONS; k++) {
        rows += in->left_out[k];
    }
    return rows == 0 ? gonio_i_fail(in->context, GONIO_ERROR_DATA, "%s: no readings in it",
                                    in->readings->path)
                     : gonio_i_fail(in->context, GONIO_ERROR_DATA,
                                    "%s: none of the %zu rows is a reading above the horizon",
                                    in->readings->path, rows);
}

gonio_status gonio_i_import_end(gonio_i_import *import, gonio_status status)
{
    if (status == GONIO_OK && import->readings->count == 0) {
        status = refuse_nothing(import);
    }
    if (status == GONIO_OK && import->lenient) {
        status = drop_useless(import);
    }
    import->readings->below_zero += import->negative;
    if (status == GONIO_OK && (!import->quiet || anything_changed(import))) {
        status = write_note(import);
    }
    if (status == GONIO_OK) {
        status = note_backwards(import);
    }
    if (status == GONIO_OK) {
        status = gonio_i_marked_apply(import->context, import->readings, &import->marked);
    }
    gonio_i_marked_free(&import->marked);
    free(import->value);
    free(import->deviation);
    import->value = NULL;
    import->deviation = NULL;
    return status;
}
