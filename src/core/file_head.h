/* The beginning of a file, from which its format is recognised. */
#ifndef GONIO_FILE_HEAD_H
#define GONIO_FILE_HEAD_H

#include "core.h"

enum { GONIO_I_HEAD = 8192 }; /* bytes that a format may inspect */

typedef struct gonio_i_file {
    const char *path;
    char head[GONIO_I_HEAD + 1]; /* followed by a zero */
    size_t head_size;            /* bytes of head that the file has */
    uint64_t size;               /* of the whole file */
} gonio_i_file;

/* Reads the beginning of a regular file. `path` must outlive *file. If the file is a text
 * compressed with gzip, `head` is the decompressed text. Errors: _IO (missing, unreadable, a
 * directory, or a pipe, which cannot be read twice). */
gonio_status gonio_i_file_look(gonio_context *context, const char *path, gonio_i_file *file);

/* Whether a file begins with these bytes. */
bool gonio_i_file_begins(const gonio_i_file *file, const char *bytes, size_t size);

/* The first line of a text that is neither empty nor a # comment, and its length. A byte-order mark
 * and leading blanks are skipped. The length is 0 if there is no such line. NULL for binary data.
 * text[size] is 0. */
const char *gonio_i_first_line(const char *text, size_t size, size_t *length);

#endif
