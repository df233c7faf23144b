/* Readings and plans as CSV: docs/plan-and-readings.md. Cells are parsed straight into numbers; the
 * text is kept, so that other columns can be written again as they are. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../rules.h"
#include "csv_columns.h"
#include "format.h"

static const char *const channel_names[] = {"all", "R", "G", "B"};

/* A planned channel as a cell has it: all; R, G or B; 400nm; or its number from 1. */
static void name_channel(const gonio_readings *readings, int channel, char name[GONIO_I_NAME_ROOM])
{
    if (channel == GONIO_ALL_CHANNELS || gonio_readings_are_colours(readings)) {
        snprintf(name, GONIO_I_NAME_ROOM, "%s", channel_names[channel + 1]);
    } else if (readings->wavelength != NULL && (size_t)channel < readings->channels) {
        snprintf(name, GONIO_I_NAME_ROOM, "%.10gnm", readings->wavelength[channel]);
    } else {
        snprintf(name, GONIO_I_NAME_ROOM, "%d", channel + 1);
    }
}

/* What is written again of a file. */
typedef struct kept_file {
    char *text;
    size_t size;
    gonio_i_csv_columns columns;
} kept_file;

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
        if (strcasecmp(cell, channel_names[k + 1]) == 0) {
            return k;
        }
    }
    const int channels = gonio_readings_are_colours(readings) ? 0 : (int)readings->channels;
    for (int k = 0; k < channels; k++) {
        char name[GONIO_I_NAME_ROOM];
        name_channel(readings, k, name);
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

static void release(void *data)
{
    kept_file *kept = data;
    gonio_i_csv_columns_free(&kept->columns);
    free(kept->text);
    free(kept);
}

/* The readings keep the text from here on. */
static kept_file *keep(gonio_i_readings_file *file, gonio_readings *readings)
{
    kept_file *kept = gonio_i_allocate(file->context, 1, sizeof *kept);
    if (kept != NULL) {
        *kept = (kept_file){.text = file->text, .size = file->size};
        readings->attachment = (gonio_i_attachment){kept, release};
        file->text = NULL;
    }
    return kept;
}

static gonio_status read_table(csv_source *s, kept_file *kept)
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
    kept_file *kept = keep(file, readings);
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

/* ---- writing ---- */

/* What a column of the file that is written holds: a cell of the file that was read, an angle, a
 * planned channel, or a value or deviation of one of the channels. */
typedef struct printed_column {
    gonio_i_column_kind kind;
    size_t index; /* of the column in the file that was read; of the angle; of the channel */
} printed_column;

typedef struct printer {
    FILE *stream;
    const gonio_readings *readings;
    char delimiter;
    size_t columns;
    printed_column *column; /* [columns] */
    bool first;             /* in its line */
} printer;

static void print_cell(printer *p, const char *text)
{
    if (!p->first) {
        fputc(p->delimiter, p->stream);
    }
    p->first = false;
    gonio_i_csv_print_cell(p->stream, text, p->delimiter);
}

static void end_line(printer *p)
{
    fputc('\n', p->stream);
    p->first = true;
}

/* Nothing for NaN. */
static void print_number(printer *p, double number, int digits)
{
    char text[64] = "";
    if (!isnan(number)) {
        snprintf(text, sizeof text, "%.*g", digits, number);
    }
    print_cell(p, text);
}

/* In degrees: as it was given, or of the pair. */
static double angle_of(const gonio_readings *readings, size_t reading, size_t which)
{
    const gonio_pair *pair = &readings->pair[reading];
    const double radians[4] = {pair->incident.theta, pair->incident.phi, pair->outgoing.theta,
                               pair->outgoing.phi};
    return readings->given != NULL ? readings->given[reading][which]
                                   : radians[which] * 180.0 / M_PI;
}

static void print_column(printer *p, const printed_column *column, size_t reading,
                         char *const *cell)
{
    const gonio_readings *r = p->readings;
    char name[GONIO_I_NAME_ROOM];
    switch (column->kind) {
    case GONIO_I_OTHER:
        print_cell(p, cell[column->index]);
        break;
    case GONIO_I_ANGLE:
        print_number(p, angle_of(r, reading, column->index), 12);
        break;
    case GONIO_I_PLANNED:
        name_channel(r, r->planned[reading], name);
        print_cell(p, name);
        break;
    case GONIO_I_VALUE:
        print_number(p, r->value[reading * r->channels + column->index], 10);
        break;
    case GONIO_I_DEVIATION:
        print_number(p, r->deviation[reading * r->channels + column->index], 10);
        break;
    }
}

static void print_row(printer *p, size_t reading, char *const *cell)
{
    for (size_t k = 0; k < p->columns; k++) {
        print_column(p, &p->column[k], reading, cell);
    }
    end_line(p);
}

static void print_names(printer *p, char *const *old)
{
    for (size_t k = 0; k < p->columns; k++) {
        const printed_column *column = &p->column[k];
        char name[GONIO_I_NAME_ROOM] = "channel";
        const bool channel = column->kind == GONIO_I_VALUE || column->kind == GONIO_I_DEVIATION;
        if (channel) {
            gonio_i_value_name(p->readings, column->index, column->kind == GONIO_I_DEVIATION, name);
        }
        print_cell(p, column->kind == GONIO_I_OTHER   ? old[column->index]
                      : column->kind == GONIO_I_ANGLE ? gonio_i_angle_names[column->index]
                                                      : name);
    }
    end_line(p);
}

/* The title, what the comments say of the plan, the reader's notes, and who writes the file. */
static bool print_comments(const printer *p, const char *command)
{
    gonio_i_comments all = {0};
    const gonio_i_comments *note = &p->readings->note;
    bool done = gonio_i_comments_copy(&all, &p->readings->comment);
    gonio_i_comments_drop(&all, "program");
    gonio_i_comments_drop(&all, "command");
    for (size_t k = 0; k < note->count && done; k++) {
        done = gonio_i_comments_add(&all, "note: %s", note->line[k]);
    }
    done = done && gonio_i_comments_add(&all, "program: gonio %s", gonio_version()) &&
           (command == NULL || gonio_i_comments_add(&all, "command: %s", command));
    for (size_t k = 0; k < all.count; k++) {
        const bool title = k == 0 && strcmp(all.line[k], "gonio plan") == 0;
        fprintf(p->stream, "# %s\n", title ? "gonio readings" : all.line[k]);
    }
    gonio_i_comments_free(&all);
    return done;
}

/* ---- which columns ---- */

static void add_column(printer *p, gonio_i_column_kind kind, size_t index)
{
    p->column[p->columns++] = (printed_column){kind, index};
}

/* The channel that a column of values or deviations of the file that was read still holds;
 * p->readings->channels if there is none. */
static size_t channel_now(const printer *p, const gonio_i_csv_columns *old,
                          const gonio_i_csv_column *column)
{
    const gonio_readings *r = p->readings;
    const bool named = r->wavelength != NULL;
    size_t k = 0;
    if (!named) {
        const bool same = old->wavelength == NULL && old->channels == r->channels;
        return same ? column->index : r->channels;
    }
    while (k < r->channels && r->wavelength[k] != column->wavelength) {
        k++;
    }
    return k;
}

/* The columns of the file that was read: as they were, but values and deviations are those of now,
 * and dropped where there are none. */
static void add_old_columns(printer *p, const gonio_i_csv_columns *old)
{
    for (size_t k = 0; k < old->count; k++) {
        const gonio_i_csv_column *column = &old->column[k];
        const bool deviation = column->kind == GONIO_I_DEVIATION;
        if (column->kind != GONIO_I_VALUE && !deviation) {
            add_column(p, GONIO_I_OTHER, k);
            continue;
        }
        const size_t channel = channel_now(p, old, column);
        if (channel < p->readings->channels && (!deviation || p->readings->deviation != NULL)) {
            add_column(p, column->kind, channel);
        }
    }
}

static bool has_column(const printer *p, gonio_i_column_kind kind, size_t index)
{
    size_t k = 0;
    while (k < p->columns && !(p->column[k].kind == kind && p->column[k].index == index)) {
        k++;
    }
    return k < p->columns;
}

static void add_missing_columns(printer *p, gonio_i_column_kind kind)
{
    for (size_t k = 0; k < p->readings->channels; k++) {
        if (!has_column(p, kind, k)) {
            add_column(p, kind, k);
        }
    }
}

/* Angles, and what was planned if it is not all channels everywhere. */
static void add_directions(printer *p)
{
    const gonio_readings *r = p->readings;
    size_t k = 0;
    for (size_t angle = 0; angle < 4; angle++) {
        add_column(p, GONIO_I_ANGLE, angle);
    }
    while (k < r->count && r->planned[k] == GONIO_ALL_CHANNELS) {
        k++;
    }
    if (k < r->count) {
        add_column(p, GONIO_I_PLANNED, 0);
    }
}

static gonio_status choose_columns(gonio_context *context, printer *p,
                                   const gonio_i_csv_columns *old)
{
    const size_t most = (old != NULL ? old->count : 5) + 2 * p->readings->channels;
    p->column = gonio_i_allocate(context, most, sizeof *p->column);
    if (p->column == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    if (old != NULL) {
        add_old_columns(p, old);
    } else {
        add_directions(p);
    }
    add_missing_columns(p, GONIO_I_VALUE);
    if (p->readings->deviation != NULL) {
        add_missing_columns(p, GONIO_I_DEVIATION);
    }
    return GONIO_OK;
}

/* ---- with and without a file that was read ---- */

static gonio_status print_over(gonio_context *context, printer *p, const kept_file *kept,
                               const char *command)
{
    gonio_i_csv_reader old;
    gonio_status status =
        gonio_i_csv_open(context, p->readings->path, kept->text, kept->size, &old);
    if (status != GONIO_OK) {
        return status;
    }
    p->delimiter = old.delimiter;
    status = choose_columns(context, p, &kept->columns);
    if (status == GONIO_OK) {
        status = print_comments(p, command) ? GONIO_OK : GONIO_ERROR_MEMORY;
    }
    if (status == GONIO_OK) {
        print_names(p, old.name);
    }
    for (size_t k = 0; k < p->readings->count && status == GONIO_OK; k++) {
        status = gonio_i_csv_next(&old);
        if (status == GONIO_OK) {
            print_row(p, k, old.cell);
        }
    }
    gonio_i_csv_close(&old);
    return status;
}

static gonio_status print_new(gonio_context *context, printer *p, const char *command)
{
    gonio_status status = choose_columns(context, p, NULL);
    if (status == GONIO_OK) {
        status = print_comments(p, command) ? GONIO_OK : GONIO_ERROR_MEMORY;
    }
    if (status == GONIO_OK) {
        print_names(p, NULL);
    }
    for (size_t k = 0; k < p->readings->count && status == GONIO_OK; k++) {
        print_row(p, k, NULL);
    }
    return status;
}

static gonio_status print(gonio_context *context, const gonio_readings *readings,
                          const char *command, FILE *stream)
{
    printer p = {.stream = stream, .readings = readings, .delimiter = ',', .first = true};
    const gonio_i_attachment *attachment = &readings->attachment;
    const gonio_status status = attachment->release == release
                                    ? print_over(context, &p, attachment->data, command)
                                    : print_new(context, &p, command);
    free(p.column);
    return status;
}

const gonio_i_readings_format gonio_i_readings_csv = {
    .name = "CSV", .probe = probe, .read = read, .print = print};
