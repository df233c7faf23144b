/* A text file, read whole. */
#ifndef GONIO_TEXT_FILE_H
#define GONIO_TEXT_FILE_H

#include "core.h"

/* Reads a file into a new block of size + 1 bytes, the last of them 0; the caller frees it. The
 * file may be a pipe, and compressed with gzip. Errors: _IO; _FORMAT for more than 1 GiB or damaged
 * gzip; _MEMORY. */
gonio_status gonio_i_text_read(gonio_context *context, const char *path, char **text, size_t *size);

#endif
