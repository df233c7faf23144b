/* Reading readings and plans as CSV: docs/plan-and-readings.md. Cells are parsed straight into
 * numbers; the text is kept, so that other columns can be written again as they are. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../plan/plan_file.h"
#include "../rules.h"
#include "csv_columns.h"
#include "format.h"

/* Column names between commas, semicolons or tabs, or none yet. What is wrong with them is for the
 * reader to say. */
static bool probe(const char *text, size_t size)
{
    size_t length = 0;
    const char *line = gonio_i_first_line(text, size, &length);
    return line != NULL && (length == 0 || strcspn(line, ",;\t") < length ||
                            memmem(line, length, "_deg", 4) != NULL);
}

/* ---- reading ---- */

typedef struct csv_source {
    gonio_context *context;
    gonio_i_csv_reader reader;
    const gonio_i_csv_columns *columns;
    gonio_readings *readings;
    double *value;     /* [channels] of a row */
    double *deviation; /* [channels] */
} csv_source;

static gonio_status bad_cell(const csv_source *s, size_t column, gonio_status status,
                             const char *problem)
{
    return gonio_i_fail(s->context, status, "%s:%zu: %s '%.60s' %s", s->reader.path, s->reader.line,
                        s->reader.name[column], s->reader.cell[column], problem);
}

static bool is_missing(const char *cell)
{
    return *cell == '\0' || strcasecmp(cell, "na") == 0 || strcasecmp(cell, "nan") == 0;
}

/* A cell as a number; NaN if it is none. */
static double number_of(const csv_source *s, size_t column)
{
    double value = NAN;
    const bool number = gonio_i_csv_is_number(s->reader.cell[column], s->reader.delimiter, &value);
    return number ? value : NAN;
}

static gonio_status take_angle(const csv_source *s, size_t column, size_t index,
                               gonio_i_reading *reading)
{
    gonio_status status = GONIO_OK;
    reading->degrees[index] = number_of(s, column);
    const char *problem = gonio_i_angle_problem((int)index, reading->degrees[index], &status);
    return problem == NULL ? GONIO_OK : bad_cell(s, column, status, problem);
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

static gonio_status take_planned(const csv_source *s, size_t column, gonio_i_reading *reading)
{
    const char *cell = s->reader.cell[column];
    if (*cell == '\0') {
        return GONIO_OK;
    }
    reading->planned = channel_of(s->readings, cell);
    return reading->planned != NO_CHANNEL
               ? GONIO_OK
               : bad_cell(s, column, GONIO_ERROR_FORMAT, "is no channel: R, G, B or all");
}

static gonio_status take_value(const csv_source *s, size_t column, size_t channel)
{
    gonio_status status = GONIO_OK;
    if (is_missing(s->reader.cell[column])) {
        return GONIO_OK;
    }
    s->value[channel] = number_of(s, column);
    const char *problem = gonio_i_value_problem(s->value[channel], &s->readings->options, &status);
    return problem == NULL ? GONIO_OK : bad_cell(s, column, status, problem);
}

static gonio_status take_deviation(const csv_source *s, size_t column, size_t channel)
{
    gonio_status status = GONIO_OK;
    if (is_missing(s->reader.cell[column])) {
        return GONIO_OK;
    }
    s->deviation[channel] = number_of(s, column);
    const char *problem = gonio_i_deviation_problem(s->deviation[channel], &status);
    return problem == NULL ? GONIO_OK : bad_cell(s, column, status, problem);
}

/* Takes the cells of one kind; angles first, then the channel, so that errors come in that order.
 */
static gonio_status take_kind(const csv_source *s, gonio_i_column_kind kind,
                              gonio_i_reading *reading)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < s->columns->count && status == GONIO_OK; k++) {
        const gonio_i_csv_column *column = &s->columns->column[k];
        if (column->kind != kind) {
            continue;
        }
        switch (kind) {
        case GONIO_I_ANGLE:
            status = take_angle(s, k, column->index, reading);
            break;
        case GONIO_I_PLANNED:
            status = take_planned(s, k, reading);
            break;
        case GONIO_I_VALUE:
            status = take_value(s, k, column->index);
            break;
        case GONIO_I_DEVIATION:
            status = take_deviation(s, k, column->index);
            break;
        case GONIO_I_OTHER:
            break;
        }
    }
    return status;
}

static gonio_status take_row(const csv_source *s)
{
    gonio_i_reading reading = {.planned = GONIO_ALL_CHANNELS,
                               .line = s->reader.line,
                               .value = s->value,
                               .deviation = s->columns->any_deviation ? s->deviation : NULL};
    for (size_t k = 0; k < s->columns->channels; k++) {
        s->value[k] = NAN;
        s->deviation[k] = NAN;
    }
    gonio_status status = GONIO_OK;
    for (gonio_i_column_kind kind = GONIO_I_ANGLE; kind <= GONIO_I_DEVIATION && status == GONIO_OK;
         kind++) {
        status = take_kind(s, kind, &reading);
    }
    return status == GONIO_OK ? gonio_i_readings_add(s->context, s->readings, &reading) : status;
}

static gonio_status take_rows(csv_source *s)
{
    const size_t channels = s->columns->channels;
    s->value = gonio_i_allocate(s->context, channels, sizeof *s->value);
    s->deviation = gonio_i_allocate(s->context, channels, sizeof *s->deviation);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (s->value != NULL && s->deviation != NULL) {
        status = gonio_i_csv_next(&s->reader);
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

/* The readings keep the text from here on. */
static gonio_i_csv_kept *keep(gonio_i_readings_file *file, gonio_readings *readings)
{
    gonio_i_csv_kept *kept = gonio_i_allocate(file->context, 1, sizeof *kept);
    if (kept != NULL) {
        *kept = (gonio_i_csv_kept){.text = file->text, .size = file->size};
        readings->attachment = (gonio_i_attachment){kept, gonio_i_csv_kept_free};
        file->text = NULL;
    }
    return kept;
}

static gonio_status read_table(csv_source *s, gonio_i_csv_kept *kept)
{
    gonio_status status =
        gonio_i_csv_columns_find(&s->reader, s->readings->options.values_needed, &kept->columns);
    if (status == GONIO_OK) {
        status = gonio_i_readings_begin(s->context, s->readings, kept->columns.channels,
                                        kept->columns.wavelength);
    }
    if (status == GONIO_OK) {
        s->columns = &kept->columns;
        status = take_rows(s);
    }
    if (status == GONIO_OK && !gonio_i_comments_copy(&s->readings->comment, &s->reader.comment)) {
        return gonio_i_fail(s->context, GONIO_ERROR_MEMORY, "%s: out of memory", s->reader.path);
    }
    return status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    csv_source s = {.context = file->context, .readings = readings};
    gonio_i_csv_kept *kept = keep(file, readings);
    if (kept == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status =
        gonio_i_csv_open(file->context, file->path, kept->text, kept->size, &s.reader);
    if (status == GONIO_OK) {
        status = read_table(&s, kept);
        gonio_i_csv_close(&s.reader);
    }
    return status;
}

const gonio_i_readings_format gonio_i_readings_csv = {
    .word = "csv", .name = "CSV", .probe = probe, .read = read, .print = gonio_i_csv_print};
