/* Reading readings and plans as CSV: see docs/plan-and-readings.md. Cells are parsed straight into
 * numbers. The text is kept, so that other columns can be written again as they are. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../plan/plan_file.h"
#include "../import.h"
#include "../long_table.h"
#include "../rules.h"
#include "../value_scale.h"
#include "csv_blocks.h"
#include "csv_kept.h"
#include "csv_layout.h"
#include "csv_notes.h"
#include "csv_numbers.h"
#include "csv_time.h"
#include "format.h"

/* Whether the text begins with column names between commas, semicolons or tabs, has names of angles
 * in another layout (csv_layout.h), is scans in blocks (csv_blocks.h), or is empty. The reader
 * checks the names. */
static bool recognises(const char *text, size_t size)
{
    gonio_i_csv_lines lines;
    const char *line = NULL;
    size_t length = 0;
    if (memchr(text, '\0', size) != NULL) {
        return false;
    }
    if (gonio_i_csv_are_blocks(text, size) || gonio_i_csv_layout_is_other(text, size)) {
        return true;
    }
    gonio_i_csv_lines_begin(&lines, text, size, NULL);
    return gonio_i_csv_lines_next(&lines, &line, &length) &&
           (length == 0 || strcspn(line, ",;\t") < length ||
            memmem(line, length, "_deg", 4) != NULL);
}

/* ---- cells ---- */

typedef struct csv_source {
    gonio_context *context;
    gonio_i_csv_reader reader;
    gonio_i_csv_columns *columns;
    gonio_readings *readings;
    gonio_i_import in;
    double *value;                       /* [channels] of a row */
    double *deviation;                   /* [channels] */
    gonio_i_csv_others others;           /* columns that are not read */
    double angle[GONIO_I_ANGLE_COLUMNS]; /* degrees, and components of vectors, of a row */
    double wavelength;                   /* of a row */
    size_t marks;                        /* cells in place of values, such as "---" */
    char mark[16];                       /* the first of them */
    gonio_i_long_table table;            /* rows of one wavelength each */
} csv_source;

static gonio_status bad_cell(const csv_source *s, size_t column, gonio_status status,
                             const char *problem)
{
    return gonio_i_fail(s->context, status, "%s:%zu: %s '%.60s' %s", s->reader.path, s->reader.line,
                        s->reader.name[column], s->reader.cell[column], problem);
}

/* Whether nothing was read; counts cells that say so by a mark. */
static bool is_missing(csv_source *s, const char *cell)
{
    const bool mark = gonio_i_csv_is_mark(cell);
    if (mark && s->marks++ == 0) {
        snprintf(s->mark, sizeof s->mark, "%s", cell);
    }
    return mark || gonio_i_csv_is_empty(cell);
}

/* A cell as a number; NaN if it is none. */
static double number_of(const csv_source *s, size_t column)
{
    double value = NAN;
    const bool number = gonio_i_csv_is_number(s->reader.cell[column], s->reader.delimiter, &value);
    return number ? value : NAN;
}

