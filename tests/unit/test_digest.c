/* The errors of bivariate estimates by a digest are those of whole tables. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "evaluate/digest.h"
#include "made_material.h"

typedef struct fixture {
    gonio_database *database;
    gonio_basis *basis;
    const gonio_basis_view *view;
    double *vectors;
} fixture;

static fixture data;

static const char *const paths[] = {"atlas:gold-polished", "atlas:oak-sawn", "atlas:red-cotton",
                                    "atlas:plaster-cast"};

enum { PATHS = sizeof paths / sizeof *paths, COMPONENTS = 3 };

static int set_up(void **state)
{
    (void)state;
    const gonio_basis_options options = {.size = sizeof options, .components = COMPONENTS};
    const gonio_database_options grid = {
        .size = sizeof grid, .representation = GONIO_BIVARIATE, .channels = GONIO_JOINT};
    assert_int_equal(gonio_database_create(NULL, paths, PATHS, &grid, &data.database), GONIO_OK);
    assert_int_equal(gonio_basis_learn(NULL, data.database, &options, &data.basis), GONIO_OK);
    data.view = gonio_basis_describe(data.basis);
    data.vectors = support_vectors(data.basis);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(data.vectors);
    gonio_basis_free(&data.basis);
    gonio_database_free(&data.database);
    return 0;
}

/* m + V c in every cell. */
static double *estimate_of(double c[COMPONENTS])
{
    double *g = calloc((size_t)GONIO_CELLS * GONIO_CHANNELS, sizeof *g);
    for (int32_t cell = 0; cell < GONIO_CELLS; cell++) {
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            const size_t row = gonio_basis_position(data.basis, cell) * GONIO_CHANNELS + channel;
            double *value = &g[(size_t)cell * GONIO_CHANNELS + channel];
            *value = data.view->mean[row];
            for (size_t k = 0; k < COMPONENTS; k++) {
                *value += data.vectors[row * COMPONENTS + k] * c[k];
            }
        }
    }
    return g;
}

/* By every metric; a bias may be near 0. */
static void assert_same_error(const gonio_error *error, const gonio_error *expected)
{
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        const double allowed = m == GONIO_BIAS ? 1e-8 : 0.0;
        const double from = expected->value[m];
        if (!(fabs(error->value[m] - from) <= 1e-8 * fabs(from) + allowed)) {
            fail_msg("%s: %.17g where %.17g is expected", gonio_metric_describe(m)->name,
                     error->value[m], from);
        }
    }
}

static void check(const gonio_material *material, double c[COMPONENTS])
{
    gonio_reconstruction made = {.components = COMPONENTS, .columns = 1, .coefficients = c};
    gonio_material *other = NULL;
    gonio_comparison expected;
    gonio_i_digest *digest = NULL;
    gonio_error error;
    double *g = estimate_of(c);
    assert_int_equal(gonio_reconstruction_material(NULL, data.basis, &made, "other", &other),
                     GONIO_OK);
    assert_int_equal(gonio_compare(NULL, material, other, &expected), GONIO_OK);
    assert_int_equal(gonio_i_digest_create(NULL, material, &digest), GONIO_OK);
    assert_int_equal(gonio_i_digest_compare(NULL, digest, g, &error), GONIO_OK);
    assert_int_equal(digest->bins, expected.bins);
    assert_same_error(&error, &expected.all);
    gonio_i_digest_free(&digest);
    gonio_material_free(&other);
    free(g);
}

/* Near estimates and far ones, below zero too. */
static void test_errors_of_reconstructions(void **state)
{
    (void)state;
    double near[COMPONENTS] = {10.0, -20.0, 5.0};
    double far[COMPONENTS] = {-500.0, 300.0, 250.0};
    double beyond[COMPONENTS] = {0.0, 0.0, 40000.0};
    static const char *const materials[] = {"atlas:brass-satin", "atlas:gold-polished",
                                            "atlas:white-linen"};
    for (size_t k = 0; k < sizeof materials / sizeof *materials; k++) {
        gonio_material *material = NULL;
        if (gonio_material_open(NULL, materials[k], &material) != GONIO_OK) {
            fail_msg("no %s", materials[k]);
        }
        check(material, near);
        check(material, far);
        check(material, beyond);
        gonio_material_free(&material);
    }
}

static bool is_odd_hole(gonio_bin bin)
{
    return (bin.phi_d + bin.theta_d * 7 + bin.theta_h * 3) % 5 < 2 || bin.theta_d == 11;
}

static void test_holes(void **state)
{
    (void)state;
    double c[COMPONENTS] = {10.0, -20.0, 5.0};
    gonio_material *material = made_material((made_constant){{0.05, 0.2, 3.0}, is_odd_hole});
    check(material, c);
    gonio_material_free(&material);
}

static void test_own_mean(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    gonio_material *average = NULL;
    gonio_comparison expected;
    gonio_i_digest *digest = NULL;
    gonio_error error;
    double *g = calloc((size_t)GONIO_CELLS * GONIO_CHANNELS, sizeof *g);
    assert_int_equal(gonio_material_open(NULL, "atlas:red-cotton", &material), GONIO_OK);
    assert_int_equal(gonio_bivariate_material(NULL, material, &average), GONIO_OK);
    assert_int_equal(gonio_compare(NULL, material, average, &expected), GONIO_OK);
    assert_int_equal(gonio_i_digest_create(NULL, material, &digest), GONIO_OK);
    gonio_i_digest_mean(digest, g);
    assert_int_equal(gonio_i_digest_compare(NULL, digest, g, &error), GONIO_OK);
    assert_same_error(&error, &expected.all);
    assert_string_equal(digest->name, "red-cotton");
    gonio_i_digest_free(&digest);
    gonio_material_free(&average);
    gonio_material_free(&material);
    free(g);
}

static void test_fingerprint(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    gonio_i_digest *digest = NULL;
    const gonio_database_view *view = gonio_database_describe(data.database);
    assert_int_equal(gonio_material_open(NULL, paths[1], &material), GONIO_OK);
    assert_int_equal(gonio_i_digest_create(NULL, material, &digest), GONIO_OK);
    assert_true(digest->fingerprint == view->fingerprints[1]);
    gonio_i_digest_free(&digest);
    gonio_material_free(&material);
}

static bool everywhere(gonio_bin bin)
{
    (void)bin;
    return true;
}

static void test_what_has_no_error(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_material *materials[] = {made_material((made_constant){{0.05, 0.2, 3.0}, everywhere}),
                                   made_material((made_constant){{0.0, 0.0, 0.0}, NULL})};
    static const char *const messages[] = {"no data at all", "is black"};
    for (size_t k = 0; k < 2; k++) {
        gonio_i_digest *digest = NULL;
        assert_int_equal(gonio_i_digest_create(context, materials[k], &digest), GONIO_ERROR_DATA);
        assert_non_null(strstr(support_message(), messages[k]));
        assert_null(digest);
        gonio_material_free(&materials[k]);
    }
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors_of_reconstructions),
        cmocka_unit_test(test_holes),
        cmocka_unit_test(test_own_mean),
        cmocka_unit_test(test_fingerprint),
        cmocka_unit_test(test_what_has_no_error),
    };
    return cmocka_run_group_tests_name("digest", tests, set_up, tear_down);
}
