/* What columns share gives what each would find by itself: sums over the grid without Q, and fields
 * as combinations of a few. */
#include "posterior_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "posterior/combinations.h"
#include "posterior/fields.h"
#include "posterior/variance.h"

enum { SITES = 9, VECTORS = 50, SIZE = 20, SHAPES = 6, COLUMNS = 120 };

/* ---- sums over the grid ---- */

/* The sums of a fit, by Q if `covariance` is given and without it otherwise. */
static gonio_i_variance_sums sums_of(const gonio_i_fit *e, const gonio_i_rows *rows,
                                     double *covariance)
{
    gonio_i_variance_sums sums = {0};
    double *c = calloc(e->components, sizeof *c);
    gonio_i_fit_coefficients(e, c);
    assert_int_equal(gonio_i_variance_find(e, rows, c, NULL, covariance, &sums), GONIO_OK);
    free(c);
    return sums;
}

static void compare_sums(const gonio_i_prior *prior, const gonio_i_model *model, size_t readings)
{
    drawn d = draw(5, 0.1);
    const gonio_i_column column = {readings, d.reading};
    gonio_i_sites *sites = NULL;
    gonio_i_rows *rows = NULL;
    gonio_i_targets targets;
    gonio_i_fit e = begin_fit(prior, &column, &sites);
    double *covariance = calloc(prior->components * prior->components, sizeof *covariance);
    assert_int_equal(gonio_i_fit_solve(&e, model), GONIO_OK);
    assert_int_equal(gonio_i_targets_create(fixture.context, prior, NULL, 0, &targets), GONIO_OK);
    assert_int_equal(gonio_i_rows_create(fixture.context, sites, model, &targets, false, &rows),
                     GONIO_OK);
    const gonio_i_variance_sums with = sums_of(&e, rows, covariance);
    const gonio_i_variance_sums without = sums_of(&e, rows, NULL);
    /* What is left is a small part of what is taken out, so that digits are lost. */
    assert_close(without.error, with.error, 1e-7 * with.error);
    assert_true(without.square == with.square && without.bins == with.bins);
    gonio_i_rows_free(&rows);
    gonio_i_targets_free(&targets);
    end_fit(&e, &sites);
    free(covariance);
    free(d.z);
}

/* Of Gaussians and mixtures, with and without a remainder, of one reading and of many. */
static void test_sums(void **state)
{
    (void)state;
    const gonio_i_model models[] = {{0.7, 0.1, 0.0, 0.0},
                                    {0.7, 0.0, 0.0, 0.0},
                                    {0.9, 0.25, 8.0, 0.0},
                                    {1.0, 0.1, 0.0, 0.0},
                                    {1.0, 0.0, 0.0, 0.0}};
    for (size_t k = 0; k < sizeof models / sizeof *models; k++) {
        compare_sums(fixture.mixture, &models[k], SITES);
        compare_sums(fixture.mixture, &models[k], 1);
        compare_sums(fixture.gaussian, &models[k], MOST);
    }
}

/* ---- combinations ---- */

static void draw_vectors(size_t shapes, double noise, double *vector)
{
    gonio_i_random random;
    double shape[SHAPES * SIZE];
    gonio_i_random_seed(&random, 1, 0);
    for (size_t k = 0; k < SHAPES * SIZE; k++) {
        shape[k] = gonio_i_random_normal(&random);
    }
    for (size_t j = 0; j < VECTORS; j++) {
        double *v = vector + j * SIZE;
        for (size_t i = 0; i < SIZE; i++) {
            v[i] = noise * gonio_i_random_normal(&random);
        }
        for (size_t k = 0; k < shapes; k++) {
            const double weight = gonio_i_random_normal(&random);
            for (size_t i = 0; i < SIZE; i++) {
                v[i] += weight * shape[k * SIZE + i];
            }
        }
    }
}

