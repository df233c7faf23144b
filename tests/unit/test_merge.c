/* Merging readings: means and variances, bounds, how many are left and where. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>

#include "core/random.h"
#include "posterior/merge.h"

static const double OPEN = GONIO_I_MODEL_DEVIATION * GONIO_I_MODEL_DEVIATION;

static gonio_i_column merge(const gonio_i_column *column, size_t most)
{
    gonio_context *context = support_context();
    gonio_i_column merged;
    assert_int_equal(gonio_i_merge(context, column, most, &merged), GONIO_OK);
    gonio_context_free(&context);
    return merged;
}

static void test_mean_and_variance(void **state)
{
    (void)state;
    const gonio_half_difference at = {.theta_h = 0.3, .theta_d = 0.5, .phi_d = 1.0};
    gonio_i_observation reading[] = {{.at = at, .g = 1.0, .variance = OPEN + 0.01},
                                     {.at = at, .g = 2.0, .variance = OPEN + 0.01},
                                     {.at = at, .g = 9.0, .variance = OPEN + 0.04}};
    const gonio_i_column column = {3, reading};
    gonio_i_column merged = merge(&column, 100);
    const double a = 1.0 / (OPEN + 0.01);
    const double b = 1.0 / (OPEN + 0.04);
    const double all = 2.0 * a + b;
    assert_int_equal(merged.count, 1);
    assert_true(fabs(merged.observation[0].g - (3.0 * a + 9.0 * b) / all) < 1e-12);
    const double noise = (2.0 * a * a * 0.01 + b * b * 0.04) / (all * all);
    assert_true(fabs(merged.observation[0].variance - OPEN - noise) < 1e-12);
    free(merged.observation);
}

/* Repeats are merged, to rounding, wherever the borders of a lattice are; other readings stay as
 * they are, in their order. */
static void test_repeats(void **state)
{
    (void)state;
    enum { PLACES = 60 };
    gonio_context *context = support_context();
    gonio_i_observation reading[2 * PLACES];
    for (int k = 0; k < PLACES; k++) {
        const double degree = M_PI / 180.0;
        const gonio_half_difference at = {
            .theta_h = (PLACES - k) * degree, .theta_d = k * degree, .phi_d = 3.0 * k * degree};
        reading[k] = (gonio_i_observation){.at = at, .g = k, .variance = OPEN + 0.01};
        reading[PLACES + k] = reading[k];
        reading[PLACES + k].at.theta_d += 1e-13;
    }
    gonio_i_column merged;
    const gonio_i_column once = {PLACES, reading};
    assert_int_equal(gonio_i_merge_repeats(context, &once, &merged), GONIO_OK);
    assert_int_equal(merged.count, PLACES);
    for (int k = 0; k < PLACES; k++) {
        assert_true(merged.observation[k].g == k);
        assert_true(merged.observation[k].variance == OPEN + 0.01);
    }
    free(merged.observation);
    const gonio_i_column twice = {2 * PLACES, reading};
    assert_int_equal(gonio_i_merge_repeats(context, &twice, &merged), GONIO_OK);
    assert_int_equal(merged.count, PLACES);
    for (int k = 0; k < PLACES; k++) {
        assert_true(fabs(merged.observation[k].variance - OPEN - 0.005) < 1e-12);
    }
    free(merged.observation);
    gonio_context_free(&context);
}

/* "At most this" does not mix with a value, or with a bound from below. */
static void test_bounds_stay_apart(void **state)
{
    (void)state;
    gonio_i_observation reading[6];
    for (int k = 0; k < 6; k++) {
        reading[k] = (gonio_i_observation){.at = {.theta_h = 0.3, .theta_d = 0.5, .phi_d = 1.0},
                                           .g = k,
                                           .variance = OPEN + 0.01,
                                           .bound = k % 3 - 1};
    }
    const gonio_i_column column = {6, reading};
    gonio_i_column merged = merge(&column, 100);
    assert_int_equal(merged.count, 3);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(merged.observation[k].bound, k - 1);
        assert_true(fabs(merged.observation[k].g - (k + 1.5)) < 1e-12);
    }
    free(merged.observation);
}

/* Of 50,000 directions all over, as many are left as fit, to within a step of the lattice; each has
 * the value of a smooth field at its own direction, to within its cell. */
static void test_many(void **state)
{
    (void)state;
    enum { COUNT = 50000, MOST = 1000 };
    gonio_i_observation *reading = calloc(COUNT, sizeof *reading);
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, 0);
    for (size_t i = 0; i < COUNT; i++) {
        const gonio_half_difference at = {.theta_h = 1.5 * gonio_i_random_uniform(&random),
                                          .theta_d = 1.5 * gonio_i_random_uniform(&random),
                                          .phi_d = 3.1 * gonio_i_random_uniform(&random)};
        const gonio_i_place place = gonio_i_place_of(at);
        reading[i] = (gonio_i_observation){.at = at, .variance = OPEN + 0.01};
        reading[i].g = place.p[0] + 0.1 * gonio_i_random_normal(&random);
    }
    const gonio_i_column column = {COUNT, reading};
    gonio_i_column merged = merge(&column, MOST);
    assert_true(merged.count <= MOST && merged.count > MOST / 2);
    for (size_t i = 0; i < merged.count; i++) {
        const gonio_i_observation *o = &merged.observation[i];
        const gonio_i_place place = gonio_i_place_of(o->at);
        assert_true(fabs(o->g - place.p[0]) < 0.75);
        assert_true(o->variance >= OPEN && o->variance <= OPEN + 0.01 + 1e-12);
    }
    free(merged.observation);
    free(reading);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mean_and_variance),
        cmocka_unit_test(test_repeats),
        cmocka_unit_test(test_bounds_stay_apart),
        cmocka_unit_test(test_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
