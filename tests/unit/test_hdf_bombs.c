/* HDF5 files that are small and claim or hold much: refused before memory is asked for or time is
 * spent. What is compressed within reason is read. */
#include "../support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <hdf5.h>

#include "core/hdf_read.h"
#include "mutations.h"

static const char refused[] = "is far larger than its file (made to fill the memory?)";

enum { RANK = 2 };

/* Creates a dataset of zeros: `bytes` stand in for each compressed chunk, of which `most` are
 * written. What they hold does not matter where they are refused. */
static void write_chunks(const char *path, hid_t type, const hsize_t *extents, const hsize_t *chunk,
                         size_t bytes, size_t most)
{
    const hsize_t limits[RANK] = {H5S_UNLIMITED, H5S_UNLIMITED};
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(RANK, extents, limits);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(properties, RANK, chunk);
    H5Pset_deflate(properties, 9);
    const hid_t set = H5Dcreate2(file, "set", type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    void *stored = calloc(bytes, 1);
    size_t written = 0;
    for (hsize_t r = 0; r < extents[0]; r += chunk[0]) {
        for (hsize_t c = 0; c < extents[1] && written < most; c += chunk[1], written++) {
            const hsize_t start[RANK] = {r, c};
            assert_true(H5Dwrite_chunk(set, H5P_DEFAULT, 0, start, bytes, stored) >= 0);
        }
    }
    free(stored);
    H5Dclose(set);
    H5Pclose(properties);
    H5Sclose(space);
    H5Fclose(file);
}

static void ignore(void *user, size_t first, size_t count, const void *values)
{
    (void)user;
    (void)first;
    (void)count;
    (void)values;
}

static gonio_i_hdf_file *open_set(const char *path, gonio_i_hdf_object *set)
{
    gonio_i_hdf_file *file = gonio_i_hdf_open(path);
    assert_non_null(file);
    assert_true(gonio_i_hdf_find(gonio_i_hdf_root(file), "set", set));
    return file;
}

static void check_refused(const char *path, gonio_i_hdf_number_type type)
{
    void *data = NULL;
    size_t shape[RANK];
    gonio_i_hdf_object set;
    gonio_i_hdf_file *file = open_set(path, &set);
    const char *problem =
        gonio_i_hdf_read_array(gonio_i_hdf_root(file), "set", RANK, SIZE_MAX, type, &data, shape);
    assert_non_null(problem);
    assert_string_equal(problem, refused);
    assert_string_equal(gonio_i_hdf_visit(set, type, ignore, NULL), refused);
    gonio_i_hdf_close(file);
}

/* 800 MiB in one chunk; 400 MiB of bytes that would be 3.2 GiB of numbers; a small array in chunks
 * of 160 MiB, few of whose elements are in the array. */
static void small_files_with_large_arrays(void **state)
{
    (void)state;
    const size_t MIB = 1U << 20;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.h5", folder);
    write_chunks(path, H5T_IEEE_F64LE, (hsize_t[]){100, MIB}, (hsize_t[]){100, MIB}, MIB, 1);
    check_refused(path, GONIO_I_HDF_DOUBLE);
    write_chunks(path, H5T_STD_U8LE, (hsize_t[]){400, MIB}, (hsize_t[]){50, MIB}, MIB / 16, 8);
    check_refused(path, GONIO_I_HDF_DOUBLE);
    write_chunks(path, H5T_IEEE_F64LE, (hsize_t[]){300, 2}, (hsize_t[]){10, 2 * MIB}, MIB / 4, 3);
    check_refused(path, GONIO_I_HDF_FLOAT);
    support_remove(folder);
}

/* 180 MiB of a constant, as 31 wavelengths of a table may be. */
static void constant_arrays(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    gonio_i_hdf_object set;
    gonio_i_hdf_array array;
    snprintf(path, sizeof path, "%s/x.h5", folder);
    write_chunks(path, H5T_IEEE_F32LE, (hsize_t[]){2790, 16200}, (hsize_t[]){1, 16200}, 100, 2790);
    gonio_i_hdf_file *file = open_set(path, &set);
    assert_null(gonio_i_hdf_describe(set, &array));
    assert_int_equal(array.extent[0], 2790);
    gonio_i_hdf_close(file);
    support_remove(folder);
}

/* ---- strings ---- */

enum { STRINGS = 2000, PLACE = 16, IN_HEAP = 4200 };

static void write_variable(const char *path)
{
    static const char *strings[STRINGS];
    const hsize_t count = STRINGS;
    for (int k = 0; k < STRINGS; k++) {
        strings[k] = "x";
    }
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    const hid_t space = H5Screate_simple(1, &count, NULL);
    const hid_t set = H5Dcreate2(file, "set", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, strings) >= 0);
    H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
    H5Fclose(file);
}

static void put(unsigned char *to, uint64_t value, int bytes)
{
    for (int k = 0; k < bytes; k++) {
        to[k] = (unsigned char)(value >> 8 * k);
    }
}

/* A collection of `objects` empty strings of number 1 and, as the last, one of number 2. */
static size_t make_heap(unsigned char *heap, size_t objects)
{
    const size_t size = PLACE * (objects + 2) + 8;
    memset(heap, 0, size);
    memcpy(heap, "GCOL\1", 5);
    put(heap + 8, size, 8);
    for (size_t k = 0; k < objects; k++) {
        unsigned char *object = heap + PLACE * (k + 1);
        put(object, k + 1 == objects ? 2 : 1, 2);
        put(object + 8, k + 1 == objects ? 1 : 0, 8);
    }
    heap[PLACE * (objects + 1)] = 'y';
    return size;
}

/* Puts a collection at the end of the file, and lets all strings be the last in there. */
static void move_strings(const char *path, size_t objects)
{
    size_t size = 0;
    unsigned char *text = read_bytes(path, &size);
    const size_t end = (size + 7) / 8 * 8;
    unsigned char *bytes = calloc(1, end + PLACE * (objects + 3));
    memcpy(bytes, text, size);
    const size_t all = end + make_heap(bytes + end, objects);
    int moved = 0;
    for (size_t at = 0; at + PLACE <= size; at += 4) {
        uint64_t heap = 0;
        memcpy(&heap, bytes + at + 4, sizeof heap);
        if (memcmp(bytes + at, "\1\0\0", 4) == 0 && heap < size &&
            memcmp(bytes + heap, "GCOL", 4) == 0) {
            put(bytes + at + 4, end, 8);
            put(bytes + at + 12, 2, 4);
            moved++;
        }
    }
    assert_int_equal(moved, STRINGS);
    write_bytes(path, bytes, all);
    free(bytes);
    free(text);
}

/* Collections are searched from their start: one that is far larger than HDF5's own would be
 * searched thousands of times. */
static void strings_in_a_large_heap(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.h5", folder);
    for (int large = 0; large < 2; large++) {
        char **strings = NULL;
        size_t count = 0;
        gonio_i_hdf_object set;
        write_variable(path);
        move_strings(path, large ? IN_HEAP : 30);
        gonio_i_hdf_file *file = open_set(path, &set);
        assert_int_equal(
            gonio_i_hdf_read_string_set(gonio_i_hdf_root(file), "set", &strings, &count), !large);
        if (!large) {
            assert_int_equal(count, STRINGS);
            assert_string_equal(strings[STRINGS - 1], "y");
        }
        free(strings);
        gonio_i_hdf_close(file);
    }
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_files_with_large_arrays),
        cmocka_unit_test(constant_arrays),
        cmocka_unit_test(strings_in_a_large_heap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