/* The few are orthonormal, and every vector is their combination to the tolerance. */
static void test_combinations(void **state)
{
    (void)state;
    const double tolerance = 1e-3;
    double vector[VECTORS * SIZE];
    double given[VECTORS * SIZE];
    gonio_i_combinations c;
    draw_vectors(SHAPES, 1e-5, vector);
    memcpy(given, vector, sizeof given);
    assert_int_equal(
        gonio_i_combinations_find(fixture.context, vector, VECTORS, SIZE, tolerance, SIZE, &c),
        GONIO_OK);
    assert_int_equal(c.count, SHAPES);
    for (size_t k = 0; k < c.count * c.count; k++) {
        double dot = 0.0;
        for (size_t i = 0; i < SIZE; i++) {
            dot += c.few[k / c.count * SIZE + i] * c.few[k % c.count * SIZE + i];
        }
        assert_close(dot, k / c.count == k % c.count ? 1.0 : 0.0, 1e-12);
    }
    for (size_t j = 0; j < VECTORS; j++) {
        double square = 0.0;
        for (size_t i = 0; i < SIZE; i++) {
            double left = given[j * SIZE + i];
            for (size_t k = 0; k < c.count; k++) {
                left -= c.weight[j * c.count + k] * c.few[k * SIZE + i];
            }
            assert_close(left, vector[j * SIZE + i], 1e-12);
            square += left * left;
        }
        assert_true(sqrt(square) <= tolerance);
    }
    gonio_i_combinations_release(&c);
}

/* Vectors without common shapes are not made combinations. */
static void test_too_many_shapes(void **state)
{
    (void)state;
    double vector[VECTORS * SIZE];
    gonio_i_combinations c;
    draw_vectors(0, 1.0, vector);
    assert_int_equal(
        gonio_i_combinations_find(fixture.context, vector, VECTORS, SIZE, 1e-3, SIZE / 2, &c),
        GONIO_OK);
    assert_int_equal(c.count, 0);
    gonio_i_combinations_release(&c);
}

/* ---- fields ---- */

typedef struct field_set {
    double *terms;
    double *field;
    gonio_i_field_column column[COLUMNS];
} field_set;

/* Columns whose terms are mixed of a few, with noise. */
static field_set make_fields(const gonio_i_sites *sites, double noise)
{
    const size_t size = gonio_i_terms(sites);
    const size_t rows = sites->prior->view->rows;
    gonio_i_random random;
    field_set s = {.terms = calloc(COLUMNS * size, sizeof(double)),
                   .field = calloc(COLUMNS * rows, sizeof(double))};
    gonio_i_random_seed(&random, 2, 0);
    for (size_t j = 0; j < COLUMNS; j++) {
        for (size_t i = 0; i < size; i++) {
            const double at = (double)j / COLUMNS;
            s.terms[j * size + i] = sin(3.0 * at) * cos((double)i) + at * sin(2.0 * (double)i) +
                                    noise * gonio_i_random_normal(&random);
        }
        s.column[j] = (gonio_i_field_column){s.terms + j * size, s.field + j * rows};
    }
    return s;
}

/* The field of many columns is that of each by itself, to the tolerance if they are combinations
 * and to the bit if they are not. */
static void test_fields(void **state)
{
    (void)state;
    const double noise[] = {1e-9, 1.0};
    const double tolerance[] = {1e-6, 0.0};
    drawn d = draw(6, 0.1);
    const gonio_i_column column = {SITES, d.reading};
    gonio_i_sites *sites = NULL;
    const size_t rows = fixture.gaussian->view->rows;
    double *alone = calloc(rows, sizeof *alone);
    assert_int_equal(gonio_i_sites_create(fixture.context, fixture.gaussian, &column, &sites),
                     GONIO_OK);
    for (int k = 0; k < 2; k++) {
        field_set s = make_fields(sites, noise[k]);
        assert_int_equal(gonio_i_fields_fill(fixture.context, sites, s.column, COLUMNS), GONIO_OK);
        for (size_t j = 0; j < COLUMNS; j += 17) {
            const gonio_i_field_column one = {s.column[j].terms, alone};
            assert_int_equal(gonio_i_fields_fill(fixture.context, sites, &one, 1), GONIO_OK);
            for (size_t row = 0; row < rows; row++) {
                assert_close(s.field[j * rows + row], alone[row], tolerance[k]);
            }
        }
        free(s.terms);
        free(s.field);
    }
    gonio_i_sites_free(&sites);
    free(alone);
    free(d.z);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sums),
        cmocka_unit_test(test_combinations),
        cmocka_unit_test(test_too_many_shapes),
        cmocka_unit_test(test_fields),
    };
    return cmocka_run_group_tests_name("shared_work", tests, fixture_set_up, fixture_tear_down);
}
