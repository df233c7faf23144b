/* Writing tensor files: see tensor_file.h for the layout. */
#ifndef GONIO_TENSOR_WRITE_H
#define GONIO_TENSOR_WRITE_H

#include "tensor_file.h"

/* A field to write; `data` are numbers of the type, in the byte order of the machine. */
typedef struct gonio_i_tensor_field {
    const char *name;
    gonio_i_tensor_type type;
    int dimensions;
    uint64_t shape[GONIO_I_TENSOR_DIMENSIONS];
    const void *data;
} gonio_i_tensor_field;

/* Writes a file of these fields. Each begins at a multiple of 8 bytes. The file appears whole or
 * not at all. Errors: _IO, _MEMORY. */
gonio_status gonio_i_tensor_write(gonio_context *context, const char *path,
                                  const gonio_i_tensor_field *fields, size_t count);

#endif
