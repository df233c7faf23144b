/* Tables as text: see csv.h. */
#include "csv.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "csv_reader.h"
#include "memory_stream.h"
#include "number.h"
#include "output.h"
#include "text_encoding.h"
#include "text_file.h"

gonio_i_csv *gonio_i_csv_create(gonio_context *context)
{
    gonio_i_csv *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made != NULL) {
        made->delimiter = ',';
    }
    return made;
}

static void free_strings(char **strings, size_t count)
{
    for (size_t k = 0; strings != NULL && k < count; k++) {
        free(strings[k]);
    }
    free(strings);
}

void gonio_i_csv_free(gonio_i_csv **csv)
{
    if (csv == NULL || *csv == NULL) {
        return;
    }
    gonio_i_comments_free(&(*csv)->comment);
    free_strings((*csv)->name, (*csv)->columns);
    free_strings((*csv)->cell, (*csv)->rows * (*csv)->columns);
    free((*csv)->line);
    free(*csv);
    *csv = NULL;
}

/* ---- building ---- */

/* The block with room for one more item. Capacities are powers of two. NULL when out of memory. */
static void *grow(void *block, size_t count, size_t size)
{
    if (count > 0 && (count & (count - 1)) != 0) {
        return block;
    }
    return reallocarray(block, count > 0 ? 2 * count : 1, size);
}

static bool append(char ***strings, size_t *count, char *text)
{
    char **more = text != NULL ? grow(*strings, *count, sizeof *more) : NULL;
    if (more == NULL) {
        free(text);
        return false;
    }
    more[(*count)++] = text;
    *strings = more;
    return true;
}

bool gonio_i_csv_add_column(gonio_i_csv *csv, const char *name)
{
    const size_t old = csv->columns;
    char **cell = calloc(csv->rows * (old + 1) + 1, sizeof *cell);
    if (cell == NULL || !append(&csv->name, &csv->columns, strdup(name))) {
        free(cell);
        return false;
    }
    bool done = true;
    for (size_t row = 0; row < csv->rows; row++) {
        if (old > 0) {
            memcpy(cell + row * (old + 1), csv->cell + row * old, old * sizeof *cell);
        }
        cell[row * (old + 1) + old] = strdup("");
        done = done && cell[row * (old + 1) + old] != NULL;
    }
    free(csv->cell);
    csv->cell = cell;
    return done;
}

bool gonio_i_csv_add_row(gonio_i_csv *csv, size_t number)
{
    const size_t count = csv->rows * csv->columns;
    char **cell = reallocarray(csv->cell, count + csv->columns + 1, sizeof *cell);
    if (cell == NULL) {
        return false;
    }
    csv->cell = cell;
    size_t *line = grow(csv->line, csv->rows, sizeof *line);
    if (line == NULL) {
        return false;
    }
    csv->line = line;
    bool done = true;
    for (size_t column = 0; column < csv->columns; column++) {
        cell[count + column] = strdup("");
        done = done && cell[count + column] != NULL;
    }
    csv->line[csv->rows++] = number;
    return done;
}

bool gonio_i_csv_set(gonio_i_csv *csv, size_t row, size_t column, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *text = gonio_i_format_list(format, arguments);
    va_end(arguments);
    if (text == NULL) {
        return false;
    }
    char **cell = csv->cell + row * csv->columns + column;
    free(*cell);
    *cell = text;
    return true;
}

/* ---- looking ---- */

int gonio_i_csv_column(const gonio_i_csv *csv, const char *name)
{
    for (size_t k = 0; k < csv->columns; k++) {
        if (strcasecmp(csv->name[k], name) == 0) {
            return (int)k;
        }
    }
    return -1;
}

const char *gonio_i_csv_cell(const gonio_i_csv *csv, size_t row, size_t column)
{
    return csv->cell[row * csv->columns + column];
}

bool gonio_i_csv_number(const gonio_i_csv *csv, size_t row, size_t column, double *value)
{
    gonio_i_plain_numbers plain;
    if (!gonio_i_plain_numbers_begin(&plain)) {
        return false;
    }
    const bool number =
        gonio_i_csv_is_number(gonio_i_csv_cell(csv, row, column), csv->delimiter, value);
    gonio_i_plain_numbers_end(&plain);
    return number;
}

