/* Tables as text: see csv.h. */
#include "csv.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csv.h>

#include "output.h"

enum { MOST_BYTES = 1 << 30 };

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
    free_strings((*csv)->comment, (*csv)->comments);
    free_strings((*csv)->name, (*csv)->columns);
    free_strings((*csv)->cell, (*csv)->rows * (*csv)->columns);
    free((*csv)->line);
    free(*csv);
    *csv = NULL;
}

/* ---- building ---- */

/* The block with room for one more item, capacities being powers of two; NULL when out of memory.
 */
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

/* A formatted string with decimal points, whatever the program's locale; NULL when out of memory.
 */
static char *format_plain(const char *format, va_list arguments)
{
    const locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0) {
        return NULL;
    }
    char *text = NULL;
    const locale_t before = uselocale(plain);
    const int length = vasprintf(&text, format, arguments);
    uselocale(before);
    freelocale(plain);
    return length < 0 ? NULL : text;
}

bool gonio_i_csv_add_comment(gonio_i_csv *csv, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *text = format_plain(format, arguments);
    va_end(arguments);
    return append(&csv->comment, &csv->comments, text);
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
    char *text = format_plain(format, arguments);
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
    char text[64];
    const char *cell = gonio_i_csv_cell(csv, row, column);
    if (*cell == '\0' || strlen(cell) >= sizeof text) {
        return false;
    }
    strcpy(text, cell);
    char *comma = csv->delimiter != ',' ? strchr(text, ',') : NULL;
    if (comma != NULL) {
        *comma = '.';
    }
    const locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    char *end = text;
    if (plain != (locale_t)0) {
        *value = strtod_l(text, &end, plain);
        freelocale(plain);
    }
    return end != text && *end == '\0';
}

static const char *note_of(const char *comment, const char *key)
{
    const size_t length = strlen(key);
    if (strncmp(comment, key, length) != 0 || comment[length] != ':') {
        return NULL;
    }
    const char *text = comment + length + 1;
    return text + strspn(text, " ");
}

const char *gonio_i_csv_note(const gonio_i_csv *csv, const char *key)
{
    for (size_t k = 0; k < csv->comments; k++) {
        const char *text = note_of(csv->comment[k], key);
        if (text != NULL) {
            return text;
        }
    }
    return NULL;
}

void gonio_i_csv_drop_note(gonio_i_csv *csv, const char *key)
{
    size_t kept = 0;
    for (size_t k = 0; k < csv->comments; k++) {
        if (note_of(csv->comment[k], key) != NULL) {
            free(csv->comment[k]);
        } else {
            csv->comment[kept++] = csv->comment[k];
        }
    }
    csv->comments = kept;
}

/* ---- reading ---- */

static gonio_status read_descriptor(gonio_context *context, const char *path, int descriptor,
                                    char **text, size_t *size)
{
    size_t room = 1 << 16;
    *text = malloc(room + 1);
    *size = 0;
    while (*text != NULL) {
        const ssize_t got = read(descriptor, *text + *size, room - *size);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got < 0) {
            return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path,
                                strerror(errno));
        }
        if (got == 0) {
            (*text)[*size] = '\0';
            return GONIO_OK;
        }
        *size += (size_t)got;
        if (*size == room && room >= MOST_BYTES) {
            return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                                "%s: more than 1 GiB; this is not a table of readings", path);
        }
        if (*size == room) {
            room *= 2;
            char *more = realloc(*text, room + 1);
            if (more == NULL) {
                break;
            }
            *text = more;
        }
    }
    return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
}

static gonio_status read_text(gonio_context *context, const char *path, char **text, size_t *size)
{
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    }
    const gonio_status status = read_descriptor(context, path, descriptor, text, size);
    close(descriptor);
    return status;
}

/* One record on its way from libcsv into the table. */
typedef struct record {
    char **cell;
    size_t count;
    bool ended;
    bool failed;
} record;

static void on_cell(void *text, size_t length, void *data)
{
    record *r = data;
    r->failed =
        !append(&r->cell, &r->count, strndup(text != NULL ? text : "", length)) || r->failed;
}

static void on_end(int terminator, void *data)
{
    (void)terminator;
    ((record *)data)->ended = true;
}

typedef struct source {
    gonio_context *context;
    const char *path;
    struct csv_parser parser;
    gonio_i_csv *csv;
    size_t line;
} source;

static gonio_status bad_line(const source *s, const char *problem)
{
    return gonio_i_fail(s->context, GONIO_ERROR_FORMAT, "%s:%zu: %s", s->path, s->line, problem);
}

/* The separator that occurs most often in the header. */
static char guess_delimiter(const char *line, size_t length)
{
    static const char candidates[] = {',', ';', '\t'};
    size_t most = 0;
    char best = ',';
    for (size_t k = 0; k < sizeof candidates; k++) {
        size_t count = 0;
        for (size_t j = 0; j < length; j++) {
            count += line[j] == candidates[k];
        }
        if (count > most) {
            most = count;
            best = candidates[k];
        }
    }
    return best;
}

static gonio_status take_header(source *s, record *r)
{
    for (size_t k = 0; k < r->count; k++) {
        if (gonio_i_csv_column(s->csv, r->cell[k]) >= 0) {
            return gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                                "%s:%zu: column '%s' occurs twice; rename one", s->path, s->line,
                                r->cell[k]);
        }
        if (!gonio_i_csv_add_column(s->csv, r->cell[k])) {
            return gonio_i_fail(s->context, GONIO_ERROR_MEMORY, "%s: out of memory", s->path);
        }
    }
    return GONIO_OK;
}

