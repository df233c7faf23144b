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

/* Whether a dataset's chunks can hold what its shape says: no chunk is larger than filters allow,
 * and there are enough of them. Memory for the whole of it grows with the file then. */
bool gonio_i_hdf_is_stored(const gonio_i_hdf_set *set);

#endif
