/* Writing readings as CSV: see csv_kept.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../rules.h"
#include "csv_kept.h"
#include "csv_unit_row.h"

/* A column of the written file: a column of the file that was read, an angle, the planned channel,
 * or the value or deviation of a channel. */
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

/* Prints a number; NaN is an empty cell. */
static void print_number(printer *p, double number, int digits)
{
    char text[64] = "";
    if (!isnan(number)) {
        snprintf(text, sizeof text, "%.*g", digits, number);
    }
    print_cell(p, text);
}

static void print_column(printer *p, const printed_column *column, size_t reading,
                         char *const *cell)
{
    const gonio_readings *r = p->readings;
    char name[GONIO_I_NAME_ROOM];
    switch (column->kind) {
    case GONIO_I_OTHER:
    case GONIO_I_ROW_WAVELENGTH:
    case GONIO_I_ROW_COLOUR:
    case GONIO_I_POLARISATION:
    case GONIO_I_TIME:
    case GONIO_I_MARK:
        print_cell(p, cell != NULL ? cell[column->index] : "");
        break;
    case GONIO_I_ANGLE:
        print_number(p, gonio_i_readings_degrees(r, reading, column->index), 12);
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

static bool has_note(const gonio_i_comments *comments, const char *note)
{
    bool found = false;
    for (size_t k = 0; k < comments->count && !found; k++) {
        const char *line = comments->line[k];
        found = strncmp(line, "note: ", 6) == 0 && strcmp(line + 6, note) == 0;
    }
    return found;
}

/* Adds the reader's notes, once each. */
static bool add_notes(gonio_i_comments *all, const gonio_i_comments *note)
{
    bool done = true;
    for (size_t k = 0; k < note->count && done; k++) {
        done = has_note(all, note->line[k]) || gonio_i_comments_add(all, "note: %s", note->line[k]);
    }
    return done;
}

/* Drops comments on units, because gonio writes its own units. */
static void drop_units(gonio_i_comments *all)
{
    static const char *const keys[] = {"unit",       "units",       "values",
                                       "angles",     "angle units", "angle unit",
                                       "value unit", "quantity",    "mirror"};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        gonio_i_comments_drop(all, keys[k]);
    }
}

/* Prints the title, the comments on the plan, the reader's notes, and the program. */
static gonio_status print_comments(gonio_context *context, const printer *p, const char *command)
{
    const gonio_i_csv_kept *kept = gonio_i_csv_kept_of(p->readings);
    gonio_i_comments all = {0};
    bool done = gonio_i_comments_copy(&all, &p->readings->comment);
    gonio_i_comments_drop(&all, "program");
    gonio_i_comments_drop(&all, "command");
    if (kept != NULL && !kept->columns.own) {
        drop_units(&all);
    }
    done = done && add_notes(&all, &p->readings->note) &&
           gonio_i_comments_add(&all, "program: gonio %s", gonio_version()) &&
           (command == NULL || gonio_i_comments_add(&all, "command: %s", command));
    /* The first line says what the file is, also if other comments look like those of a format. */
    const char *first = all.count > 0 ? all.line[0] : "";
    const bool titled = strcmp(first, "gonio plan") == 0 || strcmp(first, "gonio readings") == 0;
    fputs("# gonio readings\n", p->stream);
    for (size_t k = titled ? 1 : 0; k < all.count; k++) {
        fprintf(p->stream, "# %s\n", all.line[k]);
    }
    gonio_i_comments_free(&all);
    return done ? GONIO_OK : gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
}

/* ---- the columns ---- */

static void add_column(printer *p, gonio_i_column_kind kind, size_t index)
{
    p->column[p->columns++] = (printed_column){kind, index};
}

static bool has_column(const printer *p, gonio_i_column_kind kind, size_t index)
{
    size_t k = 0;
    while (k < p->columns && !(p->column[k].kind == kind && p->column[k].index == index)) {
        k++;
    }
    return k < p->columns;
}

/* The channel of a column of values or deviations in the file that was read;
 * p->readings->channels if the readings no longer have it. */
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
    if (column->index < r->channels && r->wavelength[column->index] == column->wavelength) {
        return column->index;
    }
    while (k < r->channels && r->wavelength[k] != column->wavelength) {
        k++;
    }
    return k;
}

/* Adds a column of angles. If angles are written anew, all four take the place of the first. */
static void add_old_angle(printer *p, bool rewrite, size_t k)
{
    if (!rewrite) {
        add_column(p, GONIO_I_OTHER, k);
        return;
    }
    for (size_t angle = 0; angle < 4 && !has_column(p, GONIO_I_ANGLE, angle); angle++) {
        add_column(p, GONIO_I_ANGLE, angle);
    }
}

static bool has_name_of(const gonio_readings *r, size_t channel, const char *old_name)
{
    char value[GONIO_I_NAME_ROOM];
    char deviation[GONIO_I_NAME_ROOM];
    gonio_i_value_name(r, channel, false, value);
    gonio_i_value_name(r, channel, true, deviation);
    return strcasecmp(value, old_name) == 0 || strcasecmp(deviation, old_name) == 0;
}

