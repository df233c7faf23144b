/* An instrument in words and as JSON, for `gonio check`. */
#ifndef GONIO_INSTRUMENT_WORDS_H
#define GONIO_INSTRUMENT_WORDS_H

#include <jansson.h>

#include "command_line.h"

/* Prints an instrument and what it reaches. */
void instrument_print(FILE *stream, const gonio_instrument_view *view, const gonio_reach *reach);

/* The same as JSON; the caller's. */
json_t *instrument_json(const gonio_instrument_view *view, const gonio_reach *reach);

#endif
