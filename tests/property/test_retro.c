/* Peaks towards the light: readings of one are believed, and tell of it at other angles. */
#include "posterior_fixture.h"

#include <math.h>
#include <stdlib.h>

enum { ELSEWHERE = 24, BACK = 5, READ = ELSEWHERE + BACK };

static const double DEGREE = M_PI / 180.0;
static const double HEIGHT = 3.5; /* log units */

static gonio_half_difference towards_light(double theta_h_deg, double theta_d_deg)
{
    return (gonio_half_difference){
        .theta_h = theta_h_deg * DEGREE, .theta_d = theta_d_deg * DEGREE, .phi_d = M_PI / 2.0};
}

static double peak_at(gonio_half_difference at)
{
    const double width = at.theta_d / (3.0 * DEGREE);
    return HEIGHT * exp(-0.5 * width * width);
}

/* A material of the prior with a peak towards the light; peak: whether it has one. */
static void read_all(const drawn *d, bool peak, gonio_i_observation *o)
{
    static const double incidence[BACK] = {18.0, 28.0, 38.0, 48.0, 58.0};
    for (size_t i = 0; i < ELSEWHERE; i++) {
        o[i] = d->reading[i];
    }
    for (size_t i = 0; i < BACK; i++) {
        const gonio_half_difference at = towards_light(incidence[i], 1.0 + 0.3 * (double)i);
        o[ELSEWHERE + i] = (gonio_i_observation){
            .at = at, .g = truth_at(d->z, at) + (peak ? peak_at(at) : 0.0), .variance = 1e-3};
    }
}

/* Where the field is asked for: between the readings. */
static double field_at(const double *field, gonio_half_difference at)
{
    gonio_i_row_weight around[GONIO_I_MOST_POINTS];
    const int points = gonio_i_rows_around(fixture.small, at, 0, around);
    double g = 0.0;
    for (int k = 0; k < points; k++) {
        g += around[k].weight * field[around[k].row];
    }
    return g;
}

static double off_between(uint64_t seed, bool peak, size_t *outlying)
{
    drawn d = draw(seed, 0.01);
    gonio_i_observation o[READ];
    read_all(&d, peak, o);
    found r = find(fixture.mixture, o, READ, -1.0);
    const gonio_half_difference at = towards_light(43.0, 1.5);
    const double off = field_at(r.field, at) - truth_at(d.z, at) - (peak ? peak_at(at) : 0.0);
    *outlying = r.posterior.outlying;
    drop(&r);
    free(d.z);
    return off;
}

static void test_a_peak_is_believed(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        size_t outlying = 0;
        const double off = off_between(seed, true, &outlying);
        print_message("peak of %.1f log units off by %.2f\n", HEIGHT, off);
        assert_int_equal(outlying, 0);
        assert_true(fabs(off) < 0.35);
        assert_true(fabs(off_between(seed, false, &outlying)) < 0.35);
    }
}

static void test_the_kernel(void **state)
{
    (void)state;
    const gonio_i_place light = gonio_i_place_of(towards_light(40.0, 0.0));
    const gonio_i_place beside = gonio_i_place_of(towards_light(40.0, 3.0));
    const gonio_i_place steeper = gonio_i_place_of(towards_light(20.0, 0.0));
    const gonio_i_place mirror = gonio_i_place_of(towards_light(0.0, 0.0));
    const gonio_i_place far = gonio_i_place_of(towards_light(40.0, 30.0));
    assert_true(gonio_i_place_is_back(&light) && gonio_i_place_is_back(&beside));
    assert_false(gonio_i_place_is_back(&mirror) || gonio_i_place_is_back(&far));
    assert_close(gonio_i_back(&light, &light), 1.0, 1e-3);
    assert_close(gonio_i_back(&light, &beside) / exp(-0.5), 1.0, 1e-3);
    assert_true(gonio_i_back(&light, &steeper) > 0.5);
    assert_true(gonio_i_back(&light, &far) == 0.0);
    assert_close(gonio_i_remainder(&light, &beside, 0.0, 8.0) - gonio_i_smooth(&light, &beside),
                 64.0 * gonio_i_back(&beside, &light), 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_peak_is_believed),
        cmocka_unit_test(test_the_kernel),
    };
    return cmocka_run_group_tests_name("retro", tests, fixture_set_up, fixture_tear_down);
}
