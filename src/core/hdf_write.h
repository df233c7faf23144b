/* Writing HDF5, with its library; files are read without it (hdf_read.h). The HDF5 library is not
 * thread-safe. So every use is between gonio_i_hdf_enter and gonio_i_hdf_leave. They take a lock
 * and keep HDF5 from printing. Before them gonio_i_hdf_load has to succeed. */
#ifndef GONIO_HDF_WRITE_H
#define GONIO_HDF_WRITE_H

#include "hdf_library.h"

typedef struct gonio_i_hdf_session {
    H5E_auto2_t handler;
    void *data;
} gonio_i_hdf_session;

void gonio_i_hdf_enter(gonio_i_hdf_session *session);
void gonio_i_hdf_leave(gonio_i_hdf_session *session);

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

#endif
