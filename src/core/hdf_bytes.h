/* The bytes of an HDF5 file, for its readers alone: mapped, and read in little-endian numbers that
 * never leave what there is. */
#ifndef GONIO_HDF_BYTES_H
#define GONIO_HDF_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hdf_read.h"

/* What HDF5 writes for an address where nothing is. */
#define GONIO_I_HDF_NOWHERE UINT64_MAX

struct gonio_i_hdf_file {
    const unsigned char *bytes; /* [size], mapped */
    size_t size;
    uint64_t root; /* address of the root group's header */
};

/* A place within a block of bytes. After a read beyond its end it has failed, stands at the end and
 * gives zeros. */
typedef struct gonio_i_hdf_cursor {
    const unsigned char *at;
    size_t left;
    bool failed;
} gonio_i_hdf_cursor;

/* A block of the file; it has failed if it is not all in there. */
gonio_i_hdf_cursor gonio_i_hdf_block(const gonio_i_hdf_file *file, uint64_t address, uint64_t size);

/* From an address to the end of the file. */
gonio_i_hdf_cursor gonio_i_hdf_from(const gonio_i_hdf_file *file, uint64_t address);

/* Passes over `size` bytes and gives where they begin; NULL if there are fewer. */
const unsigned char *gonio_i_hdf_take(gonio_i_hdf_cursor *cursor, uint64_t size);

/* The next number of `size` bytes, at most eight. */
uint64_t gonio_i_hdf_number(gonio_i_hdf_cursor *cursor, size_t size);

/* Passes over a signature of four letters, or fails. */
bool gonio_i_hdf_expect(gonio_i_hdf_cursor *cursor, const char *signature);

#endif
