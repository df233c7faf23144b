/* What readers of JSON share. */
#ifndef GONIO_JSON_TEXT_H
#define GONIO_JSON_TEXT_H

#include <jansson.h>

#include "format.h"

/* Whether a text begins with an object and contains a word. text[size] is 0. */
bool gonio_i_json_has(const char *text, size_t size, const char *word);

/* The root object of a file, or NULL after an error that names the line. */
json_t *gonio_i_json_parse(const gonio_i_readings_file *file);

/* A member of an object; NULL if `object` is none or lacks it. */
const json_t *gonio_i_json_member(const json_t *object, const char *name);

/* A number; NaN for anything else. */
double gonio_i_json_double(const json_t *value);

/* A text as a JSON string in quotes, which the caller frees. Bytes that are not UTF-8 are dropped.
 * NULL: out of memory. */
char *gonio_i_json_quote(const char *text);

#endif
