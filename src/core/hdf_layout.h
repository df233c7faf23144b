/* Where an HDF5 dataset keeps its elements, for its readers alone. */
#ifndef GONIO_HDF_LAYOUT_H
#define GONIO_HDF_LAYOUT_H

#include "hdf_filters.h"
#include "hdf_types.h"

typedef struct gonio_i_hdf_layout {
    bool chunked;
    gonio_i_hdf_cursor whole;       /* in one piece: all bytes */
    uint64_t tree;                  /* chunked: address of the B-tree of chunks */
    size_t chunk[GONIO_I_HDF_RANK]; /* chunked: elements along each dimension */
    size_t chunk_bytes;             /* of a whole chunk */
    gonio_i_hdf_cursor single;      /* chunked: the only chunk where there is no tree */
    uint64_t single_mask;           /* its filters that were left out */
    gonio_i_hdf_filters filters;
} gonio_i_hdf_layout;

/* A dataset: type, shape, place and what stands for elements that were not written. */
typedef struct gonio_i_hdf_set {
    const gonio_i_hdf_file *file;
    gonio_i_hdf_type type;
    gonio_i_hdf_space space;
    gonio_i_hdf_layout layout;
    const unsigned char *unwritten; /* an element; NULL for 0 */
} gonio_i_hdf_set;

/* Returns NULL, or what is wrong. */
const char *gonio_i_hdf_read_set(gonio_i_hdf_object object, gonio_i_hdf_set *set);

#endif