/* ---- reading ---- */

static bool take_names(gonio_i_csv *csv, const gonio_i_csv_reader *r)
{
    bool done = true;
    csv->delimiter = r->delimiter;
    for (size_t k = 0; k < r->columns && done; k++) {
        done = gonio_i_csv_add_column(csv, r->name[k]);
    }
    return done;
}

static bool take_row(gonio_i_csv *csv, const gonio_i_csv_reader *r)
{
    size_t *lines = grow(csv->line, csv->rows, sizeof *lines);
    csv->line = lines != NULL ? lines : csv->line;
    char **cells = grow(csv->cell, csv->rows, csv->columns * sizeof *cells);
    csv->cell = cells != NULL ? cells : csv->cell;
    if (lines == NULL || cells == NULL) {
        return false;
    }
    bool done = true;
    for (size_t k = 0; k < r->cells; k++) {
        char *text = strdup(r->cell[k]);
        cells[csv->rows * csv->columns + k] = text;
        done = done && text != NULL;
    }
    csv->line[csv->rows++] = r->line;
    return done;
}

static gonio_status take_table(gonio_i_csv_reader *r, gonio_i_csv *csv)
{
    bool kept = take_names(csv, r);
    gonio_status status = kept ? gonio_i_csv_next(r) : GONIO_OK;
    while (status == GONIO_OK && r->cells > 0 && kept) {
        kept = take_row(csv, r);
        status = kept ? gonio_i_csv_next(r) : status;
    }
    if (!kept || (status == GONIO_OK && !gonio_i_comments_copy(&csv->comment, &r->comment))) {
        return gonio_i_fail(r->context, GONIO_ERROR_MEMORY, "%s: out of memory", r->path);
    }
    return status;
}

static gonio_status read_table(gonio_context *context, const char *path, const char *text,
                               size_t size, gonio_i_csv *csv)
{
    gonio_i_csv_reader reader;
    gonio_status status = gonio_i_csv_open(context, path, text, size, &reader);
    if (status == GONIO_OK) {
        status = take_table(&reader, csv);
        gonio_i_csv_close(&reader);
    }
    return status;
}

gonio_status gonio_i_csv_read(gonio_context *context, const char *path, gonio_i_csv **csv)
{
    gonio_i_csv *made = gonio_i_csv_create(context);
    char *text = NULL;
    size_t size = 0;
    gonio_status status =
        made == NULL ? GONIO_ERROR_MEMORY : gonio_i_text_read(context, path, &text, &size);
    if (status == GONIO_OK) {
        status = gonio_i_text_make_plain(context, path, &text, &size);
    }
    if (status == GONIO_OK) {
        status = read_table(context, path, text, size, made);
    }
    free(text);
    if (status != GONIO_OK) {
        gonio_i_csv_free(&made);
        return status;
    }
    *csv = made;
    return GONIO_OK;
}

/* ---- writing ---- */

static void print_line(FILE *stream, char *const *cells, size_t count, char delimiter)
{
    for (size_t k = 0; k < count; k++) {
        if (k > 0) {
            fputc(delimiter, stream);
        }
        gonio_i_csv_print_cell(stream, cells[k], delimiter);
    }
    fputc('\n', stream);
}

static void print_table(FILE *stream, const gonio_i_csv *csv)
{
    for (size_t k = 0; k < csv->comment.count; k++) {
        fprintf(stream, "# %s\n", csv->comment.line[k]);
    }
    print_line(stream, csv->name, csv->columns, csv->delimiter);
    for (size_t row = 0; row < csv->rows; row++) {
        print_line(stream, csv->cell + row * csv->columns, csv->columns, csv->delimiter);
    }
}

gonio_status gonio_i_csv_write(gonio_context *context, const gonio_i_csv *csv, const char *path)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = gonio_i_memory_stream(&text, &size);
    if (stream == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    }
    print_table(stream, csv);
    if (fclose(stream) != 0) {
        free(text);
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    }
    gonio_i_output output;
    gonio_status status = gonio_i_output_open(context, path, &output);
    if (status == GONIO_OK) {
        status = gonio_i_output_write(context, &output, text, size);
        status = gonio_i_output_close(context, &output, status);
    }
    free(text);
    return status;
}
