/* Reading HDF5: files of the HDF5 library in all the ways that are read give what was written, and
 * what is not read is as if it were not there. Damaged ones are the fuzz targets' part. */
#include "../support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <hdf5.h>

#include "core/hdf_read.h"
#include "core/hdf_write.h"

enum { ROWS = 37, COLUMNS = 23, COUNT = ROWS * COLUMNS };

/* How a dataset is stored. */
typedef struct manner {
    bool chunked, deflated, shuffled, summed, compact, single;
} manner;

static const manner manners[] = {
    {.chunked = false},
    {.compact = true},
    {.chunked = true},
    {.chunked = true, .deflated = true},
    {.chunked = true, .deflated = true, .shuffled = true},
    {.chunked = true, .deflated = true, .shuffled = true, .summed = true},
    {.chunked = true, .summed = true},
    {.chunked = true, .shuffled = true},
};

static hid_t create(const char *path, bool latest)
{
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    if (latest) {
        H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    }
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    assert_true(file >= 0);
    return file;
}

static hid_t properties_of(const manner *how)
{
    const hsize_t chunk[2] = {how->single ? ROWS : 10, how->single ? COLUMNS : 7};
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_layout(properties, how->compact   ? H5D_COMPACT
                              : how->chunked ? H5D_CHUNKED
                                             : H5D_CONTIGUOUS);
    if (how->chunked) {
        H5Pset_chunk(properties, 2, chunk);
    }
    if (how->shuffled) {
        H5Pset_shuffle(properties);
    }
    if (how->deflated) {
        H5Pset_deflate(properties, 6);
    }
    if (how->summed) {
        H5Pset_fletcher32(properties);
    }
    return properties;
}

static double value_of(size_t k)
{
    return (double)(k % 251) - 30.0;
}

static void write_set(hid_t file, const char *name, hid_t type, const manner *how)
{
    const hsize_t extents[2] = {ROWS, COLUMNS};
    double values[COUNT];
    for (size_t k = 0; k < COUNT; k++) {
        values[k] = value_of(k);
    }
    const hid_t space = H5Screate_simple(2, extents, NULL);
    const hid_t properties = properties_of(how);
    const hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    assert_true(set >= 0);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    H5Dclose(set);
    H5Pclose(properties);
    H5Sclose(space);
}

