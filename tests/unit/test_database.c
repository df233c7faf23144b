/* The observation matrix against the materials that it is made of. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "made_material.h"

enum { MATERIALS = 3 };

static const char *const paths[MATERIALS] = {"atlas:gold-polished", "atlas:oak-sawn",
                                             "atlas:burgundy-velvet"};

static gonio_database *make_database(const char *const *files, size_t count,
                                     gonio_representation representation,
                                     gonio_channel_model channels)
{
    const gonio_database_options options = {
        .size = sizeof options, .representation = representation, .channels = channels};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(NULL, files, count, &options, &database), GONIO_OK);
    return database;
}

/* g of a material by the plain way, [cell of the grid][channel], NAN where there is no data. */
static double *plain_log(const char *path, gonio_representation representation)
{
    const bool full = representation == GONIO_FULL;
    const size_t cells = full ? GONIO_BINS : GONIO_CELLS;
    double *rho = malloc(GONIO_SLAB_VALUES * sizeof *rho);
    bool *data = malloc(GONIO_SLAB_BINS * sizeof *data);
    double *g = malloc(cells * GONIO_CHANNELS * sizeof *g);
    gonio_material *material = NULL;
    assert_int_equal(gonio_material_open(NULL, path, &material), GONIO_OK);
    for (int h = 0; h < GONIO_THETA_H_BINS; h++) {
        gonio_slab_statistics statistics;
        assert_int_equal(gonio_material_read_slab(NULL, material, h, rho), GONIO_OK);
        gonio_slab_mask(h, rho, data);
        gonio_slab_to_log(rho, rho);
        gonio_slab_reduce(rho, data, &statistics);
        const size_t slab = cells / GONIO_THETA_H_BINS;
        for (size_t k = 0; k < slab * GONIO_CHANNELS; k++) {
            const size_t cell = k / GONIO_CHANNELS;
            const size_t channel = k % GONIO_CHANNELS;
            const bool present = full ? data[cell] : statistics.count[cell] > 0;
            g[(size_t)h * slab * GONIO_CHANNELS + k] = !present ? NAN
                                                       : full
                                                           ? rho[channel * GONIO_SLAB_BINS + cell]
                                                           : statistics.mean[cell][channel];
        }
    }
    gonio_material_free(&material);
    free(data);
    free(rho);
    return g;
}

/* Rows first .. first + count - 1 of some materials are their g, to float32. */
static void assert_rows(const gonio_database *database, const char *const *files, size_t first,
                        size_t count, const size_t *subset, size_t subset_count)
{
    const gonio_database_view *view = gonio_database_describe(database);
    const bool joint = view->channels == GONIO_JOINT;
    const size_t per_material = joint ? 1 : GONIO_CHANNELS;
    double *block = malloc(per_material * subset_count * count * sizeof *block);
    assert_int_equal(
        gonio_database_read_rows(NULL, database, first, count, subset, subset_count, block),
        GONIO_OK);
    for (size_t j = 0; j < per_material * subset_count; j++) {
        double *g = plain_log(files[subset[j / per_material]], view->representation);
        for (size_t i = 0; i < count; i++) {
            const size_t row = first + i;
            const size_t cell = (size_t)view->cell[joint ? row / GONIO_CHANNELS : row];
            const double expected =
                g[cell * GONIO_CHANNELS + (joint ? row % GONIO_CHANNELS : j % 3)];
            assert_true(fabs(block[j * count + i] - expected) <= 1e-7 * expected);
        }
        free(g);
    }
    free(block);
}

static void test_rows_are_the_materials(void **state)
{
    (void)state;
    static const size_t subset[] = {2, 0};
    for (int full = 0; full < 2; full++) {
        for (int separate = 0; separate < 2; separate++) {
            gonio_database *database = make_database(paths, MATERIALS, (gonio_representation)full,
                                                     (gonio_channel_model)separate);
            const gonio_database_view *view = gonio_database_describe(database);
            const size_t third = view->rows / 3;
            assert_int_equal(view->cells, full ? 1096216 : 8023);
            assert_int_equal(view->rows, separate ? view->cells : 3 * view->cells);
            assert_int_equal(view->columns, separate ? 3 * MATERIALS : MATERIALS);
            assert_rows(database, paths, 0, third - 1, subset, 2);
            assert_rows(database, paths, third - 1, view->rows - third + 1, subset, 2);
            assert_rows(database, paths, third + 5, 1, subset + 1, 1);
            gonio_database_free(&database);
        }
    }
}

