/* What readings seem to be (gonio_interpretation), in words and as JSON. */
#ifndef GONIO_APP_INTERPRETATION_H
#define GONIO_APP_INTERPRETATION_H

#include <gonio/reconstruct.h>
#include <jansson.h>

/* Says on standard error what readings seem to be, where that is not what they say. command: the
 * one that is run. path: what is concerned. */
void tool_note_interpretation(const char *command, const char *path,
                              const gonio_interpretation *interpretation);

/* Adds "suspicion", the likeliest alternative or null, and all others to a JSON object. */
void tool_add_interpretation(json_t *json, const gonio_interpretation *interpretation);

#endif
