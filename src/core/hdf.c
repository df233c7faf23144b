/* Reading and writing HDF5 with checks: see hdf.h. */
#include "hdf.h"

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

hid_t gonio_i_hdf_open(const char *path)
{
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_file_locking(access, false, true);
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, access);
    H5Pclose(access);
    return file;
}

enum { LONGEST_LIST = 1 << 20, LONGEST_STRING = 1 << 20 };

/* Number of elements of a dataspace of the given rank; false on overflow or a wrong rank. */
static bool element_count(hid_t space, int rank, size_t limit, size_t *dimensions, size_t *count)
{
    hsize_t extents[H5S_MAX_RANK] = {0};
    if (space < 0 || H5Sis_simple(space) <= 0 || H5Sget_simple_extent_ndims(space) != rank ||
        H5Sget_simple_extent_dims(space, extents, NULL) < 0) {
        return false;
    }
    *count = 1;
    for (int k = 0; k < rank; k++) {
        if (extents[k] > limit || (extents[k] > 0 && *count > limit / extents[k])) {
            return false;
        }
        *count *= (size_t)extents[k];
        dimensions[k] = (size_t)extents[k];
    }
    return true;
}

/* Copies n strings, each `stride` bytes apart or (stride 0) pointed to, into one block. */
static char **pack_strings(const char *raw, size_t count, size_t stride)
{
    const char *const *pointers = (const char *const *)(const void *)raw;
    size_t size = count * sizeof(char *) + 1;
    for (size_t k = 0; k < count; k++) {
        const char *s = stride > 0 ? raw + k * stride : pointers[k];
        size += (stride > 0 ? strnlen(s, stride) : s != NULL ? strlen(s) : 0) + 1;
    }
    char **packed = malloc(size);
    if (packed == NULL) {
        return NULL;
    }
    char *text = (char *)(packed + count);
    for (size_t k = 0; k < count; k++) {
        const char *s = stride > 0 ? raw + k * stride : pointers[k];
        const size_t length = stride > 0 ? strnlen(s, stride) : s != NULL ? strlen(s) : 0;
        packed[k] = text;
        memcpy(text, s != NULL ? s : "", length);
        text[length] = '\0';
        text += length + 1;
    }
    return packed;
}

static bool read_raw(hid_t object, bool dataset, hid_t type, void *raw)
{
    return dataset ? H5Dread(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, raw) >= 0
                   : H5Aread(object, type, raw) >= 0;
}

static char **read_typed_strings(hid_t object, bool dataset, hid_t type, hid_t space, size_t *count)
{
    if (H5Sget_simple_extent_npoints(space) == 0) { /* an empty list may have any type */
        *count = 0;
        return calloc(1, sizeof(char *));
    }
    size_t dimensions[1] = {0};
    const int rank = H5Sget_simple_extent_ndims(space) == 0 ? 0 : 1;
    if (H5Tget_class(type) != H5T_STRING ||
        !element_count(space, rank, LONGEST_LIST, dimensions, count)) {
        return NULL;
    }
    const bool variable = H5Tis_variable_str(type) > 0;
    const size_t stride = variable ? sizeof(char *) : H5Tget_size(type);
    if (stride == 0 || stride > LONGEST_STRING || *count > (size_t)LONGEST_LIST * 64 / stride) {
        return NULL;
    }
    char *raw = calloc(*count + 1, stride);
    if (raw == NULL || !read_raw(object, dataset, type, raw)) {
        free(raw);
        return NULL;
    }
    char **packed = pack_strings(raw, *count, variable ? 0 : stride);
    if (variable) {
        H5Dvlen_reclaim(type, space, H5P_DEFAULT, raw);
    }
    free(raw);
    return packed;
}

bool gonio_i_hdf_read_strings(hid_t parent, const char *name, bool dataset, char ***strings,
                              size_t *count)
{
    const hid_t object =
        dataset ? H5Dopen2(parent, name, H5P_DEFAULT) : H5Aopen(parent, name, H5P_DEFAULT);
    if (object < 0) {
        return false;
    }
    const hid_t type = dataset ? H5Dget_type(object) : H5Aget_type(object);
    const hid_t space = dataset ? H5Dget_space(object) : H5Aget_space(object);
    *strings = read_typed_strings(object, dataset, type, space, count);
    H5Sclose(space);
    H5Tclose(type);
    if (dataset) {
        H5Dclose(object);
    } else {
        H5Aclose(object);
    }
    return *strings != NULL;
}

static const char *read_dataset(hid_t set, int rank, size_t limit, hid_t type, void **data,
                                size_t *dimensions)
{
    const hid_t stored = H5Dget_type(set);
    const H5T_class_t class = H5Tget_class(stored);
    H5Tclose(stored);
    if (class != H5T_FLOAT && class != H5T_INTEGER) {
        return "is not numeric";
    }
    const hid_t space = H5Dget_space(set);
    size_t count = 0;
    const bool shaped = element_count(space, rank, limit, dimensions, &count);
    H5Sclose(space);
    if (!shaped) {
        return "has a wrong shape";
    }
    void *values = calloc(count + 1, H5Tget_size(type));
    if (values == NULL) {
        return "is too large for the memory";
    }
    if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
        free(values);
        return "cannot be read (file damaged or truncated)";
    }
    *data = values;
    return NULL;
}

const char *gonio_i_hdf_read_array(hid_t parent, const char *name, int rank, size_t limit,
                                   hid_t type, void **data, size_t *dimensions)
{
    const hid_t set = H5Dopen2(parent, name, H5P_DEFAULT);
    if (set < 0) {
        return "is missing";
    }
    const char *problem = read_dataset(set, rank, limit, type, data, dimensions);
    H5Dclose(set);
    return problem;
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

bool gonio_i_hdf_read_number(hid_t parent, const char *name, int64_t *value)
{
    const hid_t attribute = H5Aopen(parent, name, H5P_DEFAULT);
    if (attribute < 0) {
        return false;
    }
    const hid_t type = H5Aget_type(attribute);
    const hid_t space = H5Aget_space(attribute);
    const bool done = H5Tget_class(type) == H5T_INTEGER &&
                      H5Sget_simple_extent_npoints(space) == 1 &&
                      H5Aread(attribute, H5T_NATIVE_INT64, value) >= 0;
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(attribute);
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
