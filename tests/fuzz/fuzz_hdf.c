/* libFuzzer on HDF5 files: whatever the bytes are, reading groups, attributes, strings and arrays
 * gives what there is or nothing; neural BRDFs, tables and bases of older programs are refused with
 * one message or are read. */
#include "fuzz.h"

#include "core/hdf_read.h"

enum { MOST_VALUES = 1 << 16, PAIRS = 8 };

static void read_strings(gonio_i_hdf_object root, const char *name)
{
    for (int set = 0; set < 2; set++) {
        char **strings = NULL;
        size_t count = 0;
        const bool read = set ? gonio_i_hdf_read_string_set(root, name, &strings, &count)
                              : gonio_i_hdf_read_strings(root, name, &strings, &count);
        size_t length = 0;
        for (size_t k = 0; read && k < count; k++) {
            length += strlen(strings[k]);
        }
        check(!read || strings != NULL, "strings are there");
        check(length < SIZE_MAX, "and end");
        free(strings);
    }
}

static void read_arrays(gonio_i_hdf_object root, const char *name)
{
    static const size_t widths[] = {sizeof(double), sizeof(float), sizeof(int32_t),
                                    sizeof(uint64_t)};
    for (int rank = 0; rank <= 2; rank++) {
        for (int type = GONIO_I_HDF_DOUBLE; type <= GONIO_I_HDF_UINT64; type++) {
            void *data = NULL;
            size_t extent[GONIO_I_HDF_RANK] = {0};
            const char *problem = gonio_i_hdf_read_array(
                root, name, rank, MOST_VALUES, (gonio_i_hdf_number_type)type, &data, extent);
            check(problem == NULL ? data != NULL : *problem != '\0', "values or a reason");
            size_t count = 1;
            for (int k = 0; k < rank && problem == NULL; k++) {
                count *= extent[k];
            }
            if (problem == NULL) { /* all of it is there to be read */
                unsigned sum = 0;
                for (size_t k = 0; k < count * widths[type]; k++) {
                    sum += ((const unsigned char *)data)[k];
                }
                check(sum < UINT32_MAX, "values");
            }
            free(data);
        }
    }
}

static void read_all(const char *path)
{
    static const char *const names[] = {"format",
                                        "version",
                                        "layer_names",
                                        "a/weight_names",
                                        "rho",
                                        "cell",
                                        "a",
                                        "grid/cell",
                                        "materials/name",
                                        "mean",
                                        "variable",
                                        "member-7",
                                        "a/a/kernel:0",
                                        "sum"};
    gonio_i_hdf_file *file = gonio_i_hdf_open(path);
    if (file == NULL) {
        return;
    }
    const gonio_i_hdf_object root = gonio_i_hdf_root(file);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        gonio_i_hdf_object found;
        gonio_i_hdf_array array;
        int64_t number = 0;
        read_strings(root, names[k]);
        read_arrays(root, names[k]);
        (void)gonio_i_hdf_has_attribute(root, names[k]);
        (void)gonio_i_hdf_read_number(root, names[k], &number);
        if (gonio_i_hdf_find(root, names[k], &found)) {
            (void)gonio_i_hdf_describe(found, &array);
        }
    }
    gonio_i_hdf_close(file);
}

static void evaluate(gonio_context *context, const gonio_material *material)
{
    const size_t channels = gonio_material_describe(material)->channels;
    double *values = calloc(PAIRS * channels, sizeof *values);
    gonio_pair pair[PAIRS];
    check(values != NULL, "memory");
    for (int k = 0; k < PAIRS; k++) {
        pair[k] = (gonio_pair){{0.19 * k, 0.3}, {1.4 - 0.19 * k, 0.9 * k}};
    }
    check_status(gonio_material_evaluate(context, material, pair, PAIRS, values));
    for (size_t k = 0; k < PAIRS * channels; k++) {
        check(isnan(values[k]) || (isfinite(values[k]) && values[k] >= 0.0),
              "a value is none or a BRDF");
    }
    free(values);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    char path[128];
    char converted[128];
    gonio_material *material = NULL;
    if (size < 8 || memcmp(data, "\x89HDF\r\n\x1a\n", 8) != 0) {
        return -1;
    }
    fuzz_path(path, "hdf");
    fuzz_path(converted, "hdf-basis");
    fuzz_write(path, data, size);
    read_all(path);
    gonio_status status = gonio_material_open(context, path, &material);
    check_status(status);
    if (status == GONIO_OK) {
        evaluate(context, material);
    }
    gonio_material_free(&material);
    check_status(gonio_basis_convert(context, path, converted));
    unlink(path);
    unlink(converted);
    return 0;
}
