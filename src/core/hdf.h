/* Reading and writing HDF5 with checks. The HDF5 library is not thread-safe. So every use is
 * between gonio_i_hdf_enter and gonio_i_hdf_leave. They take a lock and keep HDF5 from printing. */
#ifndef GONIO_HDF_H
#define GONIO_HDF_H

#include <hdf5.h>

#include "core.h"

typedef struct gonio_i_hdf_session {
    H5E_auto2_t handler;
    void *data;
} gonio_i_hdf_session;

void gonio_i_hdf_enter(gonio_i_hdf_session *session);
void gonio_i_hdf_leave(gonio_i_hdf_session *session);

/* A file opened for reading, without a lock: another program may have it open for writing. Negative
 * if it cannot be opened. */
hid_t gonio_i_hdf_open(const char *path);

/* Reads a list of strings (fixed or variable length, rank 0 or 1) from an attribute, or from a
 * dataset if `dataset` is set. The result is one block, released with free(). False if it is
 * missing or is not a list of strings. */
bool gonio_i_hdf_read_strings(hid_t parent, const char *name, bool dataset, char ***strings,
                              size_t *count);

/* Reads a numeric dataset of `rank` dimensions and at most `limit` values, converted to `type`
 * (element size H5Tget_size(type)). Fills in dimensions[rank]. The values are released with free().
 * Returns NULL on success, otherwise a text that says what is wrong. */
const char *gonio_i_hdf_read_array(hid_t parent, const char *name, int rank, size_t limit,
                                   hid_t type, void **data, size_t *dimensions);

/* A new file in memory, and its bytes. They are valid until the file is changed or closed. */
hid_t gonio_i_hdf_create_image(void);
bool gonio_i_hdf_read_image(hid_t file, const void **image, size_t *size);

/* Writing: false if HDF5 fails. */
bool gonio_i_hdf_write_string(hid_t parent, const char *name, const char *text);
bool gonio_i_hdf_write_strings(hid_t parent, const char *name, size_t count,
                               const char *const *strings);
bool gonio_i_hdf_write_array(hid_t parent, const char *name, int rank, const size_t *dimensions,
                             hid_t memory_type, hid_t file_type, const void *data);
bool gonio_i_hdf_write_number(hid_t parent, const char *name, int64_t value);
bool gonio_i_hdf_read_number(hid_t parent, const char *name, int64_t *value);

#endif
