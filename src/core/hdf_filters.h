/* The filters that chunks of an HDF5 dataset passed through, undone; for its readers alone. */
#ifndef GONIO_HDF_FILTERS_H
#define GONIO_HDF_FILTERS_H

#include "hdf_bytes.h"

enum { GONIO_I_HDF_MOST_FILTERS = 4 };

/* Deflate makes bytes at most so many times fewer. */
enum { GONIO_I_HDF_MOST_DEFLATION = 1100 };

/* In the order in which they were applied. */
typedef struct gonio_i_hdf_filters {
    int count;
    uint16_t id[GONIO_I_HDF_MOST_FILTERS];
    size_t element[GONIO_I_HDF_MOST_FILTERS]; /* of shuffle: bytes of an element */
} gonio_i_hdf_filters;

/* From the body of a message. False if it is damaged or a filter is not known here. */
bool gonio_i_hdf_read_filters(gonio_i_hdf_cursor body, gonio_i_hdf_filters *filters);

/* Undoes filters but those in the mask, where bit k stands for the k-th. `chunk` gets the `size`
 * bytes of the chunk. `chunk` and `other` have room for size + GONIO_I_HDF_SPARE bytes. False if
 * stored bytes are damaged. */
enum { GONIO_I_HDF_SPARE = 4 * GONIO_I_HDF_MOST_FILTERS }; /* for a checksum each */
bool gonio_i_hdf_undo_filters(const gonio_i_hdf_filters *filters, uint64_t mask,
                              gonio_i_hdf_cursor stored, size_t size, unsigned char *chunk,
                              unsigned char *other);

#endif
