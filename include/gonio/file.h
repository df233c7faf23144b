/* Files: what a file is, judged by its content, never by its name. */
#ifndef GONIO_FILE_H
#define GONIO_FILE_H

#include <gonio/context.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Kinds of files, which can be or'ed. */
typedef enum gonio_kind {
    GONIO_KIND_UNKNOWN = 0,
    GONIO_KIND_MATERIAL = 1,
    GONIO_KIND_BASIS = 2,
    GONIO_KIND_READINGS = 4, /* and plans, which are readings without values */
    GONIO_KIND_MESH = 8,
    GONIO_KIND_IMAGE = 16
} gonio_kind;

/* What a file is, from its first 8192 bytes. `format`, unless it is NULL, becomes the format's name
 * in words ("MERL .binary table", "CSV"), or NULL for an unknown file; it is static. "atlas:NAME"
 * is a material even if there is none of that name.
 *
 * A pipe is not inspected, because bytes that are read from it are gone. It counts as readings
 * without a format, because only readings are read from beginning to end.
 *
 * An unknown file is no error. Errors: _IO (missing, unreadable, a directory). Thread-safe. */
GONIO_API gonio_status gonio_file_kind(gonio_context *context, const char *path, gonio_kind *kind,
                                       const char **format);

/* The same for a file that must be of one of the kinds in `wanted`. Errors: _IO as above; _FORMAT,
 * with a message that says what the file is or, for an unknown or empty file, which formats are
 * read. A damaged file of a wanted kind is no error here, but when it is read. */
GONIO_API gonio_status gonio_file_expect(gonio_context *context, const char *path, unsigned wanted,
                                         gonio_kind *kind);

/* One kind in a word: "material", "basis", "readings", "mesh", "image"; NULL for anything else. */
GONIO_API const char *gonio_kind_name(gonio_kind kind);

/* The formats of a kind that gonio reads, in words; NULL past the last. */
GONIO_API const char *gonio_kind_format(gonio_kind kind, int index);

#ifdef __cplusplus
}
#endif
#endif
