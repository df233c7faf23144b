/* Rows of a table as text: see csv_reader.h. */
#include "csv_reader.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <csv.h>

#include "text_numbers.h"

/* ---- a line as cells ---- */

typedef struct line_state {
    gonio_i_csv_reader *reader;
    char *next; /* where the next cell goes */
    bool ended;
    bool failed;
} line_state;

static bool has_room(gonio_i_csv_reader *r)
{
    if (r->cells < r->cell_room) {
        return true;
    }
    const size_t more = r->cell_room > 0 ? 2 * r->cell_room : 16;
    char **cell = reallocarray(r->cell, more, sizeof *cell);
    r->cell = cell != NULL ? cell : r->cell;
    r->cell_room = cell != NULL ? more : r->cell_room;
    return cell != NULL;
}

static void on_cell(void *text, size_t length, void *data)
{
    line_state *state = data;
    state->failed = state->failed || !has_room(state->reader);
    if (state->failed) {
        return;
    }
    if (length > 0) {
        memcpy(state->next, text, length);
    }
    state->next[length] = '\0';
    state->reader->cell[state->reader->cells++] = state->next;
    state->next += length + 1;
}

static void on_end(int terminator, void *data)
{
    (void)terminator;
    ((line_state *)data)->ended = true;
}

static gonio_status out_of_memory(const gonio_i_csv_reader *r)
{
    return gonio_i_fail(r->context, GONIO_ERROR_MEMORY, "%s: out of memory", r->path);
}

/* For the cells of a line of `length` bytes, each with a 0 behind it. */
static bool make_room(gonio_i_csv_reader *r, size_t length)
{
    const size_t needed = 2 * length + 2;
    if (needed <= r->room_size) {
        return true;
    }
    char *room = realloc(r->room, 2 * needed);
    r->room = room != NULL ? room : r->room;
    r->room_size = room != NULL ? 2 * needed : r->room_size;
    return room != NULL;
}

static gonio_status bad_line(const gonio_i_csv_reader *r, const char *problem)
{
    return gonio_i_fail(r->context, GONIO_ERROR_FORMAT, "%s:%zu: %s", r->path, r->line, problem);
}

static gonio_status split(gonio_i_csv_reader *r, const char *line, size_t length)
{
    if (!make_room(r, length)) {
        return out_of_memory(r);
    }
    line_state state = {r, r->room, false, false};
    r->cells = 0;
    const bool parsed = csv_parse(r->parser, line, length, on_cell, on_end, &state) == length &&
                        (state.ended || csv_fini(r->parser, on_cell, on_end, &state) == 0);
    if (state.failed || (!parsed && csv_error(r->parser) == CSV_ENOMEM)) {
        return out_of_memory(r);
    }
    return parsed ? GONIO_OK : bad_line(r, "quotes that do not close or stand inside a cell");
}

/* The next line that is neither a comment nor empty; *length is 0 at the end of the text. */
static gonio_status find_line(gonio_i_csv_reader *r, const char **line, size_t *length)
{
    const bool found = gonio_i_csv_lines_next(&r->lines, line, length);
    r->line = r->lines.number;
    return found ? GONIO_OK : out_of_memory(r);
}

/* ---- the column names ---- */

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

static int compare_names(const void *a, const void *b)
{
    return strcasecmp(**(char ***)a, **(char ***)b);
}

/* Columns without a name may be many. */
static gonio_status check_names(const gonio_i_csv_reader *r)
{
    char ***sorted = gonio_i_allocate(r->context, r->columns + 1, sizeof *sorted);
    if (sorted == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < r->columns; k++) {
        sorted[k] = &r->name[k];
    }
    qsort(sorted, r->columns, sizeof *sorted, compare_names);
    gonio_status status = GONIO_OK;
    for (size_t k = 1; k < r->columns && status == GONIO_OK; k++) {
        if (**sorted[k] != '\0' && compare_names(&sorted[k - 1], &sorted[k]) == 0) {
            char **later = sorted[k] > sorted[k - 1] ? sorted[k] : sorted[k - 1];
            status = gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                                  "%s:%zu: column '%s' occurs twice; rename one", r->path, r->line,
                                  *later);
        }
    }
    free(sorted);
    return status;
}

/* The line of column names, behind one that states the separator. */
static gonio_status find_names(gonio_i_csv_reader *r, const char **line, size_t *length)
{
    gonio_status status = find_line(r, line, length);
    r->delimiter = status == GONIO_OK ? gonio_i_csv_stated_separator(*line, *length) : '\0';
    if (r->delimiter != '\0') {
        return find_line(r, line, length);
    }
    r->delimiter = status == GONIO_OK ? guess_delimiter(*line, *length) : '\0';
    return status;
}

