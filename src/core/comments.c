/* Comment lines: see comments.h. */
#include "comments.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "number.h"

/* Adds a line. Takes ownership of the text, and frees it when out of memory. */
static bool append(gonio_i_comments *comments, char *text)
{
    char **more = text != NULL
                      ? reallocarray(comments->line, comments->count + 1, sizeof *comments->line)
                      : NULL;
    if (more == NULL) {
        free(text);
        return false;
    }
    more[comments->count++] = text;
    comments->line = more;
    return true;
}

bool gonio_i_comments_add(gonio_i_comments *comments, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *text = gonio_i_format_list(format, arguments);
    va_end(arguments);
    return append(comments, text);
}

bool gonio_i_comments_add_text(gonio_i_comments *comments, const char *text, size_t length)
{
    return append(comments, strndup(text, length));
}

bool gonio_i_comments_copy(gonio_i_comments *to, const gonio_i_comments *from)
{
    bool done = true;
    for (size_t k = 0; k < from->count && done; k++) {
        done = append(to, strdup(from->line[k]));
    }
    return done;
}

void gonio_i_comments_free(gonio_i_comments *comments)
{
    for (size_t k = 0; k < comments->count; k++) {
        free(comments->line[k]);
    }
    free(comments->line);
    *comments = (gonio_i_comments){0};
}

static const char *value_of(const char *comment, const char *key)
{
    const size_t length = strlen(key);
    if (strncmp(comment, key, length) != 0 || comment[length] != ':') {
        return NULL;
    }
    const char *text = comment + length + 1;
    return text + strspn(text, " ");
}

const char *gonio_i_comments_value(const gonio_i_comments *comments, const char *key)
{
    for (size_t k = 0; k < comments->count; k++) {
        const char *text = value_of(comments->line[k], key);
        if (text != NULL) {
            return text;
        }
    }
    return NULL;
}

void gonio_i_comments_drop(gonio_i_comments *comments, const char *key)
{
    size_t kept = 0;
    for (size_t k = 0; k < comments->count; k++) {
        if (value_of(comments->line[k], key) != NULL) {
            free(comments->line[k]);
        } else {
            comments->line[kept++] = comments->line[k];
        }
    }
    comments->count = kept;
}