static bool is_comb(gonio_bin bin)
{
    return bin.phi_d % 7 == 3 || bin.theta_d == 20;
}

static bool is_low(gonio_bin bin)
{
    return bin.theta_h < 30 || bin.phi_d == 90;
}

/* Two tables with holes of their own; the caller removes the folder. */
static char *write_holes(char names[2][256])
{
    static const made_constant made[2] = {{{1.0, 2.0, 3.0}, is_comb}, {{0.1, 0.2, 0.3}, is_low}};
    char *folder = support_folder();
    for (int k = 0; k < 2; k++) {
        snprintf(names[k], 256, "%s/%c.binary", folder, 'a' + k);
        gonio_material *material = made_material(made[k]);
        assert_int_equal(gonio_material_write_merl(NULL, material, names[k]), GONIO_OK);
        gonio_material_free(&material);
    }
    return folder;
}

static void test_cells_that_some_material_lacks_are_left_out(void **state)
{
    (void)state;
    static const size_t both[] = {0, 1};
    char names[2][256];
    char *folder = write_holes(names);
    const char *const files[2] = {names[0], names[1]};
    for (int separate = 0; separate < 2; separate++) {
        gonio_database *database =
            make_database(files, 2, GONIO_FULL, (gonio_channel_model)separate);
        const gonio_database_view *view = gonio_database_describe(database);
        size_t k = 0;
        for (int32_t index = 0; index < GONIO_BINS; index++) {
            const gonio_bin bin = gonio_bin_from_index(index);
            if (gonio_bin_is_valid(bin) && !is_comb(bin) && !is_low(bin)) {
                assert_true(k < view->cells && view->cell[k] == index);
                k++;
            }
        }
        assert_int_equal(k, view->cells);
        assert_rows(database, files, 1, view->rows - 2, both, 2);
        gonio_database_free(&database);
    }
    support_remove(folder);
}

static void test_what_cannot_be_read(void **state)
{
    (void)state;
    static const size_t no_such[] = {MATERIALS};
    double value = 0.0;
    gonio_context *context = support_context();
    gonio_database *database = make_database(paths, MATERIALS, GONIO_BIVARIATE, GONIO_JOINT);
    const size_t rows = gonio_database_describe(database)->rows;
    assert_int_equal(gonio_database_read_rows(context, database, rows, 1, NULL, 0, &value),
                     GONIO_ERROR_ARGUMENT);
    assert_int_equal(gonio_database_read_rows(context, database, 0, rows + 1, NULL, 0, &value),
                     GONIO_ERROR_ARGUMENT);
    assert_int_equal(gonio_database_read_rows(context, database, 0, 1, no_such, 1, &value),
                     GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(support_message(), "material 3 is outside a database of 3"));
    gonio_database_free(&database);
    const gonio_database_options nowhere = {.size = sizeof nowhere, .scratch = "/nonexistent"};
    assert_int_equal(gonio_database_create(context, paths, MATERIALS, &nowhere, &database),
                     GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), "set TMPDIR"));
    assert_null(database);
    gonio_context_free(&context);
}

