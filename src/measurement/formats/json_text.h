/* What readers of JSON share. */
#ifndef GONIO_JSON_TEXT_H
#define GONIO_JSON_TEXT_H

#include <jansson.h>

#include "format.h"

/* Whether a text begins an object and has a word in what is seen of it. text[size] is 0. */
bool gonio_i_json_has(const char *text, size_t size, const char *word);

/* The root object of a file, or NULL after an error that names the line. */
json_t *gonio_i_json_parse(const gonio_i_readings_file *file);

/* A member of an object; NULL if it is none or has none. */
const json_t *gonio_i_json_member(const json_t *object, const char *name);

/* A number; NaN for anything else. */
double gonio_i_json_double(const json_t *value);

/* A text as a JSON string in quotes, without what is not UTF-8; the caller's. NULL: out of memory.
 */
char *gonio_i_json_quote(const char *text);

#endif