static gonio_status read_names(gonio_i_csv_reader *r)
{
    const char *line = NULL;
    size_t length = 0;
    gonio_status status = find_names(r, &line, &length);
    if (status == GONIO_OK && length == 0) {
        return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                            r->size == 0 ? "%s: the file is empty" : "%s: no line of column names",
                            r->path);
    }
    if (status == GONIO_OK) {
        csv_set_delim(r->parser, (unsigned char)r->delimiter);
        status = split(r, line, length);
    }
    for (size_t k = 0; k < r->cells; k++) {
        gonio_i_csv_blank_controls(r->cell[k], strlen(r->cell[k]));
    }
    r->name = r->cell;
    r->name_room = r->room;
    r->columns = r->cells;
    r->cell = NULL;
    r->cell_room = 0;
    r->cells = 0;
    r->room = NULL;
    r->room_size = 0;
    return status == GONIO_OK ? check_names(r) : status;
}

/* Refuses what no text holds, control characters other than blanks, before anything else is said of
 * the file. */
static gonio_status refuse_binary(const gonio_i_csv_reader *r)
{
    size_t line = 1;
    for (size_t k = 0; k < r->size; k++) {
        const unsigned char c = (unsigned char)r->text[k];
        if (c >= ' ' && c != 0x7f) {
            continue;
        }
        if (!isspace(c)) {
            return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                                "%s:%zu: binary data; a text table (CSV) is expected", r->path,
                                line);
        }
        line += c == '\n';
    }
    return GONIO_OK;
}

gonio_status gonio_i_csv_open(gonio_context *context, const char *path, const char *text,
                              size_t size, gonio_i_csv_reader *reader)
{
    *reader = (gonio_i_csv_reader){.context = context, .path = path, .text = text, .size = size};
    gonio_i_csv_lines_begin(&reader->lines, text, size, &reader->comment);
    reader->parser = gonio_i_allocate(context, 1, sizeof *reader->parser);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (reader->parser != NULL &&
        csv_init(reader->parser, CSV_STRICT | CSV_STRICT_FINI | CSV_APPEND_NULL) == 0) {
        status = refuse_binary(reader);
        status = status == GONIO_OK ? read_names(reader) : status;
    }
    if (status != GONIO_OK) {
        gonio_i_csv_close(reader);
    }
    return status;
}

/* Whether no cell has a point: commas may have parted numbers. */
static bool have_no_points(const gonio_i_csv_reader *r)
{
    bool none = true;
    for (size_t k = 0; k < r->cells; k++) {
        none = none && strchr(r->cell[k], '.') == NULL;
    }
    return none;
}

/* Whether rows may end before a column: it has no name, or is for remarks. */
static bool may_be_missing(const char *name)
{
    return *name == '\0' || strcasecmp(name, "comment") == 0 || strcasecmp(name, "comments") == 0 ||
           strcasecmp(name, "remark") == 0 || strcasecmp(name, "remarks") == 0;
}

/* Cells that are empty beyond the names are no cells, and names may be missing beyond the cells. */
static gonio_status fit_cells(gonio_i_csv_reader *r)
{
    while (r->cells > r->columns && r->cell[r->cells - 1][0] == '\0') {
        r->cells--;
    }
    const size_t found = r->cells;
    while (r->cells < r->columns && may_be_missing(r->name[r->cells])) {
        if (!has_room(r)) {
            return out_of_memory(r);
        }
        r->cell[r->cells] = r->name[r->cells] + strlen(r->name[r->cells]);
        r->cells++;
    }
    return r->cells == r->columns
               ? GONIO_OK
               : gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                              "%s:%zu: %zu cells where the header names %zu columns%s", r->path,
                              r->line, found, r->columns,
                              found > r->columns && r->delimiter == ',' && have_no_points(r)
                                  ? ": are these decimal commas? Put semicolons between cells then"
                                  : "");
}

/* Whether the row is the line of names once more, perhaps without the units behind them. */
static bool are_names(const gonio_i_csv_reader *r)
{
    size_t same = 0;
    while (same < r->cells && same < r->columns &&
           strncasecmp(r->name[same], r->cell[same], strlen(r->cell[same])) == 0 &&
           (*r->cell[same] != '\0' || *r->name[same] == '\0')) {
        same++;
    }
    return same == r->columns && r->cells == r->columns;
}

/* Whether the row is a line of words: too few cells, none of them a number. Digits may be in a
 * single cell, such as "saved 12:05". */
static bool are_words(const gonio_i_csv_reader *r)
{
    bool digits = false;
    for (size_t k = 0; k < r->cells && r->cells < r->columns; k++) {
        digits = digits || strpbrk(r->cell[k], "0123456789") != NULL;
    }
    return r->cells < r->columns && r->cells > 0 &&
           (!digits || (r->cells == 1 && r->columns > 1 && isalpha((unsigned char)*r->cell[0])));
}

static bool is_remark(gonio_i_csv_reader *r)
{
    while (r->cells > 1 && r->cell[r->cells - 1][0] == '\0' && r->cells != r->columns) {
        r->cells--;
    }
    if (!r->remarks_allowed || !(are_names(r) || are_words(r))) {
        return false;
    }
    r->first_remark = r->remarks == 0 ? r->line : r->first_remark;
    r->remarks++;
    return true;
}