/* Materials in memory make the same matrix as the files that they were opened from. */
static void test_materials_in_memory(void **state)
{
    (void)state;
    enum { COUNT = 30 };
    const gonio_database_options how = {.size = sizeof how, .channels = GONIO_SEPARATE};
    gonio_material *material[MATERIALS];
    gonio_database *from_files = make_database(paths, MATERIALS, how.representation, how.channels);
    gonio_database *from_materials = NULL;
    double block[2][COUNT * MATERIALS * GONIO_CHANNELS];
    for (size_t k = 0; k < MATERIALS; k++) {
        assert_int_equal(gonio_material_open(NULL, paths[k], &material[k]), GONIO_OK);
    }
    assert_int_equal(gonio_database_create_from_materials(NULL,
                                                          (const gonio_material *const *)material,
                                                          MATERIALS, &how, &from_materials),
                     GONIO_OK);
    for (size_t k = 0; k < MATERIALS; k++) {
        gonio_material_free(&material[k]);
    }
    const gonio_database_view *a = gonio_database_describe(from_files);
    const gonio_database_view *b = gonio_database_describe(from_materials);
    assert_int_equal(a->rows, b->rows);
    assert_memory_equal(a->fingerprints, b->fingerprints, MATERIALS * sizeof *a->fingerprints);
    for (size_t k = 0; k < MATERIALS; k++) {
        assert_string_equal(a->names[k], b->names[k]);
    }
    assert_int_equal(gonio_database_read_rows(NULL, from_files, 100, COUNT, NULL, 0, block[0]),
                     GONIO_OK);
    assert_int_equal(gonio_database_read_rows(NULL, from_materials, 100, COUNT, NULL, 0, block[1]),
                     GONIO_OK);
    assert_memory_equal(block[0], block[1], sizeof block[0]);
    gonio_database_free(&from_materials);
    gonio_database_free(&from_files);
}

static bool every_bin(gonio_bin bin)
{
    (void)bin;
    return true;
}

static void test_materials_in_memory_that_are_refused(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_material *one = made_material((made_constant){{1.0, 1.0, 1.0}, NULL});
    gonio_material *empty = made_material((made_constant){{1.0, 1.0, 1.0}, every_bin});
    const gonio_material *const twice[2] = {one, one};
    const gonio_material *const nothing[1] = {empty};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create_from_materials(context, twice, 2, NULL, &database),
                     GONIO_ERROR_DATA);
    assert_non_null(strstr(support_message(), "two materials are called 'made'"));
    assert_int_equal(gonio_database_create_from_materials(context, nothing, 1, NULL, &database),
                     GONIO_ERROR_DATA);
    assert_non_null(strstr(support_message(), "made: the material holds no data at all"));
    assert_int_equal(gonio_database_create_from_materials(context, NULL, 0, NULL, &database),
                     GONIO_ERROR_ARGUMENT);
    assert_null(database);
    gonio_material_free(&empty);
    gonio_material_free(&one);
    gonio_context_free(&context);
}

/* A slab in log space, in either mapping, is its bins one by one; in place too. */
static void test_slabs_are_mapped_bin_by_bin(void **state)
{
    (void)state;
    enum { THETA_H = 37 };
    gonio_material *material = NULL;
    double *rho = malloc(2 * GONIO_SLAB_VALUES * sizeof *rho);
    assert_non_null(rho);
    double *g = rho + GONIO_SLAB_VALUES;
    assert_int_equal(gonio_material_open(NULL, "atlas:gold-polished", &material), GONIO_OK);
    for (int m = 0; m < 2; m++) {
        const gonio_mapping mapping = m == 0 ? GONIO_LOG : GONIO_LOG_RELATIVE;
        assert_int_equal(gonio_material_read_slab(NULL, material, THETA_H, rho), GONIO_OK);
        gonio_slab_to_mapped(mapping, THETA_H, rho, g);
        for (int k = 0; k < GONIO_SLAB_VALUES; k++) {
            const gonio_bin bin =
                gonio_bin_from_index(k % GONIO_SLAB_BINS + THETA_H * (int)GONIO_SLAB_BINS);
            const double expected =
                rho[k] < 0.0 ? 0.0
                             : gonio_mapped_from_brdf(mapping, rho[k], k / (int)GONIO_SLAB_BINS,
                                                      gonio_bin_centre(bin));
            assert_true(fabs(g[k] - expected) < 1e-12);
        }
        gonio_slab_to_mapped(mapping, THETA_H, rho, rho);
        assert_memory_equal(rho, g, GONIO_SLAB_VALUES * sizeof *g);
    }
    gonio_material_free(&material);
    free(rho);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_are_the_materials),
        cmocka_unit_test(test_cells_that_some_material_lacks_are_left_out),
        cmocka_unit_test(test_what_cannot_be_read),
        cmocka_unit_test(test_materials_in_memory),
        cmocka_unit_test(test_materials_in_memory_that_are_refused),
        cmocka_unit_test(test_slabs_are_mapped_bin_by_bin),
    };
    return cmocka_run_group_tests_name("database", tests, NULL, NULL);
}
