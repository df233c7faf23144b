/* Results as JSON: see json_output.h. */
#include "json_output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static json_t **kept_json = NULL;

/* jansson drops what it has no memory for, or ends in an assertion. So the program ends here, with
 * a message. Outputs that are not finished have no name yet, and vanish. */
static void *allocate(size_t size)
{
    void *made = malloc(size);
    if (made == NULL) {
        fputs("gonio: out of memory\n", stderr);
        _exit(EXIT_DATA);
    }
    return made;
}

void tool_watch_json_memory(void)
{
    json_set_alloc_funcs(allocate, free);
}

void tool_keep_json(json_t **kept)
{
    kept_json = kept;
}

json_t *tool_json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

/* The bytes of the UTF-8 character that a text begins with; 0 if it does not begin with one. */
static size_t character_length(const unsigned char *text)
{
    const size_t length = text[0] < 0x80                      ? 1
                          : text[0] >= 0xc2 && text[0] < 0xe0 ? 2
                          : text[0] >= 0xe0 && text[0] < 0xf0 ? 3
                          : text[0] >= 0xf0 && text[0] < 0xf5 ? 4
                                                              : 0;
    for (size_t k = 1; k < length; k++) {
        if ((text[k] & 0xc0) != 0x80) {
            return 0;
        }
    }
    json_t *valid = length > 0 ? json_stringn((const char *)text, length) : NULL;
    json_decref(valid);
    return valid != NULL ? length : 0;
}

json_t *tool_json_text(const char *text)
{
    static const char replacement[] = "\xef\xbf\xbd";
    if (text == NULL) {
        return json_null();
    }
    char *valid = allocate((strlen(text) + 1) * (sizeof replacement - 1));
    char *end = valid;
    for (const char *at = text; *at != '\0';) {
        const size_t length = character_length((const unsigned char *)at);
        end = mempcpy(end, length > 0 ? at : replacement, length > 0 ? length : 3);
        at += length > 0 ? length : 1;
    }
    *end = '\0';
    json_t *json = json_string(valid);
    free(valid);
    return json;
}

json_t *tool_error_json(const gonio_error *error)
{
    json_t *json = json_object();
    const gonio_metric_view *metric = NULL;
    for (int m = 0; (metric = gonio_metric_describe(m)) != NULL; m++) {
        json_object_set_new(json, metric->key, tool_json_number(error->value[m]));
    }
    return json;
}

int tool_print_json(const tool *t, json_t *json)
{
    if (json == NULL) {
        fprintf(stderr, "gonio %s: no JSON: a name is not UTF-8, or out of memory\n", t->name);
        return EXIT_DATA;
    }
    if (kept_json != NULL) {
        *kept_json = json;
        return 0;
    }
    json_dumpf(json, tool_results(), JSON_INDENT(2) | JSON_REAL_PRECISION(10));
    fputc('\n', tool_results());
    json_decref(json);
    return 0;
}
