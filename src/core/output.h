/* Output files that appear whole or not at all: written beside the target under another name, then
 * renamed over it. */
#ifndef GONIO_OUTPUT_H
#define GONIO_OUTPUT_H

#include <sys/types.h>

#include "core.h"

typedef struct gonio_i_output {
    char *path;      /* the target, links resolved */
    char *temporary; /* what is written; NULL when writing to a device or pipe directly */
    int descriptor;
} gonio_i_output;

/* Starts an output. Errors: _IO if the target is a folder, is write-protected or its folder cannot
 * be written. */
gonio_status gonio_i_output_open(gonio_context *context, const char *path, gonio_i_output *output);

gonio_status gonio_i_output_write(gonio_context *context, gonio_i_output *output, const void *data,
                                  size_t size);
gonio_status gonio_i_output_write_at(gonio_context *context, gonio_i_output *output,
                                     const void *data, size_t size, off_t offset);

/* Puts the file in place if `status` is GONIO_OK, removes what was written otherwise; closes in any
 * case. Returns status, or _IO if the last step failed. */
gonio_status gonio_i_output_close(gonio_context *context, gonio_i_output *output,
                                  gonio_status status);

#endif
