/* A text that is printed to memory and then written whole, with decimal points in any locale. */
#ifndef GONIO_TEXT_OUTPUT_H
#define GONIO_TEXT_OUTPUT_H

#include <stdio.h>

#include "../core/number.h"
#include "../core/output.h"

typedef struct gonio_i_text_output {
    FILE *stream; /* print here */
    char *text;
    size_t size;
    gonio_i_plain_numbers plain;
} gonio_i_text_output;

/* Errors: _MEMORY. To be closed after success. */
gonio_status gonio_i_text_open(gonio_context *context, gonio_i_text_output *output);

/* Writes the text to a file if `status` is GONIO_OK; the file appears whole or not at all. Returns
 * status, or _IO or _MEMORY if the last step failed. */
gonio_status gonio_i_text_close(gonio_context *context, gonio_i_text_output *output,
                                const char *path, gonio_status status);

#endif
