/* Rows of a basis: by number, at any direction, and of the nearest cell where there is no data. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "core/random.h"
#include "learned_basis.h"
#include "made_material.h"

static void test_row_at_a_centre_is_the_cells_own(void **state)
{
    (void)state;
    gonio_database *database = make_database(NULL, 3, GONIO_BIVARIATE, GONIO_JOINT);
    gonio_basis *basis = learn(NULL, database, 2);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    double *vectors = support_vectors(basis);
    for (size_t position = 0; position < view->cells; position += 17) {
        const int32_t cell = view->cell[position];
        const gonio_bin bin = {cell / GONIO_THETA_D_BINS, cell % GONIO_THETA_D_BINS, 50};
        assert_int_equal(gonio_basis_position(basis, cell), position);
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            const size_t row = 3 * position + (size_t)channel;
            double mean = 0.0;
            double found[2];
            gonio_basis_row_at(basis, gonio_bin_centre(bin), channel, 2, &mean, found);
            assert_close(mean, view->mean[row], 1e-11);
            assert_close(found[0], vectors[2 * row], 1e-13);
            assert_close(found[1], vectors[2 * row + 1], 1e-13);
        }
    }
    free(vectors);
    /* Half way between two centres: their average. */
    const gonio_half_difference a = gonio_bin_centre((gonio_bin){20, 30, 0});
    const gonio_half_difference b = gonio_bin_centre((gonio_bin){20, 31, 0});
    double mean[3], rows[3];
    gonio_basis_row_at(basis, a, 1, 1, &mean[0], &rows[0]);
    gonio_basis_row_at(basis, b, 1, 1, &mean[1], &rows[1]);
    gonio_basis_row_at(basis,
                       (gonio_half_difference){a.theta_h, 0.5 * (a.theta_d + b.theta_d), 1.0}, 1, 1,
                       &mean[2], &rows[2]);
    assert_close(mean[2], 0.5 * (mean[0] + mean[1]), 1e-12);
    assert_close(rows[2], 0.5 * (rows[0] + rows[1]), 1e-14);
    gonio_basis_free(&basis);
    gonio_database_free(&database);
}

/* Squared distance in index space, phi_d periodic. */
static int distance(gonio_bin a, gonio_bin b)
{
    const int h = a.theta_h - b.theta_h;
    const int d = a.theta_d - b.theta_d;
    const int p = abs(a.phi_d - b.phi_d);
    const int turn = p < GONIO_PHI_D_BINS - p ? p : GONIO_PHI_D_BINS - p;
    return h * h + d * d + turn * turn;
}

/* The nearest cell, lowest position first, by looking at all of them. */
static size_t nearest(const gonio_basis_view *view, gonio_bin bin)
{
    const int depth = view->representation == GONIO_FULL ? 1 : GONIO_PHI_D_BINS;
    size_t best = 0;
    int least = 1 << 30;
    for (size_t k = 0; k < view->cells; k++) {
        const int found = distance(bin, gonio_bin_from_index(view->cell[k] * depth));
        if (found < least) {
            best = k;
            least = found;
        }
    }
    return best;
}

/* Looks at cells without data: there the nearest with data stands in. */
static void assert_nearest(gonio_representation representation, const char *const *files,
                           int trials)
{
    const bool full = representation == GONIO_FULL;
    const gonio_database_options options = {.size = sizeof options,
                                            .representation = representation};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(NULL, files, 2, &options, &database), GONIO_OK);
    gonio_basis *basis = learn(NULL, database, 1);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const int depth = full ? 1 : GONIO_PHI_D_BINS;
    gonio_i_random random;
    gonio_i_random_seed(&random, 9, 0);
    while (trials > 0) {
        const int32_t cell =
            (int32_t)gonio_i_random_below(&random, full ? GONIO_BINS : GONIO_CELLS);
        const size_t found = gonio_basis_position(basis, cell);
        if (view->cell[found] != cell) {
            assert_int_equal(found, nearest(view, gonio_bin_from_index(cell * depth)));
            trials--;
        }
    }
    gonio_basis_free(&basis);
    gonio_database_free(&database);
}

static bool is_scattered_hole(gonio_bin bin)
{
    return bin.phi_d < 3 || bin.phi_d > 120 || (bin.theta_h + 3 * bin.theta_d) % 5 > 1;
}

static void test_cells_without_data_have_the_nearest(void **state)
{
    (void)state;
    char *folder = support_folder();
    char a[256], b[256];
    const char *const holes[2] = {a, b};
    snprintf(a, sizeof a, "%s/a.binary", folder);
    snprintf(b, sizeof b, "%s/b.binary", folder);
    for (int k = 0; k < 2; k++) {
        gonio_material *material =
            made_material((made_constant){{1.0 + k, 1.0, 1.0}, is_scattered_hole});
        assert_int_equal(gonio_material_write_merl(NULL, material, holes[k]), GONIO_OK);
        gonio_material_free(&material);
    }
    assert_nearest(GONIO_BIVARIATE, paths, 60);
    assert_nearest(GONIO_FULL, paths, 60);
    assert_nearest(GONIO_BIVARIATE, holes, 500);
    assert_nearest(GONIO_FULL, holes, 200);
    support_remove(folder);
}

static void test_rows_that_a_basis_does_not_have(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_database *database = make_database(NULL, 3, GONIO_BIVARIATE, GONIO_JOINT);
    gonio_basis *basis = learn(NULL, database, 2);
    const size_t rows = gonio_basis_describe(basis)->rows;
    const struct {
        size_t first, count, components;
    } wrong[] = {{rows, 1, 2}, {0, rows + 1, 2}, {rows - 1, 2, 1}, {rows + 1, 0, 1}, {0, 1, 3}};
    double *all = support_vectors(basis);
    double few[3] = {7.0, 7.0, 7.0};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_equal(gonio_basis_rows(context, basis, wrong[k].first, wrong[k].count,
                                          wrong[k].components, few),
                         GONIO_ERROR_ARGUMENT);
        assert_non_null(strstr(support_message(), "but the basis has 2 components"));
        assert_true(few[0] == 7.0);
    }
    assert_int_equal(gonio_basis_rows(context, basis, rows - 2, 2, 1, few), GONIO_OK);
    assert_true(few[0] == all[2 * rows - 4] && few[1] == all[2 * rows - 2] && few[2] == 7.0);
    assert_int_equal(gonio_basis_rows(context, basis, rows, 0, 2, few), GONIO_OK);
    free(all);
    gonio_basis_free(&basis);
    gonio_database_free(&database);
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_that_a_basis_does_not_have),
        cmocka_unit_test(test_row_at_a_centre_is_the_cells_own),
        cmocka_unit_test(test_cells_without_data_have_the_nearest),
    };
    return cmocka_run_group_tests_name("basis rows", tests, NULL, NULL);
}
