/* Safetensors files: named arrays in one file, read without copying.
 *
 * Such a file is the length of its header (8 bytes), the header (JSON) and the values of the
 * arrays, without gaps. The header gives the type, the shape and the first and last byte of every
 * array by its name, and under "__metadata__" texts by their keys. Numbers are little-endian, and
 * the last index of an array runs fastest.
 *
 * Files are mapped into memory and take no lock. A file is to be replaced (as output.h does), not
 * changed, while it is open: values then change under the reader, and the system ends a program
 * that reads beyond the end of a file that became shorter. Who uses values as indices copies them
 * before checking them. */
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

/* Writes arrays[count] (their `size` is not looked at) and metadata[texts], both with names that
 * occur once. Arrays of larger numbers come first, so that all are aligned; otherwise both keep
 * their order, so that the same contents are the same bytes. In a text that is not UTF-8 every byte
 * beyond ASCII becomes U+FFFD. The file appears whole or not at all. Errors: _IO, _MEMORY. */
gonio_status gonio_i_safetensors_write(gonio_context *context, const gonio_i_metadata *metadata,
                                       size_t texts, const gonio_i_array *arrays, size_t count,
                                       const char *path);

typedef struct gonio_i_safetensors gonio_i_safetensors;

/* Opens a file of which every array is known to lie within it, aligned, and nothing to lie between
 * two arrays; values are not looked at. Messages of damage end with `remedy`. Errors: _IO; _FORMAT
 * for another kind of file and for damage; _MEMORY. */
gonio_status gonio_i_safetensors_open(gonio_context *context, const char *path, const char *remedy,
                                      gonio_i_safetensors **file);

/* The same for a file's bytes in memory, which must be aligned to 64 bytes and outlive `file`;
 * `path` is for messages. */
gonio_status gonio_i_safetensors_parse(gonio_context *context, const char *path, const char *remedy,
                                       const void *bytes, size_t size, gonio_i_safetensors **file);

void gonio_i_safetensors_close(gonio_i_safetensors **file);

/* What a file holds, valid until it is closed; NULL if it is not there. */
const gonio_i_array *gonio_i_safetensors_array(const gonio_i_safetensors *file, const char *name);
const char *gonio_i_safetensors_text(const gonio_i_safetensors *file, const char *key);

/* Whether a file that begins with head[size], 9 bytes or more, can be one. */
bool gonio_i_safetensors_begin(const void *head, size_t size);

#endif
