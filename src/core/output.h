/* Output files that appear whole or not at all: written beside the target under another name, then
 * renamed over it. What goes to a pipe or to standard output ("/dev/stdout", "-") is kept in a
 * temporary file until it is whole, because writers seek. */
#ifndef GONIO_OUTPUT_H
#define GONIO_OUTPUT_H

#include <sys/types.h>

#include "core.h"

typedef struct gonio_i_output {
    char *path;      /* the target, links resolved */
    char *temporary; /* what is written; NULL when it is not a file beside the target */
    int descriptor;  /* of what is written */
    int final;       /* what the temporary file without a name is copied to; -1 without one */
    bool flushed;    /* all of it has reached the disk */
} gonio_i_output;

/* Starts an output. Errors: _IO if the target is a folder, is write-protected or its folder cannot
 * be written; `output` is then as after gonio_i_output_close. */
gonio_status gonio_i_output_open(gonio_context *context, const char *path, gonio_i_output *output);

gonio_status gonio_i_output_write(gonio_context *context, gonio_i_output *output, const void *data,
                                  size_t size);
gonio_status gonio_i_output_write_at(gonio_context *context, gonio_i_output *output,
                                     const void *data, size_t size, off_t offset);

/* Sets room aside for a file of known size: a full disk shows at once, and writing in any order
 * leaves the file in one piece. Errors: _IO. */
gonio_status gonio_i_output_reserve(gonio_context *context, gonio_i_output *output, off_t size);

/* Begins to move a written part to the disk and does not wait for it, so that the flush at the end
 * has less to wait for. */
void gonio_i_output_start_flush(const gonio_i_output *output, off_t offset, off_t size);

/* Waits until all is on the disk, which gonio_i_output_close then need not: nothing may be written
 * any more. Errors: _IO. */
gonio_status gonio_i_output_flush(gonio_context *context, gonio_i_output *output);

/* Puts the file in place if `status` is GONIO_OK, removes what was written otherwise; closes in any
 * case. Returns status, or _IO if the last step failed. */
gonio_status gonio_i_output_close(gonio_context *context, gonio_i_output *output,
                                  gonio_status status);

#endif