static gonio_status take_row(source *s, record *r)
{
    gonio_i_csv *csv = s->csv;
    if (r->count != csv->columns) {
        return gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: %zu cells where the header names %zu columns", s->path,
                            s->line, r->count, csv->columns);
    }
    size_t *lines = grow(csv->line, csv->rows, sizeof *lines);
    csv->line = lines != NULL ? lines : csv->line;
    char **cells = grow(csv->cell, csv->rows, csv->columns * sizeof *cells);
    csv->cell = cells != NULL ? cells : csv->cell;
    if (lines == NULL || cells == NULL) {
        return gonio_i_fail(s->context, GONIO_ERROR_MEMORY, "%s: out of memory", s->path);
    }
    memcpy(csv->cell + csv->rows * csv->columns, r->cell, r->count * sizeof *r->cell);
    r->count = 0; /* the strings are the table's now */
    csv->line[csv->rows++] = s->line;
    return GONIO_OK;
}

static gonio_status take_line(source *s, const char *line, size_t length)
{
    record r = {0};
    if (s->csv->columns == 0) {
        s->csv->delimiter = guess_delimiter(line, length);
        csv_set_delim(&s->parser, (unsigned char)s->csv->delimiter);
    }
    gonio_status status = GONIO_OK;
    const bool parsed = csv_parse(&s->parser, line, length, on_cell, on_end, &r) == length &&
                        (r.ended || csv_fini(&s->parser, on_cell, on_end, &r) == 0);
    if (r.failed) {
        status = gonio_i_fail(s->context, GONIO_ERROR_MEMORY, "%s: out of memory", s->path);
    } else if (!parsed) {
        status = bad_line(s, "quotes that do not close or stand inside a cell");
    } else if (r.ended) {
        status = s->csv->columns == 0 ? take_header(s, &r) : take_row(s, &r);
    }
    free_strings(r.cell, r.count);
    return status;
}

static bool take_comment(source *s, const char *line, size_t length)
{
    while (length > 0 && isspace((unsigned char)line[length - 1])) {
        length--;
    }
    size_t skip = 1;
    while (skip < length && line[skip] == ' ') {
        skip++;
    }
    return gonio_i_csv_add_comment(s->csv, "%.*s", (int)(length - skip), line + skip);
}

/* Whether a line holds what no text does: control characters other than blanks. */
static bool is_binary(const char *line, size_t length)
{
    size_t k = 0;
    while (k < length && (!iscntrl((unsigned char)line[k]) || isspace((unsigned char)line[k]))) {
        k++;
    }
    return k < length;
}

static bool is_blank(const char *line, size_t length)
{
    size_t k = 0;
    while (k < length && isspace((unsigned char)line[k])) {
        k++;
    }
    return k == length;
}

static gonio_status take_text(source *s, const char *text, size_t size)
{
    static const char mark[] = "\xef\xbb\xbf";
    size_t at = size >= 3 && memcmp(text, mark, 3) == 0 ? 3 : 0;
    gonio_status status = GONIO_OK;
    while (at < size && status == GONIO_OK) {
        const char *line = text + at;
        const char *end = memchr(line, '\n', size - at);
        const size_t length = end != NULL ? (size_t)(end - line) + 1 : size - at;
        s->line++;
        if (is_binary(line, length)) {
            status = bad_line(s, "binary data; a text table (CSV) is expected");
        } else if (line[0] == '#') {
            status = take_comment(s, line, length) ? GONIO_OK : GONIO_ERROR_MEMORY;
        } else if (!is_blank(line, length)) {
            status = take_line(s, line, length);
        }
        at += length;
    }
    if (status == GONIO_OK && s->csv->columns == 0) {
        status = gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                              size == 0 ? "%s: the file is empty" : "%s: no line of column names",
                              s->path);
    }
    return status;
}

gonio_status gonio_i_csv_read(gonio_context *context, const char *path, gonio_i_csv **csv)
{
    source s = {.context = context, .path = path, .csv = gonio_i_csv_create(context)};
    if (s.csv == NULL || csv_init(&s.parser, CSV_STRICT | CSV_STRICT_FINI | CSV_APPEND_NULL) != 0) {
        gonio_i_csv_free(&s.csv);
        return GONIO_ERROR_MEMORY;
    }
    char *text = NULL;
    size_t size = 0;
    gonio_status status = read_text(context, path, &text, &size);
    if (status == GONIO_OK) {
        status = take_text(&s, text, size);
    }
    free(text);
    csv_free(&s.parser);
    if (status != GONIO_OK) {
        gonio_i_csv_free(&s.csv);
        return status;
    }
    *csv = s.csv;
    return GONIO_OK;
}

/* ---- writing ---- */

static void print_cell(FILE *stream, const char *cell, char delimiter)
{
    const bool plain = strchr(cell, delimiter) == NULL && strchr(cell, '"') == NULL &&
                       cell[0] != ' ' && cell[0] != '#';
    if (plain) {
        fputs(cell, stream);
    } else {
        csv_fwrite(stream, cell, strlen(cell));
    }
}

static void print_line(FILE *stream, char *const *cells, size_t count, char delimiter)
{
    for (size_t k = 0; k < count; k++) {
        if (k > 0) {
            fputc(delimiter, stream);
        }
        print_cell(stream, cells[k], delimiter);
    }
    fputc('\n', stream);
}

static void print_table(FILE *stream, const gonio_i_csv *csv)
{
    for (size_t k = 0; k < csv->comments; k++) {
        fprintf(stream, "# %s\n", csv->comment[k]);
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
    FILE *stream = open_memstream(&text, &size);
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
