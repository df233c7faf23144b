/* One line of a run: see row.h. */
#include "row.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/csv_reader.h"
#include "core/number.h"
#include "measurement/formats/csv_columns.h"
#include "measurement/formats/csv_unit_row.h"
#include "measurement/marks.h"

/* Keeps the first error. */
static void keep_error(void *user, gonio_message_level level, const char *text)
{
    char **problem = user;
    if (level == GONIO_MESSAGE_ERROR && *problem == NULL) {
        *problem = strdup(text);
    }
}

static gonio_status quiet_context(char **problem, gonio_context **context)
{
    const gonio_context_options options = {
        .size = sizeof options, .message = keep_error, .user = problem, .threads = 1};
    return gonio_context_create(context, &options);
}

gonio_status row_check_names(run *r, const char *head)
{
    gonio_i_csv_reader reader;
    gonio_i_csv_columns columns;
    gonio_context *context = NULL;
    free(r->problem);
    r->problem = NULL;
    gonio_status status = quiet_context(&r->problem, &context);
    if (status == GONIO_OK) {
        status = gonio_i_csv_open(context, r->path, head, strlen(head), &reader);
    }
    if (status == GONIO_OK) {
        status = gonio_i_csv_columns_find(&reader, &r->how, &columns);
        if (status == GONIO_OK) {
            gonio_i_csv_columns_free(&columns);
        }
        gonio_i_csv_close(&reader);
    }
    gonio_context_free(&context);
    return status;
}

/* The text of head and line; *line: its number there. */
static char *below_head(const run *r, const char *text, size_t *line)
{
    const size_t head = strlen(r->head);
    char *whole = malloc(head + strlen(text) + 2);
    *line = 1;
    for (size_t k = 0; k < head; k++) {
        *line += r->head[k] == '\n';
    }
    if (whole != NULL) {
        memcpy(whole, r->head, head);
        stpcpy(stpcpy(whole + head, text), "\n");
    }
    return whole;
}

/* Gives a message that begins with the place "PATH:FROM:" the line's own number. */
static void renumber(run *r, size_t from, size_t line)
{
    const size_t path = strlen(r->path);
    char place[32];
    char *after = NULL;
    const int length = snprintf(place, sizeof place, ":%zu:", from);
    if (r->problem != NULL && strncmp(r->problem, r->path, path) == 0 &&
        strncmp(r->problem + path, place, (size_t)length) == 0 &&
        asprintf(&after, "%s:%zu:%s", r->path, line, r->problem + path + length) >= 0) {
        free(r->problem);
        r->problem = after;
    }
}

/* The mark of the row of a text. */
static gonio_i_mark mark_of(const char *path, const char *text)
{
    gonio_i_csv_reader reader;
    gonio_i_mark mark = GONIO_I_SAMPLE;
    if (gonio_i_csv_open(NULL, path, text, strlen(text), &reader) != GONIO_OK) {
        return mark;
    }
    if (gonio_i_csv_take_units(&reader) == GONIO_OK && gonio_i_csv_next(&reader) == GONIO_OK) {
        for (size_t k = 0; k < reader.cells; k++) {
            const gonio_i_column_name name = gonio_i_column_name_of(reader.name[k]);
            mark = name.kind == GONIO_I_MARK ? gonio_i_mark_of(reader.cell[k]) : mark;
        }
    }
    gonio_i_csv_close(&reader);
    return mark;
}

static gonio_status take_reading(const gonio_readings *reading, run_row *row)
{
    const gonio_readings_view *view = gonio_readings_describe(reading);
    row->pair = view->pair[0];
    row->time = view->time != NULL ? view->time[0] : NAN;
    row->channels = view->channels;
    row->value = calloc(view->channels, sizeof *row->value);
    if (row->value == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(row->value, view->value, view->channels * sizeof *row->value);
    row->of_sample = true;
    return GONIO_OK;
}

static gonio_status read_line(gonio_context *context, run *r, const char *text, run_row *row)
{
    gonio_readings *reading = NULL;
    size_t line = 0;
    char *whole = below_head(r, text, &line);
    gonio_status status = whole == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK && mark_of(r->path, whole) != GONIO_I_SAMPLE) {
        row->time = NAN;
    } else if (status == GONIO_OK) {
        status =
            gonio_readings_read_text(context, r->path, whole, strlen(whole), &r->how, &reading);
        status = status == GONIO_OK ? take_reading(reading, row) : status;
    }
    renumber(r, line, row->line);
    gonio_readings_free(&reading);
    free(whole);
    return status;
}

bool row_read(run *r, const char *text, run_row *row, gonio_status *status)
{
    gonio_context *context = NULL;
    *status = quiet_context(&r->problem, &context);
    if (*status == GONIO_OK) {
        *status = read_line(context, r, text, row);
    }
    gonio_context_free(&context);
    const bool read = *status == GONIO_OK;
    *status = *status == GONIO_ERROR_MEMORY ? *status : GONIO_OK;
    return read;
}
