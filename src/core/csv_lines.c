/* The lines of a table as text: see csv_lines.h. */
#include "csv_lines.h"

#include <stdlib.h>
#include <string.h>

void gonio_i_csv_lines_begin(gonio_i_csv_lines *lines, const char *text, size_t size,
                             gonio_i_comments *comment)
{
    static const char mark[] = "\xef\xbb\xbf";
    const bool marked = size >= 3 && memcmp(text, mark, 3) == 0;
    *lines = (gonio_i_csv_lines){
        .text = text, .size = size, .at = marked ? 3 : 0, .next_number = 1, .comment = comment};
}

static bool is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static bool is_separator(char c)
{
    return c == ',' || c == ';' || c == '\t';
}

/* Blanks, separators and quotes that hold nothing. */
static bool holds_nothing(const char *line, size_t length)
{
    size_t k = 0;
    while (k < length && (is_blank(line[k]) || is_separator(line[k]) || line[k] == '"')) {
        k++;
    }
    return k == length;
}

/* ---- comments ---- */

static size_t without_padding(const char *text, size_t length)
{
    while (length > 0 && (is_blank(text[length - 1]) || is_separator(text[length - 1]))) {
        length--;
    }
    return length;
}

/* Where the quotes that begin a text close; its length if they do not. */
static size_t closing_quote(const char *text, size_t length)
{
    size_t k = 1;
    while (k < length && (text[k] != '"' || (k + 1 < length && text[k + 1] == '"'))) {
        k += text[k] == '"' ? 2 : 1;
    }
    return k < length ? k : length;
}

/* "# ..." in quotes with nothing behind: a cell may begin with # too. */
static bool is_comment(const char *line, size_t length)
{
    if (*line != '"' || length < 2 || line[1] != '#') {
        return *line == '#';
    }
    const size_t end = closing_quote(line, length);
    return end < length && holds_nothing(line + end + 1, length - end - 1);
}

/* The text within the quotes that begin it, in its place; returns its length. */
static size_t unquote(char *text, size_t length)
{
    const size_t end = closing_quote(text, length);
    size_t used = 0;
    for (size_t k = 1; k < end; k++) {
        text[used++] = text[k];
        k += text[k] == '"';
    }
    return used;
}

void gonio_i_csv_blank_controls(char *text, size_t length)
{
    for (size_t k = 0; k < length; k++) {
        const unsigned char c = (unsigned char)text[k];
        text[k] = c < ' ' || c == 0x7f ? ' ' : text[k];
    }
}

static bool take_comment(const gonio_i_csv_lines *lines, const char *line, size_t length)
{
    if (lines->comment == NULL) {
        return true;
    }
    char *copy = malloc(length + 1);
    if (copy == NULL) {
        return false;
    }
    memcpy(copy, line, length);
    length = *line == '"' ? unquote(copy, length) : length;
    length = without_padding(copy, length);
    size_t skip = 1;
    while (skip < length && copy[skip] == ' ') {
        skip++;
    }
    const bool kept =
        gonio_i_comments_add_text(lines->comment, copy + skip, length > skip ? length - skip : 0);
    free(copy);
    return kept;
}

/* ---- lines ---- */

static bool is_within_quotes(const char *line, size_t length)
{
    bool within = false;
    const char *end = line + length;
    for (const char *at = memchr(line, '"', length); at != NULL;
         at = memchr(at, '"', (size_t)(end - at))) {
        within = !within;
        at++;
    }
    return within;
}

/* The length of the line at a place, with its end. */
static size_t line_length(const char *line, size_t left)
{
    const char *end = memchr(line, '\n', left);
    return end != NULL ? (size_t)(end - line) + 1 : left;
}

/* Takes one line, with those that quotes in it go on to. */
static size_t take_line(gonio_i_csv_lines *lines)
{
    const char *line = lines->text + lines->at;
    const size_t left = lines->size - lines->at;
    size_t length = line_length(line, left);
    bool within = is_within_quotes(line, length);
    lines->number = lines->next_number++;
    while (within && length < left && *line != '#') {
        const size_t more = line_length(line + length, left - length);
        within = !is_within_quotes(line + length, more);
        length += more;
        lines->next_number++;
    }
    lines->at += length;
    return length;
}

bool gonio_i_csv_lines_next(gonio_i_csv_lines *lines, const char **line, size_t *length)
{
    while (lines->at < lines->size) {
        *line = lines->text + lines->at;
        *length = take_line(lines);
        if (is_comment(*line, *length)) {
            if (!take_comment(lines, *line, *length)) {
                return false;
            }
        } else if (!holds_nothing(*line, *length)) {
            return true;
        }
    }
    *length = 0;
    return true;
}

char gonio_i_csv_stated_separator(const char *line, size_t length)
{
    const size_t quote = length > 0 && *line == '"';
    const bool stated = length > quote + 4 && strncasecmp(line + quote, "sep=", 4) == 0;
    if (!stated) {
        return '\0';
    }
    const char separator = line[quote + 4];
    return separator != '\n' && separator != '\r' && separator != '"' &&
                   holds_nothing(line + quote + 5, length - quote - 5)
               ? separator
               : '\0';
}
