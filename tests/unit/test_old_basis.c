/* Bases of older programs, which are HDF5: converted to today's format; refused where they were
 * changed. */
#include "../support.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "basis/basis.h"
#include "core/hdf_write.h"

enum { MATERIALS = 3 };

static const char *const paths[MATERIALS] = {"atlas:gold-polished", "atlas:red-glossy-plastic",
                                             "atlas:burgundy-velvet"};

/* A basis, and V as it was computed. */
typedef struct learned {
    gonio_basis *basis;
    const gonio_basis_view *view;
    double *vectors;
} learned;

static learned learn(gonio_channel_model channels)
{
    const gonio_database_options options = {
        .size = sizeof options, .representation = GONIO_BIVARIATE, .channels = channels};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(NULL, paths, MATERIALS, &options, &database), GONIO_OK);
    const gonio_basis_options wanted = {.size = sizeof wanted, .components = 2};
    learned made = {0};
    gonio_basis *exact = NULL;
    assert_int_equal(gonio_basis_learn(NULL, database, &wanted, &made.basis), GONIO_OK);
    assert_int_equal(gonio_i_basis_learn_exact(NULL, database, &wanted, &exact, &made.vectors),
                     GONIO_OK);
    made.view = gonio_basis_describe(made.basis);
    gonio_basis_free(&exact);
    gonio_database_free(&database);
    return made;
}

static void learned_free(learned *made)
{
    free(made->vectors);
    gonio_basis_free(&made->basis);
}

/* The checksum of older files, whose V is in double precision. */
static uint64_t old_checksum(const learned *made)
{
    const gonio_basis_view *view = made->view;
    const int32_t kind[2] = {(int32_t)view->representation, (int32_t)view->channels};
    gonio_fingerprint *all = NULL;
    assert_int_equal(gonio_fingerprint_create(&all), GONIO_OK);
    gonio_fingerprint_add(all, kind, sizeof kind);
    gonio_fingerprint_add(all, view->cell, view->cells * sizeof *view->cell);
    gonio_fingerprint_add(all, view->mean, view->rows * sizeof *view->mean);
    gonio_fingerprint_add(all, made->vectors,
                          view->rows * view->components * sizeof *made->vectors);
    gonio_fingerprint_add(all, view->variances, view->variance_count * sizeof *view->variances);
    const uint64_t value = gonio_fingerprint_value(all);
    gonio_fingerprint_free(&all);
    return value;
}

static void write_hash(hid_t file, const char *name, uint64_t value)
{
    char text[32];
    snprintf(text, sizeof text, "%016" PRIx64, value);
    assert_true(gonio_i_hdf_write_string(file, name, text));
}

static void write_doubles(hid_t file, const char *name, int rank, const size_t *shape,
                          const double *values)
{
    assert_true(gonio_i_hdf_write_array(file, name, rank, shape, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE,
                                        values));
}

