/* The stored bytes of an HDF5 dataset in runs of consecutive elements, for its readers alone. */
#ifndef GONIO_HDF_CHUNKS_H
#define GONIO_HDF_CHUNKS_H

#include "hdf_layout.h"

/* Elements number first .. first + count - 1, as they are stored. */
typedef void gonio_i_hdf_stored_run(void *user, size_t first, size_t count,
                                    const unsigned char *stored);

/* Calls `run` for every element that was written, each time a chunk has been read. Returns NULL, or
 * what is wrong; `run` may have been called then. */
const char *gonio_i_hdf_visit_stored(const gonio_i_hdf_set *set, gonio_i_hdf_stored_run *run,
                                     void *user);

/* What keeps a dataset from being read: chunks that cannot hold what its shape says, or data that
 * are far larger than their file where an element takes `width` bytes; NULL if nothing does. Memory
 * and time for the whole of it grow with the file then. */
const char *gonio_i_hdf_lacks(const gonio_i_hdf_set *set, size_t width);

#endif