static gonio_status take_angle(csv_source *s, size_t column, size_t index)
{
    double number = number_of(s, column);
    s->angle[index] = index < GONIO_I_VECTORS ? gonio_i_import_degrees(&s->in, number) : number;
    if (isnan(number) && s->in.how.angles == GONIO_DEGREES && index < GONIO_I_VECTORS &&
        gonio_i_csv_is_angle(s->reader.cell[column], s->reader.delimiter, &number)) {
        s->angle[index] = gonio_i_import_rounded(number);
    }
    return isfinite(number) ? GONIO_OK
                            : bad_cell(s, column, GONIO_ERROR_FORMAT, "is not a finite number");
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

static gonio_status take_planned(const csv_source *s, size_t column, gonio_i_row *row)
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

static gonio_status take_value(csv_source *s, size_t column, size_t channel, gonio_i_mark mark)
{
    gonio_status status = GONIO_OK;
    if (is_missing(s, s->reader.cell[column])) {
        s->value[channel] = NAN; /* half of an average is none */
        return GONIO_OK;
    }
    const int scale = s->in.how.scale;
    const double number = number_of(s, column);
    const double value = gonio_i_scale_value(scale, number);
    const double before = gonio_i_scale_value(scale, s->value[channel]);
    s->value[channel] = s->columns->column[column].second
                            ? gonio_i_scale_number(scale, 0.5 * (before + value))
                            : number;
    if (mark == GONIO_I_DARK && isfinite(value)) {
        return GONIO_OK; /* noise about nothing has both signs */
    }
    const char *problem = gonio_i_value_problem(value, &s->readings->options, &status);
    return problem == NULL ? GONIO_OK : bad_cell(s, column, status, problem);
}

/* A deviation in the unit of its value's number, which was read before. It may be given relative to
 * the value, or as that of the value where the number is its logarithm. */
static double absolute_deviation(const csv_source *s, const gonio_i_csv_column *column,
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

static gonio_status take_deviation(csv_source *s, size_t column, size_t channel)
{
    gonio_status status = GONIO_OK;
    if (is_missing(s, s->reader.cell[column])) {
        return GONIO_OK;
    }
    const double number = number_of(s, column);
    const char *problem = gonio_i_deviation_problem(number, &status);
    s->deviation[channel] = absolute_deviation(s, &s->columns->column[column], number);
    return problem == NULL ? GONIO_OK : bad_cell(s, column, status, problem);
}

static gonio_status take_wavelength(csv_source *s, size_t column)
{
    s->wavelength = number_of(s, column);
    return s->wavelength > 0.0 && isfinite(s->wavelength)
               ? GONIO_OK
               : bad_cell(s, column, GONIO_ERROR_FORMAT, "is not a wavelength");
}

/* Takes a cell. Values come before deviations (csv_columns.h). */
static gonio_status take_cell(csv_source *s, size_t k, gonio_i_row *row)
{
    const gonio_i_csv_column *column = &s->columns->column[k];
    switch (column->kind) {
    case GONIO_I_ANGLE:
        return take_angle(s, k, column->index);
    case GONIO_I_PLANNED:
        return take_planned(s, k, row);
    case GONIO_I_ROW_WAVELENGTH:
        return take_wavelength(s, k);
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

static gonio_status take_directions(const csv_source *s, gonio_i_row *row)
{
    const char *problem =
        gonio_i_geometry_take(s->columns->geometry, s->in.how.mirror, s->angle, row->degrees);
    row->degrees[1] += s->angle[GONIO_I_SAMPLE_ROTATION];
    row->degrees[3] += s->angle[GONIO_I_SAMPLE_ROTATION];
    return problem == NULL ? GONIO_OK
                           : gonio_i_fail(s->context, GONIO_ERROR_DATA, "%s:%zu: %s",
                                          s->reader.path, row->line, problem);
}

/* Adds a row of one wavelength. It is kept until all wavelengths of its directions are known. */
static gonio_status add_long(csv_source *s, const gonio_i_row *row)
{
    gonio_i_long_row kept = {.wavelength = s->wavelength,
                             .value = s->value[0],
                             .deviation = s->deviation[0],
                             .line = row->line};
    memcpy(kept.degrees, row->degrees, sizeof kept.degrees);
    return gonio_i_long_table_add(&s->table, &kept);
}

static gonio_status take_row(csv_source *s)
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
    gonio_i_csv_others_look(&s->others, &s->reader);
    if (status != GONIO_OK) {
        return status;
    }
    if (s->columns->by_wavelength && row.mark != GONIO_I_SAMPLE) {
        gonio_i_import_leave_out(&s->in, GONIO_I_NOT_THE_SAMPLE);
        return GONIO_OK;
    }
    return s->columns->by_wavelength ? add_long(s, &row) : gonio_i_import_add(&s->in, &row);
}

static gonio_status refuse_empty(const csv_source *s)
{
    return s->reader.remarks == 0
               ? gonio_i_fail(s->context, GONIO_ERROR_DATA, "%s: no lines below the column names",
                              s->reader.path)
               : gonio_i_fail(
                     s->context, GONIO_ERROR_DATA,
                     "%s:%zu: words, not a reading, and no readings below the column names",
                     s->reader.path, s->reader.first_remark);
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

/* ---- the file as a whole ---- */

/* The convention that holds unless the user gives another. */
static gonio_convention convention_of(const gonio_i_csv_columns *columns, int usual_values)
{
    const int usual = usual_values != 0 ? usual_values : GONIO_VALUE_BRDF;
    gonio_convention stated = columns->stated;
    stated.angles = stated.angles != 0 ? stated.angles : GONIO_DEGREES;
    stated.values = stated.values != 0 ? stated.values : usual;
    return stated;
}

static bool is_convention_given(const gonio_convention *as)
{
    return as->angles != 0 || as->values != 0 || as->mirror != 0 || as->wavelengths != 0 ||
           as->zeros != 0;
}

/* From here on the columns have wavelengths in nm. */
static void take_nanometres(gonio_i_csv_columns *columns, const gonio_readings *readings)
{
    for (size_t k = 0; k < columns->count && readings->wavelength != NULL; k++) {
        gonio_i_csv_column *column = &columns->column[k];
        if (column->kind == GONIO_I_VALUE || column->kind == GONIO_I_DEVIATION) {
            column->wavelength = readings->wavelength[column->index];
        }
    }
}

/* Says what was made of polarised light. */
static gonio_status note_polarisation(const csv_source *s)
{
    const gonio_i_csv_columns *c = s->columns;
    return c->polarised == 0
               ? GONIO_OK
               : gonio_i_readings_note(
                     s->context, s->readings, "%s",
                     c->averaged == c->polarised
                         ? "the values of s and of p polarisation are averaged"
                     : c->averaged > 0 ? "the values of s and of p polarisation are averaged, "
                                         "where there are both"
                                       : "the values are of one polarisation only; they are taken "
                                         "as those of unpolarised light");
}

/* Says which cells and lines were taken for no values. */
static gonio_status note_what_is_skipped(csv_source *s)
{
    gonio_status status = GONIO_OK;
    if (s->marks > 0) {
        status = gonio_i_readings_note(s->context, s->readings,
                                       "%zu cell%s such as '%s' taken as not read", s->marks,
                                       s->marks > 1 ? "s" : "", s->mark);
    }
    if (status == GONIO_OK && s->reader.remarks > 0) {
        status = gonio_i_readings_note(s->context, s->readings,
                                       "%zu line%s of words among the rows left out (first: line "
                                       "%zu)",
                                       s->reader.remarks, s->reader.remarks > 1 ? "s" : "",
                                       s->reader.first_remark);
    }
    return status;
}

/* Writes the notes that the import cannot know. */
static gonio_status write_notes(csv_source *s)
{
    gonio_status status = note_what_is_skipped(s);
    if (s->readings->options.directions_only) {
        return status;
    }
    status = status == GONIO_OK ? note_polarisation(s) : status;
    if (status == GONIO_OK && s->columns->unclear != NULL) {
        status = gonio_i_readings_note(
            s->context, s->readings,
            s->columns->stated.values == 0
                ? "the comment '%.60s' is not understood as a unit of values; --as values=... says "
                  "what they are"
                : "the comment '%.60s' is not used: the names of columns say another unit",
            s->columns->unclear);
    }
    return status == GONIO_OK ? gonio_i_csv_others_note(&s->others, &s->reader, s->readings)
                              : status;
}

/* The number of lines, at most as many as fit into the text. Arrays that need not grow are not
 * copied. */
static size_t expected_rows(const gonio_i_csv_reader *reader)
{
    const char *end = reader->text + reader->size;
    size_t lines = 1;
    for (const char *at = reader->text; (at = memchr(at, '\n', (size_t)(end - at))) != NULL; at++) {
        lines++;
    }
    const size_t most = reader->size / reader->columns + 1;
    return lines < most ? lines : most;
}

static void begin_import(csv_source *s, gonio_i_csv_kept *kept, const char *taken_as)
{
    const gonio_convention stated = convention_of(s->columns, s->readings->usual_values);
    gonio_i_import_begin(&s->in, s->context, s->readings, taken_as, &stated);
    s->in.quiet = s->columns->own && !is_convention_given(&s->readings->options.as);
    s->in.keep_unmeasured = true;
    kept->rewrite_angles = !s->columns->own_angles || s->in.how.angles != GONIO_DEGREES ||
                           s->in.how.mirror == GONIO_MIRROR_0;
    s->readings->keep_angles = kept->rewrite_angles || s->columns->by_wavelength;
}

/* Imports rows of one wavelength each, whose channels are known only at the end. */
static gonio_status import_long(csv_source *s)
{
    s->table.context = s->context;
    gonio_status status = take_rows(s);
    status = status == GONIO_OK ? gonio_i_long_table_import(&s->table, &s->in) : status;
    gonio_i_long_table_free(&s->table);
    return status;
}

static gonio_status import_wide(csv_source *s)
{
    const gonio_status status =
        gonio_i_import_channels(&s->in, s->columns->channels, s->columns->wavelength);
    if (status != GONIO_OK) {
        return status;
    }
    take_nanometres(s->columns, s->readings);
    s->readings->expected = expected_rows(&s->reader);
    return take_rows(s);
}

static gonio_status import_rows(csv_source *s, gonio_i_csv_kept *kept)
{
    char taken_as[GONIO_I_TAKEN_ROOM] = "";
    begin_import(s, kept, taken_as);
    gonio_i_csv_describe(&s->reader, s->columns, s->in.how.mirror, taken_as);
    gonio_status status = gonio_i_csv_others_begin(&s->others, s->context, s->columns);
    if (status == GONIO_OK) {
        status = s->columns->by_wavelength ? import_long(s) : import_wide(s);
    }
    status = status == GONIO_OK ? write_notes(s) : status;
    gonio_i_csv_others_free(&s->others);
    return gonio_i_import_end(&s->in, status);
}

/* Drops the kept text: rows of which several are one reading cannot be written over. */
static void drop_kept(gonio_readings *readings)
{
    readings->attachment.release(readings->attachment.data);
    readings->attachment = (gonio_i_attachment){NULL, NULL};
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
    gonio_status status = gonio_i_csv_take_units(&s->reader);
    if (status == GONIO_OK) {
        status = gonio_i_csv_columns_find(&s->reader, &s->readings->options, &kept->columns);
    }
    if (status == GONIO_OK) {
        s->columns = &kept->columns;
        status = import_rows(s, kept);
    }
    if (status == GONIO_OK && !gonio_i_comments_copy(&s->readings->comment, &s->reader.comment)) {
        return gonio_i_fail(s->context, GONIO_ERROR_MEMORY, "%s: out of memory", s->reader.path);
    }
    return status;
}

static gonio_status make_plain(gonio_i_readings_file *file)
{
    if (gonio_i_csv_are_blocks(file->text, file->size)) {
        return gonio_i_csv_blocks_make_plain(file->context, file->path, &file->text, &file->size);
    }
    const char *begin = file->text + strspn(file->text, " \t\r\n");
    if (*begin == '{' || *begin == '[') {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: JSON, but not BRDF JSON: an object 'data' with columns theta_i, "
                            "phi_i, theta_r, phi_r and BRDF; or write it as CSV",
                            file->path);
    }
    if (gonio_i_csv_layout_lacks_names(file->text, file->size)) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: begins with numbers, not with names of columns; put a line of "
                            "names above, such as theta_i,phi_i,theta_o,phi_o,brdf",
                            file->path);
    }
    return gonio_i_csv_layout_make_plain(file->context, file->path, &file->text, &file->size);
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    csv_source s = {.context = file->context, .readings = readings};
    gonio_status status = make_plain(file);
    gonio_i_csv_kept *kept = status == GONIO_OK ? keep(file, readings) : NULL;
    if (kept == NULL) {
        return status != GONIO_OK ? status : GONIO_ERROR_MEMORY;
    }
    status = gonio_i_csv_open(file->context, file->path, kept->text, kept->size, &s.reader);
    s.reader.remarks_allowed = true;
    if (status == GONIO_OK) {
        status = read_table(&s, kept);
        gonio_i_csv_close(&s.reader);
    }
    if (status == GONIO_OK && kept->columns.by_wavelength) {
        drop_kept(readings);
    }
    return status;
}

const gonio_i_readings_format gonio_i_readings_csv = {.word = "csv",
                                                      .name = "CSV",
                                                      .recognises = recognises,
                                                      .read = read,
                                                      .print = gonio_i_csv_print};
