/* The rows of readings as CSV: see csv_rows.h. */
#include "csv_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../plan/plan_file.h"
#include "../rules.h"
#include "../value_scale.h"
#include "crossed.h"
#include "csv_kept.h"
#include "csv_numbers.h"
#include "csv_time.h"

/* ---- cells ---- */

static gonio_status bad_cell(const gonio_i_csv_source *s, size_t column, gonio_status status,
                             const char *problem)
{
    return gonio_i_fail(s->context, status, "%s:%zu: %s '%.60s' %s", s->reader.path, s->reader.line,
                        s->reader.name[column], s->reader.cell[column], problem);
}

/* Whether nothing was read; counts cells that say so by a mark. */
static bool is_missing(gonio_i_csv_source *s, const char *cell)
{
    const bool mark = gonio_i_csv_is_mark(cell);
    if (mark && s->marks++ == 0) {
        snprintf(s->mark, sizeof s->mark, "%s", cell);
    }
    return mark || gonio_i_csv_is_empty(cell);
}

/* A cell as a number; NaN if it is none, or has an uncertainty. */
static double number_of(const gonio_i_csv_source *s, size_t column)
{
    double spread = NAN;
    const double value = gonio_i_csv_forms_number(&s->forms, &s->reader, column, &spread);
    return isnan(spread) ? value : NAN;
}

/* Refuses a cell that is no number for what is behind it, otherwise for the problem. */
static gonio_status bad_number(const gonio_i_csv_source *s, size_t column, gonio_status status,
                               const char *problem)
{
    const char *form = gonio_i_csv_forms_problem(&s->forms, &s->reader, column);
    return form != NULL ? bad_cell(s, column, GONIO_ERROR_FORMAT, form)
                        : bad_cell(s, column, status, problem);
}

static gonio_status take_geometry(gonio_i_csv_source *s, size_t column)
{
    const char *cell = s->reader.cell[column];
    const gonio_readings_options *options = &s->readings->options;
    gonio_i_settings named;
    if (!gonio_i_geometry_of((gonio_i_line){cell, strlen(cell)}, &named)) {
        return bad_cell(s, column, GONIO_ERROR_FORMAT, "is not a geometry such as 45/0 or 45as15");
    }
    const bool aspecular = (named.bits & 1U << GONIO_I_ASPECULAR) != 0;
    s->angle[0] = named.angle[0];
    s->angle[2] = aspecular
                      ? gonio_i_import_rounded(named.angle[0] - named.angle[GONIO_I_ASPECULAR])
                      : named.angle[2];
    return aspecular && s->columns->stated.values == 0 && options->as.values == GONIO_AS_STATED &&
                   !options->directions_only
               ? gonio_i_refuse_aspecular(s->context, s->reader.path)
               : GONIO_OK;
}

static gonio_status take_angle(gonio_i_csv_source *s, size_t column, size_t index)
{
    if (index == GONIO_I_NAMED_GEOMETRY) {
        return take_geometry(s, column);
    }
    double number = number_of(s, column);
    s->angle[index] = index < GONIO_I_VECTORS ? gonio_i_import_degrees(&s->in, number) : number;
    if (isnan(number) && s->in.how.angles == GONIO_DEGREES && index < GONIO_I_VECTORS &&
        gonio_i_csv_is_angle(s->reader.cell[column], s->reader.delimiter, &number)) {
        s->angle[index] = gonio_i_import_rounded(number);
    }
    if (s->columns->column[column].complement) {
        s->angle[index] = gonio_i_import_rounded(90.0 - s->angle[index]);
    }
    return isfinite(number) ? GONIO_OK
                            : bad_number(s, column, GONIO_ERROR_FORMAT, "is not a finite number");
}

enum { NO_CHANNEL = -2 };

/* The channel that a cell names, colours first; NO_CHANNEL if it names none. */
static int channel_of(const gonio_readings *readings, const char *cell)
{
    for (int k = GONIO_ALL_CHANNELS; k < GONIO_CHANNELS; k++) {
        if (strcasecmp(cell, gonio_i_planned_channel_name(k)) == 0) {
            return k;
        }
    }
    const int channels = gonio_readings_are_colours(readings) ? 0 : (int)readings->channels;
    for (int k = 0; k < channels; k++) {
        char name[GONIO_I_NAME_ROOM];
        gonio_i_csv_name_channel(readings, k, name);
        if (strcasecmp(cell, name) == 0) {
            return k;
        }
    }
    return NO_CHANNEL;
}

static gonio_status take_planned(const gonio_i_csv_source *s, size_t column, gonio_i_row *row)
{
    const char *cell = s->reader.cell[column];
    if (*cell == '\0') {
        return GONIO_OK;
    }
    row->planned = channel_of(s->readings, cell);
    return row->planned != NO_CHANNEL
               ? GONIO_OK
               : bad_cell(s, column, GONIO_ERROR_FORMAT, "is not a channel: R, G, B or all");
}

