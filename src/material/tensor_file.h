/* Tensor files: named arrays of numbers in one file, as Mitsuba's `measured` materials have them.
 *
 * Little-endian. "tensor_file\0", u8 major (1), u8 minor (0), u32 number of fields. A field: u16
 * length of its name, the name, u16 number of dimensions, u8 type, u64 offset from the file's
 * start, u64 shape[dimensions]. The numbers are contiguous, the last index fastest. */
#ifndef GONIO_TENSOR_FILE_H
#define GONIO_TENSOR_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gonio/context.h>

enum {
    GONIO_I_TENSOR_MAGIC = 12, /* bytes, the closing zero included */
    GONIO_I_TENSOR_NAME = 64,
    GONIO_I_TENSOR_DIMENSIONS = 8
};

typedef enum gonio_i_tensor_type {
    GONIO_I_TENSOR_U8 = 1,
    GONIO_I_TENSOR_I8,
    GONIO_I_TENSOR_U16,
    GONIO_I_TENSOR_I16,
    GONIO_I_TENSOR_U32,
    GONIO_I_TENSOR_I32,
    GONIO_I_TENSOR_U64,
    GONIO_I_TENSOR_I64,
    GONIO_I_TENSOR_F16,
    GONIO_I_TENSOR_F32,
    GONIO_I_TENSOR_F64
} gonio_i_tensor_type;

typedef struct gonio_i_tensor {
    char name[GONIO_I_TENSOR_NAME];
    gonio_i_tensor_type type;
    uint64_t offset; /* bytes from the file's start; not checked before it is read */
    int dimensions;
    uint64_t shape[GONIO_I_TENSOR_DIMENSIONS];
    uint64_t count; /* of its numbers: the product of the shape */
} gonio_i_tensor;

typedef struct gonio_i_tensor_file {
    char *path;
    int descriptor;
    uint64_t size; /* of the file, bytes */
    size_t fields;
    gonio_i_tensor *field;
} gonio_i_tensor_file;

/* The bytes of one number of a type. */
size_t gonio_i_tensor_size(gonio_i_tensor_type type);

/* Converts between the byte order of files and that of the machine, in both directions. */
void gonio_i_tensor_byte_order(void *values, size_t count, size_t size);

/* Whether a file's first bytes are those of a tensor file. */
bool gonio_i_tensor_recognises(const unsigned char *head, size_t size);

/* Opens a file and reads the table of its fields. To be closed after success.
 * Errors: _IO; _FORMAT (another version, a field that ends beyond the file, too many fields,
 * names or dimensions, an unknown type, a size that overflows); _MEMORY. */
gonio_status gonio_i_tensor_open(gonio_context *context, const char *path,
                                 gonio_i_tensor_file *file);
void gonio_i_tensor_close(gonio_i_tensor_file *file);

/* The field with a name; NULL if there is none. */
const gonio_i_tensor *gonio_i_tensor_find(const gonio_i_tensor_file *file, const char *name);

/* The field with a name, which must have a type and a number of dimensions and lie in the file.
 * Errors: _FORMAT; the message names the field and what it should be. */
gonio_status gonio_i_tensor_expect(gonio_context *context, const gonio_i_tensor_file *file,
                                   const char *name, gonio_i_tensor_type type, int dimensions,
                                   const gonio_i_tensor **field);

/* Reads the numbers first .. first + count - 1 of a field as its type, in the byte order of the
 * machine. Thread-safe. Errors: _IO, _FORMAT (beyond the end of field or file). */
gonio_status gonio_i_tensor_read(gonio_context *context, const gonio_i_tensor_file *file,
                                 const gonio_i_tensor *field, uint64_t first, size_t count,
                                 void *values);

/* Reads all numbers of a field of f32 into a new block, which the caller frees. Errors: as _read,
 * _MEMORY, _FORMAT (a number that is not finite). */
gonio_status gonio_i_tensor_floats(gonio_context *context, const gonio_i_tensor_file *file,
                                   const gonio_i_tensor *field, float **values);

#endif
