/* Results as JSON, for --json. */
#ifndef GONIO_JSON_OUTPUT_H
#define GONIO_JSON_OUTPUT_H

#include <jansson.h>

#include "command_line.h"

/* A JSON number; null if it is infinite or NaN, which JSON lacks. */
json_t *tool_json_number(double value);

/* A JSON string. Bytes that are not UTF-8 become U+FFFD. NULL: null. */
json_t *tool_json_text(const char *text);

/* An error by every metric: {"e6_percent": ..., ...} (gonio_metric_view.key). */
json_t *tool_error_json(const gonio_error *error);

/* Prints JSON (tool_results) and releases it. NULL, from a json_pack that failed, is an error.
 * Returns an exit code. */
int tool_print_json(const tool *t, json_t *json);

/* For commands that run others. Until the next call, tool_print_json stores its JSON in *kept (NULL
 * at first) instead of printing it. The caller releases it. NULL: print again. */
void tool_keep_json(json_t **kept);

/* From now on the program ends, with a message, where memory for JSON is missing. */
void tool_watch_json_memory(void);

#endif