/* Splits the next line that is a row; *length is 0 behind the last. */
static gonio_status find_row(gonio_i_csv_reader *r, size_t *length)
{
    const char *line = NULL;
    gonio_status status = GONIO_OK;
    do {
        status = find_line(r, &line, length);
        r->cells = 0;
        if (status == GONIO_OK && *length > 0) {
            status = split(r, line, *length);
        }
    } while (status == GONIO_OK && *length > 0 && is_remark(r));
    return status;
}

gonio_status gonio_i_csv_next(gonio_i_csv_reader *reader)
{
    if (reader->again) {
        reader->again = false;
        return GONIO_OK;
    }
    size_t length = 0;
    const gonio_status status = find_row(reader, &length);
    return status == GONIO_OK && length > 0 ? fit_cells(reader) : status;
}

void gonio_i_csv_again(gonio_i_csv_reader *reader)
{
    reader->again = reader->cells > 0;
}

/* "name (unit)", or the name alone; where it ends. */
static char *print_name(char *to, char *name, const char *unit)
{
    const bool bare = *unit == '\0' || strcmp(unit, "-") == 0;
    const char *open = *unit == '(' || *unit == '[' ? "" : "(";
    return to +
           (bare ? sprintf(to, "%s", name)
                 : sprintf(to, "%s %s%s%s", name, open, unit, *open != '\0' ? ")" : "")) +
           1;
}

gonio_status gonio_i_csv_units_behind_names(gonio_i_csv_reader *reader, char *const *unit)
{
    size_t size = 0;
    for (size_t k = 0; k < reader->columns; k++) {
        size += strlen(reader->name[k]) + strlen(unit[k]) + sizeof " ()";
    }
    char *room = malloc(size + 1);
    if (room == NULL) {
        return out_of_memory(reader);
    }
    char *at = room;
    for (size_t k = 0; k < reader->columns; k++) {
        gonio_i_csv_blank_controls(unit[k], strlen(unit[k]));
        char *next = print_name(at, reader->name[k], unit[k]);
        reader->name[k] = at;
        at = next;
    }
    free(reader->name_room);
    reader->name_room = room;
    return GONIO_OK;
}

void gonio_i_csv_close(gonio_i_csv_reader *reader)
{
    if (reader->parser != NULL) {
        csv_free(reader->parser);
    }
    free(reader->parser);
    free(reader->cell);
    free(reader->room);
    free(reader->name);
    free(reader->name_room);
    gonio_i_comments_free(&reader->comment);
    *reader = (gonio_i_csv_reader){0};
}

/* ---- cells ---- */

/* Numbers of up to 15 digits are quotients of exact doubles: rounded once, as
 * strtod rounds. False for all others. */
static bool take_short_number(const char *cell, char delimiter, double *value)
{
    static const double power[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                   1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
    const bool negative = *cell == '-';
    const char *at = cell + negative;
    int64_t digits = 0;
    int count = 0;
    int places = -1;
    for (; count <= 15; at++) {
        if (*at >= '0' && *at <= '9') {
            digits = 10 * digits + (*at - '0');
            count++;
            places += places >= 0;
        } else if (places < 0 && (*at == '.' || (*at == ',' && delimiter != ','))) {
            places = 0;
        } else {
            break;
        }
    }
    if (count == 0 || count > 15 || *at != '\0') {
        return false;
    }
    const double whole = (double)digits / power[places > 0 ? places : 0];
    *value = negative ? -whole : whole;
    return true;
}

/* Makes hyphens of the minus signs and dashes of typesetters. */
static void plain_minus(char *text)
{
    static const char *const signs[] = {"\xe2\x88\x92", "\xe2\x80\x93"};
    for (size_t k = 0; k < sizeof signs / sizeof *signs; k++) {
        for (char *at = text; (at = strstr(at, signs[k])) != NULL; at++) {
            *at = '-';
            memmove(at + 1, at + 3, strlen(at + 3) + 1);
        }
    }
}

bool gonio_i_csv_is_number(const char *cell, char delimiter, double *value)
{
    char text[64];
    if (take_short_number(cell, delimiter, value)) {
        return true;
    }
    const size_t length = strlen(cell);
    if (length == 0 || length >= sizeof text) {
        return false;
    }
    memcpy(text, cell, length + 1);
    plain_minus(text);
    char *comma = delimiter != ',' ? strchr(text, ',') : NULL;
    if (comma != NULL) {
        *comma = '.';
    }
    char *end = text;
    gonio_i_take_fortran_exponent(text);
    *value = strtod(text, &end);
    return end != text && *end == '\0';
}

void gonio_i_csv_print_cell(FILE *stream, const char *cell, char delimiter)
{
    const bool plain = strchr(cell, delimiter) == NULL && strpbrk(cell, "\"\r\n") == NULL &&
                       cell[0] != ' ' && cell[0] != '#';
    if (plain) {
        fputs(cell, stream);
    } else {
        csv_fwrite(stream, cell, strlen(cell));
    }
}
