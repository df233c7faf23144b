/* Output files that appear whole or not at all. A file is written in the target's folder without a
 * name, or under another one where that is not possible, then renamed over the target, whose mode
 * it keeps. Output to a pipe or to standard output ("/dev/stdout", "-") is
 * written to a temporary file first, because writers seek, and copied when it is whole. */
#ifndef GONIO_OUTPUT_H
#define GONIO_OUTPUT_H

#include <sys/types.h>

#include "core.h"

typedef struct gonio_i_output {
    char *path;      /* the target, links resolved */
    char *temporary; /* the file that is written, beside the target; NULL if it has no name */
    int descriptor;  /* of the file that is written */
    int final;       /* where the nameless temporary file is copied to; -1 without one */
    bool nameless;   /* the file that is written gets a name beside the target at the end */
    bool flushed;    /* all of it has reached the disk */
} gonio_i_output;

/* Starts an output. Errors: _IO if the target is a folder, is write-protected or its folder cannot
 * be written; `output` is then as after gonio_i_output_close. */
gonio_status gonio_i_output_open(gonio_context *context, const char *path, gonio_i_output *output);

gonio_status gonio_i_output_write(gonio_context *context, gonio_i_output *output, const void *data,
                                  size_t size);
gonio_status gonio_i_output_write_at(gonio_context *context, gonio_i_output *output,
                                     const void *data, size_t size, off_t offset);

/* Allocates the disk space of a file of known size. A full disk is reported at once, and the file
 * is contiguous whatever the order of writing. Errors: _IO. */
gonio_status gonio_i_output_reserve(gonio_context *context, gonio_i_output *output, off_t size);

/* Starts writing a part to the disk without waiting, so that the final flush takes less time. */
void gonio_i_output_start_flush(const gonio_i_output *output, off_t offset, off_t size);

/* Waits until all is on the disk. gonio_i_output_close then does not wait. Nothing may be written
 * afterwards. Errors: _IO. */
gonio_status gonio_i_output_flush(gonio_context *context, gonio_i_output *output);

/* Closes the file. If `status` is GONIO_OK, puts it in place; otherwise removes it. Returns status,
 * or _IO if the last step failed. While outputs are held (gonio_outputs_hold), a finished one waits
 * for the others. */
gonio_status gonio_i_output_close(gonio_context *context, gonio_i_output *output,
                                  gonio_status status);

#endif
