/* Results as JSON, for --json. */
#ifndef GONIO_JSON_OUTPUT_H
#define GONIO_JSON_OUTPUT_H

#include <jansson.h>

#include "command_line.h"

/* A JSON number; null if it is infinite or NaN, which JSON lacks. */
json_t *tool_json_number(double value);

/* Prints JSON to standard output and releases it; NULL, from a json_pack that failed, is an error.
 */
int tool_print_json(const tool *t, json_t *json);

#endif
