/* The beginning of a file, by which its format is told. */
#ifndef GONIO_FILE_HEAD_H
#define GONIO_FILE_HEAD_H

#include "core.h"

enum { GONIO_I_HEAD = 8192 }; /* bytes that a format may look at */

typedef struct gonio_i_file {
    const char *path;
    char head[GONIO_I_HEAD + 1]; /* followed by a zero */
    size_t head_size;            /* bytes of head that the file has */
    uint64_t size;               /* of the whole file */
} gonio_i_file;

/* Looks at a regular file; `path` is kept. Of a text compressed with gzip, `head` is the text.
 * Errors: _IO (missing, unreadable, a directory, or a pipe, which could not be read again). */
gonio_status gonio_i_file_look(gonio_context *context, const char *path, gonio_i_file *file);

/* Whether a file begins with these bytes. */
bool gonio_i_file_begins(const gonio_i_file *file, const char *bytes, size_t size);

/* The first line of a text that is neither empty nor a # comment, without blanks and byte-order
 * mark before it, and its length, 0 if there is no such line. NULL for binary data. text[size] is
 * 0. */
const char *gonio_i_first_line(const char *text, size_t size, size_t *length);

#endif
