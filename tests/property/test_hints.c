/* What hints on readings stand on: albedos of fits, and the margin of a transform. */
#include "posterior_fixture.h"

#include <math.h>
#include <stdlib.h>

#include "posterior/albedo.h"
#include "posterior/transform_trial.h"

/* The nodes of an incidence fill the hemisphere: cos theta_o adds up to pi. */
static void test_nodes_fill_the_hemisphere(void **state)
{
    (void)state;
    gonio_i_hemisphere h;
    assert_int_equal(gonio_i_hemisphere_create(fixture.context, fixture.mixture, &h), GONIO_OK);
    for (int n = 0; n < GONIO_I_ALBEDO_INCIDENCES; n++) {
        double sum = 0.0;
        assert_true(h.first[n + 1] > h.first[n]);
        for (size_t k = h.first[n]; k < h.first[n + 1]; k++) {
            assert_true(h.weight[k] > 0.0);
            sum += h.weight[k];
        }
        print_message("incidence %d: %.4f pi\n", n, sum / M_PI);
        assert_close(sum / M_PI, 1.0, 0.03);
    }
    gonio_i_hemisphere_release(&h);
}

/* A fit to equal readings all over the hemisphere has about the albedo of a Lambertian. */
static void test_albedo_of_equal_readings(void **state)
{
    (void)state;
    const double s = gonio_log_scale(0);
    const double albedo = 0.4;
    const gonio_i_model model = {GONIO_I_KERNEL_WIDTH, 2.0, 0.0, 0.0};
    gonio_i_observation reading[MOST];
    const gonio_i_column column = {MOST, reading};
    gonio_i_sites *sites = NULL;
    gonio_i_hemisphere h;
    gonio_i_fit e;
    double albedos[GONIO_I_ALBEDO_INCIDENCES];
    for (size_t i = 0; i < MOST; i++) {
        const double t = ((double)(i % 10) + 0.5) * 0.15;
        const gonio_pair pair = {{0.2 + (double)(i / 10) * 0.2, 0.0}, {t, 0.7 * (double)i}};
        reading[i] = (gonio_i_observation){.at = gonio_half_difference_from_pair(pair),
                                           .g = log1p(albedo / M_PI / s),
                                           .variance = 1e-4,
                                           .reading = i};
    }
    assert_int_equal(gonio_i_hemisphere_create(fixture.context, fixture.mixture, &h), GONIO_OK);
    assert_int_equal(gonio_i_sites_create(fixture.context, fixture.mixture, &column, &sites),
                     GONIO_OK);
    assert_int_equal(gonio_i_fit_begin(fixture.context, sites, false, &column, &e), GONIO_OK);
    assert_int_equal(gonio_i_fit_solve(&e, &model), GONIO_OK);
    assert_int_equal(gonio_i_fit_albedo(&e, &h, s, albedos), GONIO_OK);
    for (int n = 0; n < GONIO_I_ALBEDO_INCIDENCES; n++) {
        print_message("incidence %d: albedo %.3f\n", n, albedos[n]);
        assert_close(albedos[n], albedo, 0.15 * albedo);
    }
    gonio_i_fit_end(&e);
    gonio_i_sites_free(&sites);
    gonio_i_hemisphere_release(&h);
}

/* A reading counts at most 3, whatever the density of it. */
static void test_margin_is_robust(void **state)
{
    (void)state;
    const gonio_pair pair[3] = {
        {{0.3, 0.0}, {0.5, 3.0}}, {{0.8, 0.0}, {0.2, 1.0}}, {{0.1, 0.0}, {0.2, 2.0}}};
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = 3, .channels = 3, .pair = pair};
    gonio_readings *readings = NULL;
    double some[3] = {1.0, 100.0, -50.0};
    double others[3] = {0.0, 2.0, -48.0};
    const gonio_i_verdict a = {.score = some};
    const gonio_i_verdict b = {.score = others};
    assert_int_equal(gonio_readings_create(fixture.context, &arrays, NULL, &readings), GONIO_OK);
    const gonio_i_transform_trial trial = {.readings = readings};
    assert_close(gonio_i_transform_trial_margin(&trial, &a, &b), 1.0 + 3.0 - 2.0, 1e-12);
    assert_close(gonio_i_transform_trial_margin(&trial, &b, &a), -1.0 - 3.0 + 2.0, 1e-12);
    gonio_readings_free(&readings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nodes_fill_the_hemisphere),
        cmocka_unit_test(test_albedo_of_equal_readings),
        cmocka_unit_test(test_margin_is_robust),
    };
    return cmocka_run_group_tests_name("hints", tests, fixture_set_up, fixture_tear_down);
}
