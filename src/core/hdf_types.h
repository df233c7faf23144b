/* What HDF5 stores: the types of elements and the shapes of arrays, for its readers alone. */
#ifndef GONIO_HDF_TYPES_H
#define GONIO_HDF_TYPES_H

#include "hdf_bytes.h"

typedef enum gonio_i_hdf_class {
    GONIO_I_HDF_OTHER = 0, /* which is not read */
    GONIO_I_HDF_INTEGER,
    GONIO_I_HDF_REAL,
    GONIO_I_HDF_STRING,         /* of fixed length */
    GONIO_I_HDF_VARIABLE_STRING /* a length, and a place in a heap of the file */
} gonio_i_hdf_class;

typedef struct gonio_i_hdf_type {
    gonio_i_hdf_class class;
    size_t size; /* of an element, bytes; not 0 */
    bool big_endian;
    bool is_signed;
} gonio_i_hdf_type;

typedef struct gonio_i_hdf_space {
    int rank;
    size_t extent[GONIO_I_HDF_RANK];
    size_t count; /* of elements */
} gonio_i_hdf_space;

/* From the bodies of messages. False for what is damaged, or has too many dimensions or elements to
 * count the bytes of. */
bool gonio_i_hdf_read_type(gonio_i_hdf_cursor body, gonio_i_hdf_type *type);
bool gonio_i_hdf_read_space(gonio_i_hdf_cursor body, gonio_i_hdf_space *space);

/* Bytes of a number in memory. */
size_t gonio_i_hdf_width(gonio_i_hdf_number_type wanted);

/* Whether numbers of a type become what is wanted. */
bool gonio_i_hdf_converts(const gonio_i_hdf_type *type, gonio_i_hdf_number_type wanted);

/* Converts count numbers, stored one after another, to values[count]. */
void gonio_i_hdf_convert(const gonio_i_hdf_type *type, const unsigned char *stored, size_t count,
                         gonio_i_hdf_number_type wanted, void *values);

/* An integer of a type; it ends at the limits of int64_t. */
int64_t gonio_i_hdf_integer(const gonio_i_hdf_type *type, const unsigned char *stored);

#endif
