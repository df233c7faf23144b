/* Decompression of texts compressed with gzip. */
#ifndef GONIO_GZIP_H
#define GONIO_GZIP_H

#include "core.h"

/* Whether bytes are the beginning of a gzip file. */
bool gonio_i_gzip_begins(const void *bytes, size_t size);

/* Decompresses the beginning of a gzip file, at most `room` bytes. Returns their number. */
size_t gonio_i_gzip_head(const void *bytes, size_t size, char *text, size_t room);

/* Decompresses a whole gzip file, with all of its members, into a new block, followed by a zero.
 * The caller frees it. Errors: _FORMAT (damaged, truncated, followed by uncompressed data, more
 * than `most` bytes), _MEMORY. */
gonio_status gonio_i_gzip_text(gonio_context *context, const char *path, const void *bytes,
                               size_t size, size_t most, char **text, size_t *length);

#endif
