/* Seeds: HDF5 files, by its library. */
#include "fuzz.h"

#include <inttypes.h>

#include "core/hdf_write.h"
#include "seeds.h"

static hid_t create(const char *name, bool latest)
{
    char path[4096];
    seed_path(path, "hdf", name);
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    if (latest) {
        H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    }
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    check(file >= 0, "a file is written");
    H5Pclose(access);
    return file;
}

static hid_t group(hid_t parent, const char *name)
{
    return H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
}

/* An attribute that is a list of strings. */
static void list(hid_t object, const char *name, const char *text, hsize_t count, size_t length)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    const hid_t space = H5Screate_simple(1, &count, NULL);
    H5Tset_size(type, length);
    const hid_t own = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    check(H5Awrite(own, type, text) >= 0, "an attribute is written");
    H5Aclose(own);
    H5Sclose(space);
    H5Tclose(type);
}

static void doubles(hid_t parent, const char *name, int rank, const size_t *shape, hid_t type)
{
    static double values[21 * 21];
    for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
        values[k] = 0.1 * (double)(k % 17) - 0.3;
    }
    check(gonio_i_hdf_write_array(parent, name, rank, shape, H5T_NATIVE_DOUBLE, type, values),
          "numbers are written");
}

/* A network of layers a, b, c and one without weights. */
static void seed_network(const char *name, bool latest)
{
    static const size_t shapes[3][2] = {{6, 21}, {21, 21}, {21, 3}};
    const hid_t file = create(name, latest);
    list(file, "layer_names", "xabc", 4, 1);
    list(group(file, "x"), "weight_names", "", 0, 1);
    for (int k = 0; k < 3; k++) {
        const char layer[2] = {(char)('a' + k), '\0'};
        char weights[2][16];
        const hid_t outer = group(file, layer);
        const hid_t inner = group(outer, layer);
        snprintf(weights[0], sizeof weights[0], "%s/kernel:0", layer);
        snprintf(weights[1], sizeof weights[1], "%s/bias:0", layer);
        list(outer, "weight_names", weights[0], 2, sizeof weights[0]);
        doubles(inner, "kernel:0", 2, shapes[k], H5T_IEEE_F32LE);
        doubles(inner, "bias:0", 1, &shapes[k][1], H5T_IEEE_F32LE);
        H5Gclose(inner);
        H5Gclose(outer);
    }
    H5Fclose(file);
}

static hid_t chunked(hid_t file, const char *name, int rank, const hsize_t *shape,
                     const hsize_t *chunk, bool sums)
{
    const hid_t space = H5Screate_simple(rank, shape, NULL);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(properties, rank, chunk);
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, 9);
    if (sums) {
        H5Pset_fletcher32(properties);
    }
    const hid_t set =
        H5Dcreate2(file, name, H5T_IEEE_F32LE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    check(set >= 0, "a dataset is made");
    H5Pclose(properties);
    H5Sclose(space);
    return set;
}

