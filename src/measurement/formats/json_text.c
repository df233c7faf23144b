/* What readers of JSON share: see json_text.h. */
#include "json_text.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *begin_of(const char *text, size_t size)
{
    size_t at = size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    while (at < size && isspace((unsigned char)text[at])) {
        at++;
    }
    return text + at;
}

bool gonio_i_json_has(const char *text, size_t size, const char *word)
{
    return *begin_of(text, size) == '{' && memmem(text, size, word, strlen(word)) != NULL;
}

json_t *gonio_i_json_parse(const gonio_i_readings_file *file)
{
    json_error_t error;
    const char *begin = begin_of(file->text, file->size);
    const size_t size = file->size - (size_t)(begin - file->text);
    json_t *root = json_loadb(begin, size, 0, &error);
    if (root == NULL) {
        gonio_i_fail(file->context, GONIO_ERROR_FORMAT, "%s:%d: JSON: %s", file->path, error.line,
                     error.text);
    }
    return root;
}

const json_t *gonio_i_json_member(const json_t *object, const char *name)
{
    return json_is_object(object) ? json_object_get(object, name) : NULL;
}

double gonio_i_json_double(const json_t *value)
{
    return json_is_number(value) ? json_number_value(value) : NAN;
}

char *gonio_i_json_quote(const char *text)
{
    json_t *made = json_string(text);
    if (made == NULL) { /* not UTF-8: its ASCII */
        char *plain = strdup(text);
        for (char *c = plain; c != NULL && *c != '\0'; c++) {
            *c = (unsigned char)*c < 0x80 ? *c : '?';
        }
        made = plain != NULL ? json_string(plain) : NULL;
        free(plain);
    }
    char *quoted = json_dumps(made, JSON_ENCODE_ANY);
    json_decref(made);
    return quoted;
}
