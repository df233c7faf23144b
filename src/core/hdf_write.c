/* Writing HDF5: see hdf_write.h. */
#include "hdf_write.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* HDF5 has global state that is not thread-safe. So its lock is global too. */
static pthread_mutex_t hdf_lock = PTHREAD_MUTEX_INITIALIZER;

void gonio_i_hdf_enter(gonio_i_hdf_session *session)
{
    pthread_mutex_lock(&hdf_lock);
    H5Eget_auto2(H5E_DEFAULT, &session->handler, &session->data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

void gonio_i_hdf_leave(gonio_i_hdf_session *session)
{
    /* HDF5 keeps errors for each thread. It cannot close while a finished thread has any. */
    H5Eclear2(H5E_DEFAULT);
    H5Eset_auto2(H5E_DEFAULT, session->handler, session->data);
    pthread_mutex_unlock(&hdf_lock);
}

hid_t gonio_i_hdf_create_image(void)
{
    const size_t growth = 1 << 24;
    const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_obj_track_times(creation, false);
    H5Pset_fapl_core(access, growth, false);
    const hid_t file = H5Fcreate("gonio image", H5F_ACC_TRUNC, creation, access);
    H5Pclose(access);
    H5Pclose(creation);
    return file;
}

bool gonio_i_hdf_read_image(hid_t file, const void **image, size_t *size)
{
    void **memory = NULL; /* this driver's handle is the address of its block */
    if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 ||
        H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&memory) < 0 || memory == NULL) {
        return false;
    }
    const ssize_t length = H5Fget_file_image(file, NULL, 0);
    *image = *memory;
    *size = length > 0 ? (size_t)length : 0;
    return *image != NULL && length > 0;
}

bool gonio_i_hdf_write_string(hid_t parent, const char *name, const char *text)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    const hid_t space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, strlen(text) + 1);
    H5Tset_cset(type, H5T_CSET_UTF8);
    const hid_t attribute = H5Acreate2(parent, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool done = attribute >= 0 && H5Awrite(attribute, type, text) >= 0;
    done = attribute >= 0 && H5Aclose(attribute) >= 0 && done;
    H5Sclose(space);
    H5Tclose(type);
    return done;
}

bool gonio_i_hdf_write_number(hid_t parent, const char *name, int64_t value)
{
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute =
        H5Acreate2(parent, name, H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT);
    bool done = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT64, &value) >= 0;
    done = attribute >= 0 && H5Aclose(attribute) >= 0 && done;
    H5Sclose(space);
    return done;
}

bool gonio_i_hdf_write_array(hid_t parent, const char *name, int rank, const size_t *dimensions,
                             hid_t memory_type, hid_t file_type, const void *data)
{
    hsize_t extents[H5S_MAX_RANK] = {0};
    for (int k = 0; k < rank; k++) {
        extents[k] = dimensions[k];
    }
    const hid_t space = H5Screate_simple(rank, extents, NULL);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(properties, false); /* same input, same bytes */
    const hid_t set =
        H5Dcreate2(parent, name, file_type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    bool done = set >= 0 && H5Dwrite(set, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
    done = set >= 0 && H5Dclose(set) >= 0 && done;
    H5Pclose(properties);
    H5Sclose(space);
    return done;
}

bool gonio_i_hdf_write_strings(hid_t parent, const char *name, size_t count,
                               const char *const *strings)
{
    size_t longest = 1;
    for (size_t k = 0; k < count; k++) {
        const size_t length = strlen(strings[k]) + 1;
        longest = length > longest ? length : longest;
    }
    char *block = calloc(count > 0 ? count : 1, longest);
    if (block == NULL) {
        return false;
    }
    for (size_t k = 0; k < count; k++) {
        memcpy(block + k * longest, strings[k], strlen(strings[k]));
    }
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, longest);
    H5Tset_cset(type, H5T_CSET_UTF8);
    const bool done = gonio_i_hdf_write_array(parent, name, 1, &count, type, type, block);
    H5Tclose(type);
    free(block);
    return done;
}
