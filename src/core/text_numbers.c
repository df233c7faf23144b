/* The words and numbers of a text: see text_numbers.h. */
#include "text_numbers.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

gonio_i_numbers gonio_i_numbers_of(gonio_context *context, const char *path, const char *text,
                                   size_t size, char comment)
{
    return (gonio_i_numbers){.context = context,
                             .path = path,
                             .at = text,
                             .end = text + size,
                             .line = 1,
                             .comment = comment};
}

void gonio_i_numbers_go_to(gonio_i_numbers *n, const char *place)
{
    for (; n->at < place; n->at++) {
        n->line += *n->at == '\n';
    }
}

static bool at_blank(const gonio_i_numbers *n)
{
    return isspace((unsigned char)*n->at) || (n->commas && *n->at == ',');
}

static bool at_comment(const gonio_i_numbers *n)
{
    return n->comment != '\0' && *n->at == n->comment;
}

static const char *line_end(const gonio_i_numbers *n)
{
    const char *end = memchr(n->at, '\n', (size_t)(n->end - n->at));
    return end != NULL ? end : n->end;
}

bool gonio_i_numbers_skip(gonio_i_numbers *n)
{
    while (n->at < n->end && (at_blank(n) || at_comment(n))) {
        n->at = at_comment(n) ? line_end(n) : n->at;
        n->line += n->at < n->end && *n->at == '\n';
        n->at += n->at < n->end;
    }
    return n->at < n->end;
}

bool gonio_i_numbers_skip_blanks(gonio_i_numbers *n)
{
    while (n->at < n->end && *n->at != '\n' && (at_blank(n) || at_comment(n))) {
        n->at = at_comment(n) ? line_end(n) : n->at + 1;
    }
    return n->at < n->end && *n->at != '\n';
}

void gonio_i_numbers_next_line(gonio_i_numbers *n)
{
    n->at = line_end(n);
    n->line += n->at < n->end;
    n->at += n->at < n->end;
}

void gonio_i_numbers_word(gonio_i_numbers *n, char word[GONIO_I_WORD])
{
    size_t length = 0;
    for (; n->at < n->end && !at_blank(n) && !at_comment(n); n->at++) {
        if (length < GONIO_I_WORD - 1) {
            word[length++] = *n->at;
        }
    }
    word[length] = '\0';
}

void gonio_i_take_fortran_exponent(char *number)
{
    char *mark = number + strspn(number, "+-0123456789.,");
    const bool marked =
        mark > number && strchr("+-", mark[-1]) == NULL && (*mark == 'D' || *mark == 'd');
    const char *exponent = marked ? mark + 1 + (mark[1] == '+' || mark[1] == '-') : "";
    if (*exponent != '\0' && exponent[strspn(exponent, "0123456789")] == '\0') {
        *mark = 'E';
    }
}

static bool number_of(const char *word, double *value)
{
    char text[GONIO_I_WORD];
    char *end = NULL;
    snprintf(text, sizeof text, "%s", word);
    gonio_i_take_fortran_exponent(text);
    *value = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*value);
}

gonio_status gonio_i_numbers_read(gonio_i_numbers *n, double *value)
{
    char word[GONIO_I_WORD];
    if (!gonio_i_numbers_skip(n)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s: ends within a reading (line %zu); is the file whole?", n->path,
                            n->line);
    }
    gonio_i_numbers_word(n, word);
    if (!number_of(word, value)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT, "%s:%zu: '%.40s' is not a number",
                            n->path, n->line, word);
    }
    return GONIO_OK;
}

int gonio_i_numbers_row(gonio_i_numbers *n, double *value, int most)
{
    int count = 0;
    bool good = true;
    while (good && gonio_i_numbers_skip_blanks(n)) {
        char word[GONIO_I_WORD];
        gonio_i_numbers_word(n, word);
        good = count < most && number_of(word, &value[count]);
        count += good;
    }
    if (good) {
        gonio_i_numbers_next_line(n);
    }
    return good ? count : -1;
}