/* Whether an unread column would be read from the written file: it has deviations of values that
 * the file lacks, but gonio writes. */
static bool is_written_anew(const printer *p, const char *old_name)
{
    const gonio_readings *r = p->readings;
    const gonio_i_column_name name = gonio_i_column_name_of(old_name);
    if (name.kind == GONIO_I_DEVIATION && name.family == GONIO_I_COLOUR) {
        return gonio_readings_are_colours(r);
    }
    bool same = false;
    for (size_t k = 0; k < r->channels && !same && name.own; k++) {
        same = has_name_of(r, k, old_name);
    }
    return same;
}

/* Adds the columns of the file that was read. Values and deviations are the present ones; columns
 * without any are dropped. */
static void add_old_columns(printer *p, const gonio_i_csv_kept *kept, char *const *name)
{
    const gonio_i_csv_columns *old = &kept->columns;
    for (size_t k = 0; k < old->count; k++) {
        const gonio_i_csv_column *column = &old->column[k];
        const bool deviation = column->kind == GONIO_I_DEVIATION;
        if (column->kind == GONIO_I_ANGLE) {
            add_old_angle(p, kept->rewrite_angles, k);
            continue;
        }
        if (column->kind != GONIO_I_VALUE && !deviation) {
            if (column->kind == GONIO_I_PLANNED || !is_written_anew(p, name[k])) {
                add_column(p, GONIO_I_OTHER, k);
            }
            continue;
        }
        const size_t channel = channel_now(p, old, column);
        if (!column->second && channel < p->readings->channels &&
            (!deviation || p->readings->deviation != NULL)) {
            add_column(p, column->kind, channel);
        }
    }
}

static gonio_status add_missing_columns(gonio_context *context, printer *p,
                                        gonio_i_column_kind kind)
{
    bool *there = gonio_i_allocate(context, p->readings->channels, sizeof *there);
    if (there == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < p->columns; k++) {
        if (p->column[k].kind == kind) {
            there[p->column[k].index] = true;
        }
    }
    for (size_t k = 0; k < p->readings->channels; k++) {
        if (!there[k]) {
            add_column(p, kind, k);
        }
    }
    free(there);
    return GONIO_OK;
}

/* Adds the angles, and the planned channel unless it is always all channels. */
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

static gonio_status choose_columns(gonio_context *context, printer *p, const gonio_i_csv_kept *old,
                                   char *const *old_name)
{
    const size_t most = (old != NULL ? old->columns.count : 0) + 5 + 2 * p->readings->channels;
    p->column = gonio_i_allocate(context, most, sizeof *p->column);
    if (p->column == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    if (old != NULL) {
        add_old_columns(p, old, old_name);
    } else {
        add_directions(p);
    }
    gonio_status status = add_missing_columns(context, p, GONIO_I_VALUE);
    if (status == GONIO_OK && p->readings->deviation != NULL) {
        status = add_missing_columns(context, p, GONIO_I_DEVIATION);
    }
    return status;
}

/* ---- files written again, and new ones ---- */

/* Goes to the row of the old file that a reading comes from. Rows that are no readings are skipped.
 */
static gonio_status find_row(gonio_i_csv_reader *old, size_t line)
{
    gonio_status status = gonio_i_csv_next(old);
    while (status == GONIO_OK && old->cells > 0 && old->line < line) {
        status = gonio_i_csv_next(old);
    }
    return status;
}

static gonio_status print_rows_over(printer *p, gonio_i_csv_reader *old)
{
    gonio_status status = gonio_i_csv_take_units(old);
    if (status == GONIO_OK) {
        print_names(p, old->name);
    }
    for (size_t k = 0; k < p->readings->count && status == GONIO_OK; k++) {
        status = find_row(old, p->readings->line[k]);
        if (status == GONIO_OK) {
            print_row(p, k, old->cell);
        }
    }
    return status;
}

static gonio_status print_over(gonio_context *context, printer *p, const gonio_i_csv_kept *kept,
                               const char *command)
{
    gonio_i_csv_reader old;
    gonio_status status =
        gonio_i_csv_open(context, p->readings->path, kept->text, kept->size, &old);
    if (status != GONIO_OK) {
        return status;
    }
    old.remarks_allowed = true;
    p->delimiter = old.delimiter;
    status = choose_columns(context, p, kept, old.name);
    if (status == GONIO_OK) {
        status = print_comments(context, p, command);
    }
    status = status == GONIO_OK ? print_rows_over(p, &old) : status;
    gonio_i_csv_close(&old);
    return status;
}

static gonio_status print_new(gonio_context *context, printer *p, const char *command)
{
    gonio_status status = choose_columns(context, p, NULL, NULL);
    if (status == GONIO_OK) {
        status = print_comments(context, p, command);
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