/* As the HDF5 library reads it. */
static void read_by_library(const char *path, const char *name, hid_t type, void *values)
{
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    assert_true(set >= 0 && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    H5Dclose(set);
    H5Fclose(file);
}

static gonio_i_hdf_file *open_file(const char *path)
{
    gonio_i_hdf_file *file = gonio_i_hdf_open(path);
    assert_non_null(file);
    return file;
}

static void compare_doubles(const char *path, const char *name)
{
    double expected[COUNT];
    void *data = NULL;
    size_t extents[2] = {0, 0};
    gonio_i_hdf_file *file = open_file(path);
    const char *problem = gonio_i_hdf_read_array(gonio_i_hdf_root(file), name, 2, COUNT,
                                                 GONIO_I_HDF_DOUBLE, &data, extents);
    if (problem != NULL) {
        fail_msg("%s: %s", name, problem);
    }
    gonio_i_hdf_close(file);
    read_by_library(path, name, H5T_NATIVE_DOUBLE, expected);
    assert_int_equal(extents[0], ROWS);
    assert_int_equal(extents[1], COLUMNS);
    assert_memory_equal(data, expected, sizeof expected);
    free(data);
}

static void compare_integers(const char *path, const char *name)
{
    int32_t expected[COUNT];
    uint64_t large[COUNT];
    size_t extents[2] = {0, 0};
    void *data = NULL;
    gonio_i_hdf_file *file = open_file(path);
    const gonio_i_hdf_object root = gonio_i_hdf_root(file);
    assert_null(gonio_i_hdf_read_array(root, name, 2, COUNT, GONIO_I_HDF_INT32, &data, extents));
    read_by_library(path, name, H5T_NATIVE_INT32, expected);
    assert_memory_equal(data, expected, sizeof expected);
    free(data);
    assert_null(gonio_i_hdf_read_array(root, name, 2, COUNT, GONIO_I_HDF_UINT64, &data, extents));
    read_by_library(path, name, H5T_NATIVE_UINT64, large);
    assert_memory_equal(data, large, sizeof large);
    free(data);
    gonio_i_hdf_close(file);
}

static hid_t half_precision(void)
{
    const hid_t type = H5Tcopy(H5T_IEEE_F32LE);
    H5Tset_fields(type, 15, 10, 5, 0, 10);
    H5Tset_size(type, 2);
    H5Tset_ebias(type, 15);
    return type;
}

/* Every type in every way of storing; in files of the oldest and the newest structures. */
static void numbers_are_read_as_the_library_reads_them(void **state)
{
    (void)state;
    const hid_t half = half_precision();
    const hid_t types[] = {H5T_IEEE_F64LE, H5T_IEEE_F64BE, H5T_IEEE_F32LE, H5T_IEEE_F32BE,
                           half,           H5T_STD_I8LE,   H5T_STD_U8LE,   H5T_STD_I16BE,
                           H5T_STD_U32LE,  H5T_STD_I64LE,  H5T_STD_U64BE};
    enum { TYPES = sizeof types / sizeof *types, MANNERS = sizeof manners / sizeof *manners };
    char *folder = support_folder();
    char path[4096];
    char name[32];
    snprintf(path, sizeof path, "%s/x.h5", folder);
    for (int latest = 0; latest < 2; latest++) {
        for (int m = 0; m < MANNERS; m++) {
            manner how = manners[m];
            how.single = latest != 0; /* of the newer indices of chunks, only this is read */
            const hid_t file = create(path, latest != 0);
            const int first = how.compact ? 2 : 0; /* at most 64 KiB with all */
            const int count = latest ? first + 6 : TYPES;
            for (int t = first; t < count; t++) {
                snprintf(name, sizeof name, "set%d", t);
                write_set(file, name, types[t], &how);
            }
            H5Fclose(file);
            for (int t = first; t < count; t++) {
                snprintf(name, sizeof name, "set%d", t);
                compare_doubles(path, name);
                if (t > 4) {
                    compare_integers(path, name);
                }
            }
        }
    }
    H5Tclose(half);
    support_remove(folder);
}

/* Groups in groups, and so many members that a group's tree has levels. */
static void groups_are_searched(void **state)
{
    (void)state;
    enum { MEMBERS = 3000 };
    char *folder = support_folder();
    char path[4096];
    char name[64];
    snprintf(path, sizeof path, "%s/x.h5", folder);
    const hid_t file = create(path, false);
    const hid_t outer = H5Gcreate2(file, "outer", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    for (int k = 0; k < MEMBERS; k++) {
        snprintf(name, sizeof name, "member-%d", k);
        const hid_t group = H5Gcreate2(outer, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        assert_true(gonio_i_hdf_write_number(group, "number", k));
        H5Gclose(group);
    }
    assert_true(H5Lcreate_soft("/outer", file, "soft", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    assert_true(
        H5Lcreate_external("/etc/passwd", "/", file, "external", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    H5Gclose(outer);
    H5Fclose(file);
    gonio_i_hdf_file *opened = open_file(path);
    const gonio_i_hdf_object root = gonio_i_hdf_root(opened);
    gonio_i_hdf_object found;
    for (int k = 0; k < MEMBERS; k += 7) {
        int64_t number = -1;
        snprintf(name, sizeof name, "/outer//member-%d/", k);
        assert_true(gonio_i_hdf_find(root, name, &found));
        assert_true(gonio_i_hdf_read_number(found, "number", &number) && number == k);
    }
    static const char *const none[] = {"soft", "external", "oute", "outer/member-3000",
                                       "outer/x/y"};
    for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
        assert_false(gonio_i_hdf_find(root, none[k], &found));
    }
    gonio_i_hdf_close(opened);
    support_remove(folder);
}

/* ---- strings ---- */

static void write_variable(hid_t parent, const char *name, const char *const *strings,
                           hsize_t count)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    const hid_t space = H5Screate_simple(1, &count, NULL);
    const hid_t own = H5Acreate2(parent, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t set = H5Dcreate2(parent, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(own, type, strings) >= 0);
    assert_true(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, strings) >= 0);
    H5Aclose(own);
    H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
}

static void check_strings(char **strings, size_t count, const char *const *expected, size_t wanted)
{
    assert_int_equal(count, wanted);
    for (size_t k = 0; k < count; k++) {
        assert_string_equal(strings[k], expected[k]);
    }
    free(strings);
}

/* In attributes and datasets, of fixed and of variable length, none at all. */
static void strings_are_read(void **state)
{
    (void)state;
    static const char *const words[] = {"one", "", "a longer one than that", "\303\244"};
    enum { WORDS = sizeof words / sizeof *words };
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.h5", folder);
    for (int latest = 0; latest < 2; latest++) {
        const hid_t file = create(path, latest != 0);
        const size_t none = 0;
        char **strings = NULL;
        size_t count = 9;
        assert_true(gonio_i_hdf_write_string(file, "format", "a format"));
        assert_true(gonio_i_hdf_write_strings(file, "fixed", WORDS, words));
        write_variable(file, "variable", words, WORDS);
        assert_true(gonio_i_hdf_write_array(file, "none", 1, &none, H5T_NATIVE_DOUBLE,
                                            H5T_IEEE_F64LE, words));
        H5Fclose(file);
        gonio_i_hdf_file *opened = open_file(path);
        const gonio_i_hdf_object root = gonio_i_hdf_root(opened);
        assert_true(gonio_i_hdf_read_strings(root, "format", &strings, &count));
        check_strings(strings, count, (const char *const[]){"a format"}, 1);
        assert_true(gonio_i_hdf_read_string_set(root, "fixed", &strings, &count));
        check_strings(strings, count, words, WORDS);
        assert_true(gonio_i_hdf_read_strings(root, "variable", &strings, &count));
        check_strings(strings, count, words, WORDS);
        assert_true(gonio_i_hdf_read_string_set(root, "variable", &strings, &count));
        check_strings(strings, count, words, WORDS);
        assert_true(gonio_i_hdf_read_string_set(root, "none", &strings, &count));
        check_strings(strings, count, words, 0);
        assert_false(gonio_i_hdf_read_strings(root, "fixed", &strings, &count));
        assert_false(gonio_i_hdf_read_string_set(root, "format", &strings, &count));
        int64_t number = 0;
        assert_false(gonio_i_hdf_read_number(root, "format", &number));
        assert_true(gonio_i_hdf_has_attribute(root, "format"));
        assert_false(gonio_i_hdf_has_attribute(root, "forma"));
        gonio_i_hdf_close(opened);
    }
    support_remove(folder);
}

/* ---- what is not there ---- */

/* Chunks that were not written are the fill value; arrays of which nothing is stored are refused,
 * as are those in other files. */
static void what_is_not_stored(void **state)
{
    (void)state;
    const hsize_t extents[2] = {40, 40};
    const hsize_t chunk[2] = {10, 10};
    const hsize_t start[2] = {10, 20};
    const double fill = -7.5;
    double ones[100];
    double expected[1600];
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.h5", folder);
    const hid_t file = create(path, false);
    const hid_t space = H5Screate_simple(2, extents, NULL);
    const hid_t part = H5Screate_simple(2, chunk, NULL);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    const hid_t outside = H5Pcreate(H5P_DATASET_CREATE);
    for (int k = 0; k < 100; k++) {
        ones[k] = 1.0;
    }
    H5Pset_chunk(properties, 2, chunk);
    H5Pset_fill_value(properties, H5T_NATIVE_DOUBLE, &fill);
    H5Pset_external(outside, "/etc/passwd", 0, H5F_UNLIMITED);
    const hid_t set =
        H5Dcreate2(file, "part", H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, chunk, NULL);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, part, space, H5P_DEFAULT, ones) >= 0);
    H5Sselect_all(space);
    H5Dclose(set);
    H5Dclose(H5Dcreate2(file, "none", H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT));
    H5Dclose(H5Dcreate2(file, "outside", H5T_IEEE_F64LE, space, H5P_DEFAULT, outside, H5P_DEFAULT));
    H5Pclose(properties);
    H5Pclose(outside);
    H5Sclose(space);
    H5Sclose(part);
    H5Fclose(file);
    read_by_library(path, "part", H5T_NATIVE_DOUBLE, expected);
    gonio_i_hdf_file *opened = open_file(path);
    const gonio_i_hdf_object root = gonio_i_hdf_root(opened);
    const gonio_i_hdf_number_type type = GONIO_I_HDF_DOUBLE;
    void *data = NULL;
    size_t found[2];
    assert_null(gonio_i_hdf_read_array(root, "part", 2, 1600, type, &data, found));
    assert_memory_equal(data, expected, sizeof expected);
    free(data);
    assert_string_equal(gonio_i_hdf_read_array(root, "none", 2, 1600, type, &data, found),
                        "is not in the file, or not all of it");
    assert_string_equal(gonio_i_hdf_read_array(root, "outside", 2, 1600, type, &data, found),
                        "is not in the file, or not all of it");
    assert_string_equal(gonio_i_hdf_read_array(root, "part", 2, 1599, type, &data, found),
                        "has a wrong shape");
    assert_string_equal(gonio_i_hdf_read_array(root, "part", 1, 1600, type, &data, found),
                        "has a wrong shape");
    assert_string_equal(
        gonio_i_hdf_read_array(root, "part", 2, 1600, GONIO_I_HDF_INT32, &data, found),
        "is not numeric");
    assert_string_equal(gonio_i_hdf_read_array(root, "x", 2, 1600, type, &data, found),
                        "is missing");
    gonio_i_hdf_close(opened);
    support_remove(folder);
}

/* ---- the neural BRDFs of the shared data ---- */

typedef struct weights {
    const char *path;
    gonio_i_hdf_object root;
    int sets;
} weights;

static herr_t compare_member(hid_t root, const char *name, const H5O_info_t *info, void *user)
{
    weights *w = user;
    (void)root;
    if (info->type == H5O_TYPE_DATASET) {
        float expected[21 * 21];
        size_t extents[2];
        void *data = NULL;
        const int rank = strstr(name, "kernel") != NULL ? 2 : 1;
        assert_null(
            gonio_i_hdf_read_array(w->root, name, rank, 441, GONIO_I_HDF_FLOAT, &data, extents));
        read_by_library(w->path, name, H5T_NATIVE_FLOAT, expected);
        assert_memory_equal(data, expected,
                            extents[0] * (rank == 2 ? extents[1] : 1) * sizeof(float));
        free(data);
        w->sets++;
    }
    return 0;
}

static void weights_are_read_as_the_library_reads_them(void **state)
{
    (void)state;
    support_need_shared();
    for (int k = 0; k < SUPPORT_MERL; k++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/data/neural-merl/%s.h5", support_shared(), support_merl[k]);
        gonio_i_hdf_file *opened = open_file(path);
        weights w = {.path = path, .root = gonio_i_hdf_root(opened)};
        const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        assert_true(H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, compare_member, &w) >= 0);
        assert_int_equal(w.sets, 6);
        H5Fclose(file);
        gonio_i_hdf_close(opened);
    }
}

static int load_library(void **state)
{
    (void)state;
    return gonio_i_hdf_load(NULL) == GONIO_OK ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_read_as_the_library_reads_them),
        cmocka_unit_test(groups_are_searched),
        cmocka_unit_test(strings_are_read),
        cmocka_unit_test(what_is_not_stored),
        cmocka_unit_test(weights_are_read_as_the_library_reads_them),
    };
    return cmocka_run_group_tests(tests, load_library, NULL);
}
