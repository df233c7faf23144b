/* The directional-hemispherical reflectance: exact of a Lambertian material, that of a sum over
 * many directions of glossy ones, that of a reconstruction with its deviation. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>

#include <gonio/evaluate.h>

#include "made_basis.h"
#include "made_readings.h"

static const double incidence[] = {0.0, 8.0, 30.0, 60.0, 85.0};

enum { INCIDENCES = sizeof incidence / sizeof *incidence };

static gonio_status evaluate_half(void *self, gonio_context *context, const gonio_pair *pairs,
                                  size_t count, double *values)
{
    (void)self;
    (void)context;
    (void)pairs;
    for (size_t k = 0; k < count; k++) {
        values[k] = 0.5 / M_PI;
    }
    return GONIO_OK;
}

static gonio_status read_half(void *self, gonio_context *context, int theta_h, double *rho)
{
    (void)self;
    (void)context;
    (void)theta_h;
    for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
        rho[k] = 0.5 / M_PI;
    }
    return GONIO_OK;
}

static void test_lambertian(void **state)
{
    (void)state;
    const gonio_material_source source = {
        .size = sizeof source, .read_slab = read_half, .evaluate = evaluate_half, .channels = 1};
    gonio_material *material = NULL;
    assert_int_equal(gonio_material_create(NULL, "half", "made", &source, &material), GONIO_OK);
    for (int k = 0; k < INCIDENCES; k++) {
        double value = 0.0;
        double share = 0.0;
        const double theta = incidence[k] * M_PI / 180.0;
        assert_int_equal(gonio_material_reflectance(NULL, material, theta, &value, &share),
                         GONIO_OK);
        assert_true(fabs(value - 0.5) < 1e-12 && fabs(share - 1.0) < 1e-12);
    }
    gonio_material_free(&material);
}

/* By the midpoint rule about the mirror direction: theta_o in equal steps, and phi_o in steps that
 * grow from there, on one side of the plane of incidence, as the other is alike. */
static double sum_over_many(const gonio_material *material, double theta_i)
{
    enum { RINGS = 1200, SPOKES = 270, ALL = RINGS * SPOKES };
    gonio_pair *pair = calloc(ALL, sizeof *pair);
    double *value = calloc((size_t)ALL * GONIO_CHANNELS, sizeof *value);
    double sum = 0.0;
    assert_true(pair != NULL && value != NULL);
    for (int k = 0; k < ALL; k++) {
        const double theta = (k / SPOKES + 0.5) / RINGS * M_PI / 2.0;
        const double t = (k % SPOKES + 0.5) / SPOKES; /* 0 to 1, denser at 0 */
        pair[k] = (gonio_pair){{theta_i, 0.0}, {theta, M_PI + M_PI * t * t * t}};
    }
    /* All at once, as a call reads the parts of the table that it needs. */
    assert_int_equal(gonio_material_evaluate(NULL, material, pair, ALL, value), GONIO_OK);
    for (int k = 0; k < ALL; k++) {
        const double theta = pair[k].outgoing.theta;
        const double t = (k % SPOKES + 0.5) / SPOKES;
        const double step = 2.0 * 3.0 * M_PI * t * t / SPOKES;
        sum +=
            value[k * GONIO_CHANNELS + 1] * cos(theta) * sin(theta) * step * (M_PI / 2.0 / RINGS);
    }
    free(pair);
    free(value);
    return sum;
}

static void test_built_in_materials(void **state)
{
    (void)state;
    static const char *const names[] = {"atlas:white-emulsion-paint", "atlas:red-glossy-plastic",
                                        "atlas:steel-brushed"};
    for (size_t m = 0; m < sizeof names / sizeof *names; m++) {
        gonio_material *material = NULL;
        assert_int_equal(gonio_material_open(NULL, names[m], &material), GONIO_OK);
        for (int k = 1; k < INCIDENCES - 1; k += 2) {
            double value[GONIO_CHANNELS];
            double share = 0.0;
            const double theta = incidence[k] * M_PI / 180.0;
            assert_int_equal(gonio_material_reflectance(NULL, material, theta, value, &share),
                             GONIO_OK);
            const double expected = sum_over_many(material, theta);
            if (!(fabs(value[1] - expected) < 0.002 * expected)) {
                fail_msg("%s at %g: %.6g, not %.6g", names[m], incidence[k], value[1], expected);
            }
        }
        gonio_material_free(&material);
    }
}

/* The reflectance of a reconstruction is that of its material, within a few deviations of the
 * truth's. */
static void test_reconstructions(void **state)
{
    (void)state;
    enum { CHANNELS = 2 };
    static const double read[][4 + CHANNELS] = {{30, 0, 50, 40, 0.1, 0.2},
                                                {10, 0, 20, 0, 0.3, 0.4}};
    static const double at[CHANNELS] = {450.0, 650.0};
    gonio_reconstruct_options options = {
        .size = sizeof options, .method = "posterior", .noise = 0.01, .deviation = true};
    gonio_basis *basis = made_basis(NULL, GONIO_BIVARIATE, GONIO_SEPARATE, 1);
    gonio_readings *readings = made_spectra(&read[0][0], 2, CHANNELS, at, true);
    gonio_reconstruction *made = NULL;
    gonio_material *material = NULL;
    assert_int_equal(gonio_reconstruct(NULL, basis, readings, &options, &made), GONIO_OK);
    assert_int_equal(gonio_reconstruction_spectral_material(NULL, basis, made, "made", &material),
                     GONIO_OK);
    double value[CHANNELS], of_material[CHANNELS], deviation[CHANNELS], share = 0.0;
    assert_int_equal(gonio_reconstruction_reflectance(NULL, basis, made, 0.5, value, deviation),
                     GONIO_OK);
    assert_int_equal(gonio_material_reflectance(NULL, material, 0.5, of_material, &share),
                     GONIO_OK);
    for (int c = 0; c < CHANNELS; c++) {
        assert_true(fabs(value[c] - of_material[c]) <= 1e-9 * value[c]);
        assert_true(deviation[c] > 0.0 && deviation[c] < 10.0 * value[c]);
    }
    assert_true(made->database_share > 0.0 && made->database_share < 1.0);
    gonio_material_free(&material);
    gonio_reconstruction_free(&made);
    options.deviation = false;
    gonio_context *context = support_context();
    assert_int_equal(gonio_reconstruct(NULL, basis, readings, &options, &made), GONIO_OK);
    assert_int_equal(gonio_reconstruction_reflectance(context, basis, made, 0.5, value, deviation),
                     GONIO_ERROR_ARGUMENT);
    gonio_context_free(&context);
    gonio_reconstruction_free(&made);
    gonio_readings_free(&readings);
    gonio_basis_free(&basis);
}

static void test_refusals(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_pair *pair = NULL;
    double *weight = NULL;
    size_t count = 0;
    assert_int_equal(gonio_reflectance_directions(context, M_PI / 2.0, &pair, &weight, &count),
                     GONIO_ERROR_ARGUMENT);
    assert_int_equal(gonio_reflectance_directions(context, NAN, &pair, &weight, &count),
                     GONIO_ERROR_ARGUMENT);
    assert_null(pair);
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lambertian),
        cmocka_unit_test(test_built_in_materials),
        cmocka_unit_test(test_reconstructions),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
