/* Writing readings as CSV: see csv_columns.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../rules.h"
#include "csv_columns.h"

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
        print_cell(p, cell != NULL ? cell[column->index] : "");
        break;
    case GONIO_I_ANGLE:
        print_number(p, angle_of(r, reading, column->index), 12);
        break;
    case GONIO_I_PLANNED:
        gonio_i_csv_name_channel(r, r->planned[reading], name);
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
        const bool other = column->kind == GONIO_I_OTHER && old != NULL;
        print_cell(p, other                           ? old[column->index]
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

static gonio_status print_over(gonio_context *context, printer *p, const gonio_i_csv_kept *kept,
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

gonio_status gonio_i_csv_print(gonio_context *context, const gonio_readings *readings,
                               const char *command, FILE *stream)
{
    printer p = {.stream = stream, .readings = readings, .delimiter = ',', .first = true};
    const gonio_i_csv_kept *kept = gonio_i_csv_kept_of(readings);
    const gonio_status status =
        kept != NULL ? print_over(context, &p, kept, command) : print_new(context, &p, command);
    free(p.column);
    return status;
}