/* The factor of a column's unit; a relative deviation has none. */
static double factor_of(const gonio_i_csv_column *column)
{
    return column->factor > 0.0 && column->scale == 0.0 ? column->factor : 1.0;
}

/* Keeps the uncertainty in a cell of values. That of a mean of two is of independent numbers. */
static void take_spread(gonio_i_csv_source *s, size_t column, size_t channel, double spread)
{
    const bool second = s->columns->column[column].second;
    if (gonio_i_csv_forms_spread(&s->forms, column)) {
        s->deviation[channel] = second ? 0.5 * hypot(s->deviation[channel], spread) : spread;
    }
}

static gonio_status take_value(gonio_i_csv_source *s, size_t column, size_t channel,
                               gonio_i_mark mark)
{
    gonio_status status = GONIO_OK;
    if (is_missing(s, s->reader.cell[column])) {
        s->value[channel] = NAN; /* half of an average is none */
        return GONIO_OK;
    }
    const int scale = s->in.how.scale;
    double spread = NAN;
    const double factor = factor_of(&s->columns->column[column]);
    const double number = factor * gonio_i_csv_forms_number(&s->forms, &s->reader, column, &spread);
    const double value = gonio_i_scale_value(scale, number);
    const double before = gonio_i_scale_value(scale, s->value[channel]);
    s->value[channel] = s->columns->column[column].second
                            ? gonio_i_scale_number(scale, 0.5 * (before + value))
                            : number;
    take_spread(s, column, channel, factor * spread);
    if (mark == GONIO_I_DARK && isfinite(value)) {
        return GONIO_OK; /* noise about nothing has both signs */
    }
    const char *problem = gonio_i_value_problem(value, &s->readings->options, &status);
    if (isfinite(number) && isinf(value)) {
        problem = "is not a finite number when its logarithm is undone: larger than any BRDF";
    }
    return problem == NULL ? GONIO_OK : bad_number(s, column, status, problem);
}

/* A deviation in the unit of its value's number, which was read before. It may be given relative to
 * the value, or as that of the value where the number is its logarithm. */
static double absolute_deviation(const gonio_i_csv_source *s, const gonio_i_csv_column *column,
                                 double number)
{
    const int scale = s->in.how.scale;
    const double given = s->value[column->index];
    if (!gonio_i_scale_is_logarithm(scale)) {
        return column->scale == 0.0 ? number : number * column->scale * fabs(given);
    }
    const double relative =
        column->scale != 0.0 ? number * column->scale : number / gonio_i_scale_value(scale, given);
    return column->scale != 0.0 || column->linear ? relative / gonio_i_scale_slope(scale) : number;
}

static gonio_status take_deviation(gonio_i_csv_source *s, size_t column, size_t channel)
{
    gonio_status status = GONIO_OK;
    if (is_missing(s, s->reader.cell[column])) {
        return GONIO_OK;
    }
    const double number = factor_of(&s->columns->column[column]) * number_of(s, column);
    const char *problem = gonio_i_deviation_problem(number, &status);
    s->deviation[channel] = absolute_deviation(s, &s->columns->column[column], number);
    return problem == NULL ? GONIO_OK : bad_number(s, column, status, problem);
}

static gonio_status take_wavelength(gonio_i_csv_source *s, size_t column)
{
    s->wavelength = number_of(s, column);
    return s->wavelength > 0.0 && isfinite(s->wavelength)
               ? GONIO_OK
               : bad_number(s, column, GONIO_ERROR_FORMAT, "is not a wavelength");
}

static gonio_status take_colour(gonio_i_csv_source *s, size_t column)
{
    s->colour = gonio_i_colour_of(s->reader.cell[column]);
    return s->colour >= 0 ? GONIO_OK
                          : bad_cell(s, column, GONIO_ERROR_FORMAT,
                                     "is not R, G or B, of which the value in other rows is");
}

static gonio_status take_polarisation(gonio_i_csv_source *s, size_t column)
{
    if (!gonio_i_polarisation_of(s->reader.cell[column], &s->polarisation)) {
        return bad_cell(s, column, GONIO_ERROR_FORMAT,
                        "is not a polarisation of the light: s, p or unpolarised; rename the "
                        "column if it is something else");
    }
    s->polarised[s->polarisation + 1]++;
    return GONIO_OK;
}

