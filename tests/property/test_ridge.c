/* Ridge regression against its normal equations, and readings of known materials. */
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

/* (Q'Q + eta I) c = Q'b. */
static void test_ridge_solves_the_normal_equations(void **state)
{
    const fixture *f = *state;
    const gonio_basis_view *view = gonio_basis_describe(f->relative);
    gonio_i_random random;
    gonio_i_random_seed(&random, 3, 0);
    for (size_t count = 3; count <= 30; count += 9) {
        const size_t k = count < view->components ? count : view->components;
        const double eta = count == 3 ? 0.0 : 0.01 * (double)(count * count); /* 0 is 40 */
        size_t rows[30];
        double b[GONIO_CHANNELS * 30];
        for (size_t i = 0; i < count; i++) {
            rows[i] = (size_t)gonio_i_random_below(&random, view->rows);
        }
        for (size_t i = 0; i < GONIO_CHANNELS * count; i++) {
            b[i] = 5.0 * gonio_i_random_uniform(&random);
        }
        const gonio_reconstruct_options options = {
            .size = sizeof options, .method = "ridge", .eta = eta};
        gonio_reconstruction *r = NULL;
        assert_int_equal(
            gonio_reconstruct_rows_with(f->context, f->relative, &options, rows, count, b, &r),
            GONIO_OK);
        assert_int_equal(r->components, k);
        for (size_t column = 0; column < GONIO_CHANNELS; column++) {
            double a[MOST * MOST] = {0};
            double c[MOST] = {0};
            for (size_t p = 0; p < k; p++) {
                a[p * k + p] = eta > 0.0 ? eta : 40.0;
            }
            for (size_t i = 0; i < count; i++) {
                double v[MOST];
                assert_int_equal(gonio_basis_rows(f->context, f->relative, rows[i], 1, k, v),
                                 GONIO_OK);
                for (size_t p = 0; p < k; p++) {
                    const double left = v[p] * gonio_basis_singular_value(f->relative, p);
                    c[p] += left * (b[column * count + i] - view->mean[rows[i]]);
                    for (size_t j = 0; j < k; j++) {
                        a[p * k + j] += left * v[j] * gonio_basis_singular_value(f->relative, j);
                    }
                }
            }
            eliminate(k, a, c);
            for (size_t p = 0; p < k; p++) {
                const double expected = c[p] * gonio_basis_singular_value(f->relative, p);
                assert_close(r->coefficients[column * k + p], expected,
                             1e-8 * (1.0 + fabs(expected)));
            }
        }
        gonio_reconstruction_free(&r);
    }
}

static void test_what_ridge_refuses(void **state)
{
    const fixture *f = *state;
    enum { size = sizeof(gonio_reconstruct_options) };
    const size_t row = 5;
    const double b[GONIO_CHANNELS] = {1.0, 1.0, 1.0};
    static const struct {
        gonio_reconstruct_options options;
        const char *message;
    } cases[] = {
        {{.size = size, .method = "lasso"}, "no reconstruction method is called 'lasso'"},
        {{.size = size, .method = "ridge", .eta = -1.0}, "eta must be above 0"},
        {{.size = size, .method = "ridge", .eta = INFINITY}, "eta must be above 0"},
        {{.size = size, .method = "ridge", .components = 13},
         "13 components asked for, but the basis has 12"},
    };
    gonio_reconstruction *r = NULL;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_int_equal(
            gonio_reconstruct_rows_with(f->context, f->relative, &cases[k].options, &row, 1, b, &r),
            GONIO_ERROR_ARGUMENT);
        assert_non_null(strstr(support_message(), cases[k].message));
        assert_null(r);
    }
    assert_string_equal(gonio_reconstruct_method_name(1), "ridge");
    assert_string_equal(gonio_reconstruct_method_name(2), "posterior");
    assert_null(gonio_reconstruct_method_name(3));
    assert_true(gonio_reconstruct_method_suits_mixtures("posterior"));
    assert_false(gonio_reconstruct_method_suits_mixtures("ridge"));
    assert_false(gonio_reconstruct_method_suits_mixtures("none"));
    assert_null(gonio_reconstruct_method_summary(-1));
}

/* Cell by cell what the database has of the material. */
static void test_material_rows_are_the_databases(void **state)
{
    const fixture *f = *state;
    for (int kind = GONIO_BIVARIATE; kind <= GONIO_SECTORED; kind++) {
        const gonio_mapping mapping = kind == GONIO_SECTORED ? GONIO_LOG : GONIO_LOG_RELATIVE;
        gonio_database *database =
            make_database((gonio_representation)kind, GONIO_SEPARATE, mapping);
        gonio_basis *basis = NULL;
        const gonio_basis_options options = {.size = sizeof options, .components = 3};
        gonio_material *material = NULL;
        size_t rows[11];
        double b[GONIO_CHANNELS * 11];
        double h[MOST];
        assert_int_equal(gonio_basis_learn(NULL, database, &options, &basis), GONIO_OK);
        assert_int_equal(gonio_material_open(NULL, paths[2], &material), GONIO_OK);
        for (size_t i = 0; i < 11; i++) { /* in no order, one twice */
            rows[i] = (i % 10) * 7919 * 104729 % gonio_basis_describe(basis)->rows;
        }
        assert_int_equal(gonio_material_rows(f->context, basis, material, rows, 11, b), GONIO_OK);
        for (size_t i = 0; i < 11; i++) {
            assert_int_equal(gonio_database_read_rows(NULL, database, rows[i], 1, NULL, 0, h),
                             GONIO_OK);
            for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
                assert_close(b[channel * 11 + i], h[3 * 2 + channel], 2e-6);
            }
        }
        gonio_material_free(&material);
        gonio_basis_free(&basis);
        gonio_database_free(&database);
    }
}

/* All channels of few directions determine as much as the same rows given one by one. */
static void test_all_channels_of_a_known_material(void **state)
{
    const fixture *f = *state;
    size_t few[4] = {30, 9000, 31, 15001};
    size_t all[9] = {30, 31, 32, 9000, 9001, 9002, 15000, 15001, 15002};
    const gonio_reconstruct_options more = {.size = sizeof more, .all_channels = true};
    gonio_material *original = NULL;
    gonio_material *a = NULL;
    gonio_material *b = NULL;
    gonio_comparison comparison;
    assert_int_equal(gonio_material_open(NULL, "atlas:gold-leaf", &original), GONIO_OK);
    assert_int_equal(gonio_reconstruct_material(f->context, f->plain, original, few, 4, NULL, &a),
                     GONIO_ERROR_UNDETERMINED);
    assert_int_equal(gonio_reconstruct_material(f->context, f->plain, original, few, 4, &more, &a),
                     GONIO_OK);
    assert_int_equal(gonio_reconstruct_material(f->context, f->plain, original, all, 9, NULL, &b),
                     GONIO_OK);
    assert_int_equal(gonio_compare(NULL, a, b, &comparison), GONIO_OK);
    assert_true(comparison.all.value[GONIO_E6] < 1e-9);
    gonio_material_free(&a);
    gonio_material_free(&b);
    gonio_material_free(&original);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ridge_solves_the_normal_equations),
        cmocka_unit_test(test_what_ridge_refuses),
        cmocka_unit_test(test_material_rows_are_the_databases),
        cmocka_unit_test(test_all_channels_of_a_known_material),
    };
    return cmocka_run_group_tests_name("ridge", tests, set_up, tear_down);
}
