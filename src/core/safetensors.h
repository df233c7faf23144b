/* Safetensors files: named arrays in one file, read without copying.
 *
 * Such a file is the length of its header (8 bytes), the header (JSON) and the values of the
 * arrays, without gaps. The header gives the type, the shape and the first and last byte of every
 * array by its name, and under "__metadata__" texts by their keys. Numbers are little-endian, and
 * the last index of an array runs fastest.
 *
 * Files are mapped into memory and take no lock. While a file is open it may be replaced (as
 * output.h does) but must not be changed: values would change under the reader, and the system ends
 * a program that reads beyond the end of a file that became shorter. So values that serve as
 * indices are copied before they are checked. */
#ifndef GONIO_SAFETENSORS_H
#define GONIO_SAFETENSORS_H

#include "core.h"

enum { GONIO_I_MOST_DIMENSIONS = 8 };

typedef enum gonio_i_array_type {
    GONIO_I_F64,
    GONIO_I_U64,
    GONIO_I_F32,
    GONIO_I_I32,
    GONIO_I_U8,
    GONIO_I_OTHER_TYPE /* known to the format, and not used here */
} gonio_i_array_type;

typedef struct gonio_i_array {
    const char *name;
    gonio_i_array_type type;
    int rank;
    size_t shape[GONIO_I_MOST_DIMENSIONS];
    size_t size;      /* of the data in bytes */
    const void *data; /* aligned as its type needs */
} gonio_i_array;

typedef struct gonio_i_metadata {
    const char *key;
    const char *text;
} gonio_i_metadata;

/* Writes arrays[count] (their `size` is ignored) and metadata[texts], both with unique names.
 * Arrays of larger numbers come first, so that all are aligned. Otherwise both keep their order, so
 * that the same contents give the same bytes. In a text that is not UTF-8 every byte beyond ASCII
 * becomes U+FFFD. The file appears whole or not at all. Errors: _IO, _MEMORY. */
gonio_status gonio_i_safetensors_write(gonio_context *context, const gonio_i_metadata *metadata,
                                       size_t texts, const gonio_i_array *arrays, size_t count,
                                       const char *path);

typedef struct gonio_i_safetensors gonio_i_safetensors;

/* Opens a file and checks its header: every array lies in the file, is aligned, and follows the one
 * before it without a gap. Values are not checked. Messages of damage end with `remedy`. Errors:
 * _IO; _FORMAT for another kind of file and for damage; _MEMORY. */
gonio_status gonio_i_safetensors_open(gonio_context *context, const char *path, const char *remedy,
                                      gonio_i_safetensors **file);

/* The same for a file's bytes in memory, which must be aligned to 64 bytes and outlive `file`;
 * `path` is for messages. */
gonio_status gonio_i_safetensors_parse(gonio_context *context, const char *path, const char *remedy,
                                       const void *bytes, size_t size, gonio_i_safetensors **file);

void gonio_i_safetensors_close(gonio_i_safetensors **file);

/* An array or a text of the file, valid until the file is closed; NULL if it is missing. */
const gonio_i_array *gonio_i_safetensors_array(const gonio_i_safetensors *file, const char *name);
const char *gonio_i_safetensors_text(const gonio_i_safetensors *file, const char *key);

/* Whether a file that begins with head[size], 9 bytes or more, can be a safetensors file. */
bool gonio_i_safetensors_begin(const void *head, size_t size);

#endif