/* Takes a cell. Values come before deviations (csv_columns.h). */
static gonio_status take_cell(gonio_i_csv_source *s, size_t k, gonio_i_row *row)
{
    const gonio_i_csv_column *column = &s->columns->column[k];
    switch (column->kind) {
    case GONIO_I_ANGLE:
        return take_angle(s, k, column->index);
    case GONIO_I_PLANNED:
        return take_planned(s, k, row);
    case GONIO_I_ROW_WAVELENGTH:
        return take_wavelength(s, k);
    case GONIO_I_ROW_COLOUR:
        return take_colour(s, k);
    case GONIO_I_POLARISATION:
        return take_polarisation(s, k);
    case GONIO_I_VALUE:
        return take_value(s, k, column->index, row->mark);
    case GONIO_I_DEVIATION:
        return take_deviation(s, k, column->index);
    case GONIO_I_TIME:
        row->time = gonio_i_time_of(s->reader.cell[k], s->reader.delimiter, column->scale);
        break;
    case GONIO_I_MARK:
        row->mark = gonio_i_mark_of(s->reader.cell[k]);
        break;
    case GONIO_I_OTHER:
        break;
    }
    return GONIO_OK;
}

/* ---- rows ---- */

static gonio_status take_directions(const gonio_i_csv_source *s, gonio_i_row *row)
{
    const char *problem =
        gonio_i_geometry_take(s->columns->geometry, s->in.how.mirror, s->angle, row->degrees);
    row->degrees[1] += s->angle[GONIO_I_SAMPLE_ROTATION];
    row->degrees[3] += s->angle[GONIO_I_SAMPLE_ROTATION];
    return problem == NULL ? GONIO_OK
                           : gonio_i_fail(s->context, GONIO_ERROR_DATA, "%s:%zu: %s",
                                          s->reader.path, row->line, problem);
}

/* Adds a row of one wavelength, colour or polarisation. It is kept until all of its directions are
 * known. Values of s and p are averaged as such, not their logarithms. */
static gonio_status add_long(gonio_i_csv_source *s, const gonio_i_row *row)
{
    const gonio_i_csv_columns *c = s->columns;
    const int scale = c->by_polarisation ? s->in.how.scale : GONIO_SCALE_LINEAR;
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < c->channels && status == GONIO_OK; k++) {
        const double value = gonio_i_scale_value(scale, s->value[k]);
        gonio_i_long_row kept = {.wavelength = c->by_wavelength        ? s->wavelength
                                               : c->by_colour          ? s->colour
                                               : c->wavelength != NULL ? c->wavelength[k]
                                                                       : (double)k,
                                 .value = value,
                                 .deviation =
                                     gonio_i_scale_deviation(scale, value, s->deviation[k]),
                                 .state = s->polarisation,
                                 .line = row->line};
        memcpy(kept.degrees, row->degrees, sizeof kept.degrees);
        status = gonio_i_long_table_add(&s->table, &kept);
    }
    return status;
}

static gonio_status take_row(gonio_i_csv_source *s)
{
    gonio_i_row row = {.planned = GONIO_ALL_CHANNELS,
                       .line = s->reader.line,
                       .timed = s->columns->any_time,
                       .time = NAN,
                       .value = s->value,
                       .deviation = s->columns->any_deviation ? s->deviation : NULL};
    for (size_t k = 0; k < s->columns->channels; k++) {
        s->value[k] = NAN;
        s->deviation[k] = NAN;
    }
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < s->columns->reads && status == GONIO_OK; k++) {
        status = take_cell(s, s->columns->read[k], &row);
    }
    status = status == GONIO_OK ? take_directions(s, &row) : status;
    status = status == GONIO_OK ? gonio_i_csv_words_look(s) : status;
    gonio_i_csv_others_look(&s->others, &s->reader);
    if (status != GONIO_OK) {
        return status;
    }
    const bool parts = gonio_i_csv_has_parts(s->columns);
    if (parts && row.mark != GONIO_I_SAMPLE) {
        gonio_i_import_leave_out(&s->in, GONIO_I_NOT_THE_SAMPLE);
        return GONIO_OK;
    }
    return parts ? add_long(s, &row) : gonio_i_import_add(&s->in, &row);
}

static gonio_status refuse_empty(const gonio_i_csv_source *s)
{
    return s->reader.remarks == 0
               ? gonio_i_fail(s->context, GONIO_ERROR_DATA, "%s: no lines below the column names",
                              s->reader.path)
               : gonio_i_fail(
                     s->context, GONIO_ERROR_DATA,
                     "%s:%zu: words, not a reading, and no readings below the column names",
                     s->reader.path, s->reader.first_remark);
}

gonio_status gonio_i_csv_take_rows(gonio_i_csv_source *s)
{
    const size_t channels = s->columns->channels;
    gonio_i_csv_words_begin(s);
    s->value = gonio_i_allocate(s->context, channels, sizeof *s->value);
    s->deviation = gonio_i_allocate(s->context, channels, sizeof *s->deviation);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (s->value != NULL && s->deviation != NULL) {
        status = gonio_i_csv_next(&s->reader);
    }
    if (status == GONIO_OK && s->reader.cells == 0) {
        status = refuse_empty(s);
    }
    while (status == GONIO_OK && s->reader.cells > 0) {
        status = take_row(s);
        if (status == GONIO_OK) {
            status = gonio_i_csv_next(&s->reader);
        }
    }
    free(s->value);
    free(s->deviation);
    return status;
}