static void write_groups(hid_t file, const gonio_basis_view *view)
{
    const hid_t grid = H5Gcreate2(file, "grid", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t materials = H5Gcreate2(file, "materials", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(gonio_i_hdf_write_number(grid, "theta_h_bins", GONIO_THETA_H_BINS));
    assert_true(gonio_i_hdf_write_number(grid, "theta_d_bins", GONIO_THETA_D_BINS));
    assert_true(gonio_i_hdf_write_number(grid, "phi_d_bins", GONIO_PHI_D_BINS));
    assert_true(gonio_i_hdf_write_string(grid, "representation", "bivariate"));
    assert_true(gonio_i_hdf_write_string(grid, "channels",
                                         view->channels == GONIO_JOINT ? "joint" : "separate"));
    assert_true(gonio_i_hdf_write_array(grid, "cell", 1, &view->cells, H5T_NATIVE_INT32,
                                        H5T_STD_I32LE, view->cell));
    assert_true(gonio_i_hdf_write_strings(materials, "name", view->materials, view->names));
    assert_true(gonio_i_hdf_write_array(materials, "fingerprint", 1, &view->materials,
                                        H5T_NATIVE_UINT64, H5T_STD_U64LE, view->fingerprints));
    H5Gclose(materials);
    H5Gclose(grid);
}

/* The layout of gonio 0.1.0, without what later programs added. */
static void write_old(const learned *made, const char *path)
{
    const gonio_basis_view *view = made->view;
    const size_t shape[2] = {view->rows, view->components};
    const size_t channels = GONIO_CHANNELS;
    double scale[GONIO_CHANNELS];
    for (int k = 0; k < GONIO_CHANNELS; k++) {
        scale[k] = gonio_log_scale(k);
    }
    gonio_i_hdf_session session;
    assert_int_equal(gonio_i_hdf_load(NULL), GONIO_OK);
    gonio_i_hdf_enter(&session);
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(file >= 0);
    assert_true(gonio_i_hdf_write_string(file, "format", "gonio basis"));
    assert_true(gonio_i_hdf_write_number(file, "format_version", 1));
    assert_true(gonio_i_hdf_write_string(file, "program", "gonio 0.1.0"));
    assert_true(gonio_i_hdf_write_string(file, "command", "gonio learn of old"));
    write_hash(file, "fingerprint", view->fingerprint);
    write_hash(file, "checksum", old_checksum(made));
    write_groups(file, view);
    write_doubles(file, "log_scale", 1, &channels, scale);
    write_doubles(file, "mean", 1, &view->rows, view->mean);
    write_doubles(file, "components", 2, shape, made->vectors);
    write_doubles(file, "variances", 1, &view->variance_count, view->variances);
    H5Fclose(file);
    gonio_i_hdf_leave(&session);
}

static void test_an_old_basis_is_converted(void **state)
{
    (void)state;
    static const gonio_channel_model models[] = {GONIO_JOINT, GONIO_SEPARATE};
    char *folder = support_folder();
    char old[256];
    char new[256];
    snprintf(old, sizeof old, "%s/old.gonio", folder);
    snprintf(new, sizeof new, "%s/new.gonio", folder);
    for (int m = 0; m < 2; m++) {
        learned made = learn(models[m]);
        gonio_basis *converted = NULL;
        write_old(&made, old);
        assert_int_equal(gonio_basis_convert(NULL, old, new), GONIO_OK);
        assert_int_equal(gonio_basis_read(NULL, new, &converted), GONIO_OK);
        const gonio_basis_view *view = gonio_basis_describe(converted);
        assert_true(view->fingerprint == made.view->fingerprint);
        assert_string_equal(view->command, "gonio learn of old");
        assert_memory_equal(view->mean, made.view->mean, view->rows * sizeof *view->mean);
        double *vectors[2] = {support_vectors(made.basis), support_vectors(converted)};
        assert_memory_equal(vectors[0], vectors[1],
                            view->rows * view->components * sizeof *vectors[0]);
        free(vectors[0]);
        free(vectors[1]);
        gonio_basis_free(&converted);
        learned_free(&made);
    }
    support_remove(folder);
}

static void test_what_is_not_converted(void **state)
{
    (void)state;
    char *folder = support_folder();
    char old[256];
    char new[256];
    snprintf(old, sizeof old, "%s/old.gonio", folder);
    snprintf(new, sizeof new, "%s/new.gonio", folder);
    learned made = learn(GONIO_JOINT);
    assert_int_equal(gonio_basis_write(NULL, made.basis, NULL, old), GONIO_OK);
    assert_int_equal(gonio_basis_convert(NULL, old, new), GONIO_ERROR_FORMAT); /* of today */
    made.vectors[7] += 1e-9; /* the checksum knows another number */
    write_old(&made, old);
    made.vectors[7] -= 1e-9;
    gonio_i_hdf_session session;
    assert_int_equal(gonio_i_hdf_load(NULL), GONIO_OK);
    gonio_i_hdf_enter(&session);
    const hid_t file = H5Fopen(old, H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t data = H5Dopen2(file, "components", H5P_DEFAULT);
    assert_true(H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, made.vectors) >=
                0);
    H5Dclose(data);
    H5Fclose(file);
    gonio_i_hdf_leave(&session);
    assert_int_equal(gonio_basis_convert(NULL, old, new), GONIO_ERROR_FORMAT);
    FILE *none = fopen(new, "rb");
    assert_null(none);
    learned_free(&made);
    support_remove(folder);
}

int GONIO_TEST(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_old_basis_is_converted),
        cmocka_unit_test(test_what_is_not_converted),
    };
    return cmocka_run_group_tests_name("old_basis", tests, NULL, NULL);
}
