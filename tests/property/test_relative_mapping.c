/* The bases of published methods, against plain ways to the same numbers: the relative mapping, its
 * medians, loadings. */
#include "../support.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "basis/basis.h"
#include "core/random.h"
#include "methods_fixture.h"

static double weight(gonio_half_difference at)
{
    double incident = 0.0;
    double outgoing = 0.0;
    gonio_cosines(at, &incident, &outgoing);
    return fmin(fmax(incident * outgoing, 0.01), 1.0);
}

static void test_mappings_and_their_inverses(void **state)
{
    (void)state;
    static const double rho[] = {0.0, 1e-6, 0.02, 1.0, 350.0, 1e5};
    double *scale = malloc(GONIO_SLAB_BINS * sizeof *scale);
    for (int32_t index = 0; index < GONIO_BINS; index += 1009) {
        const gonio_bin bin = gonio_bin_from_index(index);
        const gonio_half_difference at = gonio_bin_centre(bin);
        for (size_t k = 0; k < sizeof rho / sizeof *rho && gonio_bin_is_valid(bin); k++) {
            const double g = gonio_mapped_from_brdf(GONIO_LOG_RELATIVE, rho[k], 1, at);
            assert_close(g, log((rho[k] * weight(at) + 0.001) / 0.001), 1e-12);
            assert_close(gonio_brdf_from_mapped(GONIO_LOG_RELATIVE, g, 1, at), rho[k],
                         1e-13 * rho[k]);
            assert_true(gonio_mapped_from_brdf(GONIO_LOG, rho[k], 1, at) ==
                        gonio_log_from_brdf(rho[k], 1));
            assert_close(gonio_brdf_from_mapped(GONIO_LOG, gonio_log_from_brdf(rho[k], 1), 1, at),
                         rho[k], 1e-13 * rho[k]);
        }
        for (int mapping = GONIO_LOG; mapping <= GONIO_LOG_RELATIVE; mapping++) {
            gonio_slab_scale((gonio_mapping)mapping, 2, bin.theta_h, scale);
            const double expected = gonio_mapping_scale((gonio_mapping)mapping, 2, at);
            assert_close(scale[bin.theta_d * GONIO_PHI_D_BINS + bin.phi_d], expected,
                         1e-9 * expected);
        }
    }
    assert_true(gonio_brdf_from_mapped(GONIO_LOG_RELATIVE, -1.0, 0, (gonio_half_difference){0}) ==
                0.0);
    free(scale);
}

/* The relative matrix of both grids against the bins of the materials. */
static void assert_relative_rows(gonio_representation representation)
{
    gonio_database *database = make_database(representation, GONIO_SEPARATE, GONIO_LOG_RELATIVE);
    const gonio_database_view *view = gonio_database_describe(database);
    assert_int_equal(view->mapping, GONIO_LOG_RELATIVE);
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    double row[MOST];
    assert_int_equal(gonio_material_open(NULL, paths[0], &material), GONIO_OK);
    assert_int_equal(gonio_table_load(NULL, material, &table), GONIO_OK);
    for (size_t i = 0; i < view->cells; i += view->cells / 97) {
        const bool full = representation == GONIO_FULL;
        const gonio_bin first = gonio_bin_from_index(view->cell[i] * (full ? 1 : GONIO_PHI_D_BINS));
        double sum = 0.0;
        int bins = 0;
        for (int p = first.phi_d; p < (full ? first.phi_d + 1 : GONIO_PHI_D_BINS); p++) {
            const gonio_bin bin = {first.theta_h, first.theta_d, p};
            double rho[GONIO_CHANNELS];
            if (gonio_bin_is_valid(bin) && gonio_table_value(table, gonio_bin_centre(bin), rho)) {
                sum += log((rho[1] * weight(gonio_bin_centre(bin)) + 0.001) / 0.001);
                bins++;
            }
        }
        assert_int_equal(gonio_database_read_rows(NULL, database, i, 1, NULL, 0, row), GONIO_OK);
        assert_close(row[1], sum / bins, 2e-6);
    }
    gonio_table_free(&table);
    gonio_material_free(&material);
    gonio_database_free(&database);
}

static void test_relative_rows(void **state)
{
    (void)state;
    assert_relative_rows(GONIO_BIVARIATE);
    assert_relative_rows(GONIO_FULL);
}

