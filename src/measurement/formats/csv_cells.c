/* Lines and cells of a text whose layout is not known: see csv_cells.h. */
#include "csv_cells.h"

#include <stdlib.h>
#include <string.h>

#include "../../core/memory_stream.h"

static const char *const marks[] = {"#", "%", "//", "!", ";", "*", "--"};

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

bool gonio_i_next_line(const char **at, const char *end, gonio_i_line *l)
{
    if (*at >= end) {
        return false;
    }
    const char *stop = memchr(*at, '\n', (size_t)(end - *at));
    *l = (gonio_i_line){*at, (size_t)((stop != NULL ? stop : end) - *at)};
    *at = stop != NULL ? stop + 1 : end;
    return true;
}

gonio_i_line gonio_i_trimmed(gonio_i_line l)
{
    while (l.length > 0 && is_blank(*l.at)) {
        l.at++;
        l.length--;
    }
    while (l.length > 0 && is_blank(l.at[l.length - 1])) {
        l.length--;
    }
    return l;
}

gonio_i_line gonio_i_without_mark(gonio_i_line l, const char **mark)
{
    l = gonio_i_trimmed(l);
    *mark = NULL;
    for (size_t k = 0; k < sizeof marks / sizeof *marks && *mark == NULL; k++) {
        const size_t length = strlen(marks[k]);
        *mark = l.length >= length && memcmp(l.at, marks[k], length) == 0 ? marks[k] : NULL;
    }
    while (*mark != NULL && l.length > 0 && *l.at == **mark) {
        l.at++;
        l.length--;
    }
    return gonio_i_trimmed(l);
}

bool gonio_i_next_cell(gonio_i_line *rest, char separator, gonio_i_line *cell)
{
    size_t k = 0;
    if (rest->at == NULL) {
        return false;
    }
    while (k < rest->length &&
           (separator == ' ' ? !is_blank(rest->at[k]) : rest->at[k] != separator)) {
        k++;
    }
    *cell = gonio_i_trimmed((gonio_i_line){rest->at, k});
    while (separator == ' ' && k + 1 < rest->length && is_blank(rest->at[k + 1])) {
        k++;
    }
    *rest = k < rest->length ? (gonio_i_line){rest->at + k + 1, rest->length - k - 1}
                             : (gonio_i_line){NULL, 0};
    return true;
}

size_t gonio_i_count_cells(gonio_i_line l, char separator)
{
    gonio_i_line cell;
    size_t count = 0;
    while (gonio_i_next_cell(&l, separator, &cell)) {
        count++;
    }
    return count;
}

gonio_status
gonio_i_print_again(gonio_context *context, const char *path, char **text, size_t *size,
                    void (*print)(FILE *stream, const char *text, size_t size, const void *found),
                    const void *found)
{
    char *again = NULL;
    size_t length = 0;
    FILE *stream = gonio_i_memory_stream(&again, &length);
    if (stream != NULL) {
        print(stream, *text, *size, found);
    }
    if (stream == NULL || fclose(stream) != 0) {
        free(again);
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    }
    free(*text);
    *text = again;
    *size = length;
    return GONIO_OK;
}
