/* Reading HDF5 without its library, which corrupts memory on damaged files: groups, attributes, and
 * datasets of numbers and strings, in the structures that HDF5 and h5py write unless they are asked
 * for others. That is superblocks 0 to 3; object headers 1 and 2; groups as symbol tables or with
 * their links in the header; datasets stored in one piece, in the header or in chunks under a
 * B-tree of version 1, with deflate, shuffle and checksums (which are not looked at). All else,
 * such as external files, links to other names, virtual datasets and groups in fractal heaps, is as
 * if it were not there.
 *
 * Whatever the bytes are, nothing outside of them is read, and memory and time grow with the file's
 * size. Nothing here sends messages. A file may be read by several threads at once. */
#ifndef GONIO_HDF_READ_H
#define GONIO_HDF_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct gonio_i_hdf_file gonio_i_hdf_file;

/* A group or a dataset. The file must outlive it. */
typedef struct gonio_i_hdf_object {
    const gonio_i_hdf_file *file;
    uint64_t address; /* of its header */
} gonio_i_hdf_object;

/* Maps a file, which must not be cut short meanwhile. NULL if it cannot be opened, is no HDF5 file
 * or lacks its end. */
gonio_i_hdf_file *gonio_i_hdf_open(const char *path);
void gonio_i_hdf_close(gonio_i_hdf_file *file);

gonio_i_hdf_object gonio_i_hdf_root(const gonio_i_hdf_file *file);

/* The group or dataset at a path like "a/b" below a group; false if there is none. */
bool gonio_i_hdf_find(gonio_i_hdf_object group, const char *path, gonio_i_hdf_object *found);

/* ---- attributes ---- */

bool gonio_i_hdf_has_attribute(gonio_i_hdf_object object, const char *name);

/* An integer. */
bool gonio_i_hdf_read_number(gonio_i_hdf_object object, const char *name, int64_t *value);

/* ---- strings, of an attribute or of the dataset at a path ---- */

/* A list of strings (of fixed or variable length, rank 0 or 1), in one block that is released with
 * free(). An empty list may have any type. False if it is missing, no list of strings or out of
 * memory. */
bool gonio_i_hdf_read_strings(gonio_i_hdf_object object, const char *name, char ***strings,
                              size_t *count);
bool gonio_i_hdf_read_string_set(gonio_i_hdf_object group, const char *path, char ***strings,
                                 size_t *count);

/* ---- arrays ---- */

enum { GONIO_I_HDF_RANK = 8 }; /* most dimensions */

/* What numbers become. Integers are read from integers only, and end at the limits of their type.
 */
typedef enum gonio_i_hdf_number_type {
    GONIO_I_HDF_DOUBLE = 0,
    GONIO_I_HDF_FLOAT,
    GONIO_I_HDF_INT32,
    GONIO_I_HDF_UINT64
} gonio_i_hdf_number_type;

/* What a dataset of numbers is. */
typedef struct gonio_i_hdf_array {
    int rank;
    size_t extent[GONIO_I_HDF_RANK];
    double unwritten; /* what elements are that were not written */
} gonio_i_hdf_array;

/* Returns NULL, or what is wrong, also if the file cannot hold that many numbers: memory for them
 * grows with the file. */
const char *gonio_i_hdf_describe(gonio_i_hdf_object set, gonio_i_hdf_array *array);

/* Consecutive numbers of a dataset in the order of rows (the last index is the fastest), the first
 * of them number `first`: double, float, int32_t or uint64_t values[count]. */
typedef void gonio_i_hdf_run(void *user, size_t first, size_t count, const void *values);

/* Calls `run` for all numbers of a dataset that were written, chunk by chunk. Returns NULL, or what
 * is wrong; `run` may have been called then. */
const char *gonio_i_hdf_visit(gonio_i_hdf_object set, gonio_i_hdf_number_type type,
                              gonio_i_hdf_run *run, void *user);

/* The numbers of the dataset at a path, with `rank` dimensions and at most `limit` values, released
 * with free(). Fills in dimensions[rank]. Returns NULL, or what is wrong ("is missing"). */
const char *gonio_i_hdf_read_array(gonio_i_hdf_object group, const char *path, int rank,
                                   size_t limit, gonio_i_hdf_number_type type, void **data,
                                   size_t *dimensions);

#endif