static int compare_values(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Without mean, a row of the relative mapping is relative to its median over what is learned from:
 * an odd and an even number of columns, and a subset. */
static void test_medians_of_what_is_learned(void **state)
{
    (void)state;
    static const size_t subset[] = {5, 0, 3, 6};
    gonio_database *database = make_database(GONIO_BIVARIATE, GONIO_SEPARATE, GONIO_LOG_RELATIVE);
    for (size_t count = 3; count <= 4; count++) {
        const gonio_basis_options options = {
            .size = sizeof options, .subset = subset, .subset_count = count, .without_mean = true};
        gonio_basis *basis = NULL;
        assert_int_equal(gonio_basis_learn(NULL, database, &options, &basis), GONIO_OK);
        const gonio_basis_view *view = gonio_basis_describe(basis);
        assert_int_equal(view->components, 3 * count);
        assert_int_equal(view->columns, 3 * count);
        assert_int_equal(view->variance_count, 3 * count);
        for (size_t i = 0; i < view->rows; i += 211) {
            double x[MOST];
            assert_int_equal(gonio_database_read_rows(NULL, database, i, 1, subset, count, x),
                             GONIO_OK);
            for (size_t j = 0; j < 3 * count; j++) {
                x[j] = 0.001 * expm1(x[j]); /* rho w */
            }
            qsort(x, 3 * count, sizeof *x, compare_values);
            const double median = 0.5 * (x[(3 * count - 1) / 2] + x[3 * count / 2]);
            assert_close(view->mean[i], log((median + 0.001) / 0.001), 1e-12);
        }
        gonio_basis_free(&basis);
    }
    gonio_database_free(&database);
}

/* H - m = V S W' with all components, W'W = I. */
static void test_loadings(void **state)
{
    (void)state;
    for (int without_mean = 0; without_mean < 2; without_mean++) {
        gonio_database *database = make_database(GONIO_BIVARIATE, GONIO_JOINT, GONIO_LOG);
        const gonio_basis_options options = {.size = sizeof options, .without_mean = without_mean};
        gonio_basis *basis = NULL;
        double *vectors = NULL; /* before they are rounded */
        assert_int_equal(gonio_i_basis_learn_exact(NULL, database, &options, &basis, &vectors),
                         GONIO_OK);
        assert_int_equal(gonio_i_basis_finish(NULL, basis), GONIO_OK);
        const gonio_basis_view *view = gonio_basis_describe(basis);
        const size_t k = view->components;
        assert_int_equal(k, without_mean ? MATERIALS : MATERIALS - 1);
        for (size_t i = 0; i < view->rows; i += 97) {
            double h[MATERIALS];
            assert_int_equal(gonio_database_read_rows(NULL, database, i, 1, NULL, 0, h), GONIO_OK);
            assert_true(!without_mean || view->mean[i] == 0.0);
            for (size_t column = 0; column < MATERIALS; column++) {
                double sum = view->mean[i];
                for (size_t j = 0; j < k; j++) {
                    sum += vectors[i * k + j] * gonio_basis_singular_value(basis, j) *
                           view->loadings[column * k + j];
                }
                assert_close(sum, h[column], 1e-9);
            }
        }
        free(vectors);
        for (size_t a = 0; a < k * k; a++) {
            double sum = 0.0;
            for (size_t column = 0; column < MATERIALS; column++) {
                sum += view->loadings[column * k + a / k] * view->loadings[column * k + a % k];
            }
            assert_close(sum, a / k == a % k ? 1.0 : 0.0, 1e-12);
        }
        gonio_basis_free(&basis);
        gonio_database_free(&database);
    }
}

static void test_every_kind_has_a_fingerprint_of_its_own(void **state)
{
    (void)state;
    uint64_t seen[4];
    for (size_t kind = 0; kind < 4; kind++) {
        gonio_basis *basis = learn(GONIO_JOINT, (gonio_mapping)(kind % 2),
                                   (gonio_basis_options){.size = sizeof(gonio_basis_options),
                                                         .components = 2,
                                                         .without_mean = kind > 1});
        seen[kind] = gonio_basis_describe(basis)->fingerprint;
        for (size_t j = 0; j < kind; j++) {
            assert_true(seen[j] != seen[kind]);
        }
        gonio_basis_free(&basis);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mappings_and_their_inverses),
        cmocka_unit_test(test_relative_rows),
        cmocka_unit_test(test_medians_of_what_is_learned),
        cmocka_unit_test(test_loadings),
        cmocka_unit_test(test_every_kind_has_a_fingerprint_of_its_own),
    };
    return cmocka_run_group_tests_name("relative mapping", tests, set_up, tear_down);
}