/* A table of one channel, of which one chunk is written. */
static void seed_table(void)
{
    const hsize_t shape[4] = {1, 90, 90, 180};
    const hsize_t chunk[4] = {1, 90, 90, 180};
    float *values = calloc(GONIO_BINS, sizeof *values);
    const hid_t file = create("table.h5", false);
    check(values != NULL && gonio_i_hdf_write_string(file, "format", "gonio BRDF table") &&
              gonio_i_hdf_write_number(file, "version", 1),
          "a table is begun");
    for (size_t k = 0; k < GONIO_BINS; k++) {
        values[k] = (float)(k / GONIO_SLAB_BINS);
    }
    const hid_t rho = chunked(file, "rho", 4, shape, chunk, false);
    check(H5Dwrite(rho, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0,
          "a table is written");
    H5Dclose(rho);
    H5Fclose(file);
    free(values);
}

/* A basis of three cells from two materials, in the layout of gonio 0.1.0; its hashes are not
 * right.
 */
static void seed_basis(void)
{
    static const char *const names[] = {"one", "two"};
    static const uint64_t fingerprints[] = {1, 2};
    static const int32_t cells[] = {0, 90, 4000};
    static const char *const hashes[] = {"fingerprint", "checksum", "program", "command"};
    const size_t cell_count = 3;
    const size_t materials = 2;
    const size_t channels = GONIO_CHANNELS;
    const size_t shape[2] = {9, 1};
    double scale[GONIO_CHANNELS];
    const hid_t file = create("basis.gonio", false);
    const hid_t grid = group(file, "grid");
    const hid_t about = group(file, "materials");
    for (int k = 0; k < GONIO_CHANNELS; k++) {
        scale[k] = gonio_log_scale(k);
    }
    bool done = gonio_i_hdf_write_string(file, "format", "gonio basis") &&
                gonio_i_hdf_write_number(file, "format_version", 1) &&
                gonio_i_hdf_write_number(grid, "theta_h_bins", 90) &&
                gonio_i_hdf_write_number(grid, "theta_d_bins", 90) &&
                gonio_i_hdf_write_number(grid, "phi_d_bins", 180) &&
                gonio_i_hdf_write_string(grid, "representation", "bivariate") &&
                gonio_i_hdf_write_string(grid, "channels", "joint");
    for (int k = 0; k < 4; k++) {
        done = done && gonio_i_hdf_write_string(file, hashes[k], "0123456789abcdef");
    }
    done = done &&
           gonio_i_hdf_write_array(grid, "cell", 1, &cell_count, H5T_NATIVE_INT32, H5T_STD_I32LE,
                                   cells) &&
           gonio_i_hdf_write_strings(about, "name", materials, names) &&
           gonio_i_hdf_write_array(about, "fingerprint", 1, &materials, H5T_NATIVE_UINT64,
                                   H5T_STD_U64LE, fingerprints) &&
           gonio_i_hdf_write_array(file, "log_scale", 1, &channels, H5T_NATIVE_DOUBLE,
                                   H5T_IEEE_F64LE, scale);
    check(done, "a basis is written");
    doubles(file, "mean", 1, &shape[0], H5T_IEEE_F64LE);
    doubles(file, "variances", 1, &materials, H5T_IEEE_F64LE);
    doubles(file, "components", 2, shape, H5T_IEEE_F64LE);
    H5Gclose(grid);
    H5Gclose(about);
    H5Fclose(file);
}

/* What the others lack: strings of variable length, many members, checksums. */
static void seed_rest(const char *name, bool latest)
{
    static const char *const words[] = {"one", "and another"};
    const hsize_t count = 2;
    const hsize_t shape[2] = {20, 30};
    const hsize_t chunk[2] = {8, 30};
    const hsize_t whole[2] = {20, 30};
    static float values[600];
    const hid_t file = create(name, latest);
    const hid_t type = H5Tcopy(H5T_C_S1);
    const hid_t space = H5Screate_simple(1, &count, NULL);
    H5Tset_size(type, H5T_VARIABLE);
    const hid_t set =
        H5Dcreate2(file, "variable", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, words) >= 0, "strings are written");
    H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
    const hid_t sum = chunked(file, "sum", 2, shape, latest ? whole : chunk, true);
    check(H5Dwrite(sum, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0,
          "numbers are written");
    H5Dclose(sum);
    for (int k = 0; k < (latest ? 4 : 40); k++) {
        char member[32];
        snprintf(member, sizeof member, "member-%d", k);
        const hid_t made = group(file, member);
        check(gonio_i_hdf_write_number(made, "version", k), "a number is written");
        H5Gclose(made);
    }
    H5Fclose(file);
}

void seed_hdf(void)
{
    seed_network("network.h5", false);
    seed_network("network-latest.h5", true);
    seed_table();
    seed_basis();
    seed_rest("rest.h5", false);
    seed_rest("rest-latest.h5", true);
}
