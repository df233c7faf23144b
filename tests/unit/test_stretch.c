/* Stretched half vectors, their azimuths and places drawn from the grid. */
#include "../support.h"

#include <math.h>

#include "prior/stretch.h"

enum { PLACES = 2000 };

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

static void test_places_become_pairs_and_back(void **state)
{
    (void)state;
    gonio_i_oriented place[PLACES];
    gonio_i_oriented_sample(3, PLACES, place);
    for (size_t k = 0; k < PLACES; k++) {
        const gonio_pair pair = gonio_i_oriented_pair(place[k]);
        const gonio_i_oriented back = gonio_i_oriented_of(pair);
        assert_true(pair.incident.theta < 0.5 * M_PI && pair.outgoing.theta < 0.5 * M_PI);
        assert_close(back.at.theta_h, place[k].at.theta_h, 1e-9);
        assert_close(back.at.theta_d, place[k].at.theta_d, 1e-9);
        assert_close(remainder(back.phi_h - place[k].phi_h, 2.0 * M_PI) * sin(back.at.theta_h), 0.0,
                     1e-9);
    }
}

static void test_the_same_seed_draws_the_same_places(void **state)
{
    (void)state;
    gonio_i_oriented a[8];
    gonio_i_oriented b[8];
    gonio_i_oriented_sample(5, 8, a);
    gonio_i_oriented_sample(5, 8, b);
    assert_memory_equal(a, b, sizeof a);
}

static gonio_i_oriented at(double theta_h, double phi_h)
{
    return (gonio_i_oriented){{theta_h, 0.4, 1.0}, phi_h};
}

/* Slopes along the grain become larger by the root of the ratio, those across it smaller. */
static void test_slopes_are_stretched(void **state)
{
    (void)state;
    const gonio_i_stretch stretch = {.log_ratio = log(4.0), .rotation = 0.5};
    const double along = gonio_i_stretch_apply(&stretch, at(0.3, 0.5)).theta_h;
    const double across = gonio_i_stretch_apply(&stretch, at(0.3, 0.5 + 0.5 * M_PI)).theta_h;
    assert_close(tan(along), 2.0 * tan(0.3), 1e-12);
    assert_close(tan(across), 0.5 * tan(0.3), 1e-12);
}

static void test_isotropic_lobes_stay(void **state)
{
    (void)state;
    const gonio_i_stretch none = {0};
    const gonio_i_stretch azimuths = {.share = 0.1, .symmetry = 2};
    const gonio_half_difference there = gonio_i_stretch_apply(&none, at(0.7, 2.0));
    assert_true(there.theta_h == 0.7 && there.theta_d == 0.4 && there.phi_d == 1.0);
    assert_true(gonio_i_stretch_is_isotropic(&none));
    assert_false(gonio_i_stretch_is_isotropic(&azimuths));
}

static void test_the_horizon_stays(void **state)
{
    (void)state;
    const gonio_i_stretch stretch = {.log_ratio = 2.0, .rotation = 0.0};
    for (int k = 0; k < 16; k++) {
        const double theta_h =
            gonio_i_stretch_apply(&stretch, at(0.5 * M_PI, 2.0 * M_PI * k / 16.0)).theta_h;
        assert_close(theta_h, 0.5 * M_PI, 1e-5);
    }
}

/* What a turn of the sample does not change has the same azimuth; at the mirror direction all have.
 */
static void test_azimuths_follow_the_symmetry(void **state)
{
    (void)state;
    static const int symmetry[] = {1, 2, 4};
    for (int k = 0; k < 3; k++) {
        const double turn = 2.0 * M_PI / symmetry[k];
        const gonio_i_stretch stretch = {.symmetry = symmetry[k]};
        const gonio_i_azimuth_point a = gonio_i_azimuth_of(&stretch, at(0.6, 0.3));
        const gonio_i_azimuth_point b = gonio_i_azimuth_of(&stretch, at(0.6, 0.3 + turn));
        const gonio_i_azimuth_point c = gonio_i_azimuth_of(&stretch, at(0.6, 0.3 + 0.5 * turn));
        assert_close(gonio_i_azimuth_kernel(a, b), 1.0, 1e-12);
        assert_true(gonio_i_azimuth_kernel(a, c) < 0.2);
        const gonio_i_azimuth_point mirror = gonio_i_azimuth_of(&stretch, at(0.0, 0.3));
        const gonio_i_azimuth_point turned = gonio_i_azimuth_of(&stretch, at(0.0, 1.3));
        assert_close(gonio_i_azimuth_kernel(mirror, turned), 1.0, 1e-12);
    }
}

/* A half vector and its image in a plane of symmetry are one to a mirrored stretch alone. */
static void test_azimuths_are_mirrored_in_the_grain(void **state)
{
    (void)state;
    const gonio_i_stretch mirrored = {
        .log_ratio = 0.7, .rotation = 0.4, .symmetry = 2, .mirrored = true};
    const gonio_i_stretch plain = {.log_ratio = 0.7, .rotation = 0.4, .symmetry = 2};
    for (int k = 0; k < 8; k++) {
        const double phi = 0.4 + 0.3 + 0.14 * k; /* 0.3 .. 1.28 from the plane */
        const gonio_i_oriented here = at(0.6, phi);
        const gonio_i_oriented image = at(0.6, 0.8 - phi);
        const gonio_i_azimuth_point a = gonio_i_azimuth_of(&mirrored, here);
        const gonio_i_azimuth_point b = gonio_i_azimuth_of(&mirrored, image);
        assert_close(gonio_i_azimuth_kernel(a, b), 1.0, 1e-12);
        assert_true(gonio_i_azimuth_kernel(gonio_i_azimuth_of(&plain, here),
                                           gonio_i_azimuth_of(&plain, image)) < 0.95);
    }
}

/* Azimuths are those of the stretched half vector. So along the grain and across it differ, which a
 * plane of symmetry alone does not tell apart. */
static void test_azimuths_are_stretched(void **state)
{
    (void)state;
    const gonio_i_stretch none = {.symmetry = 2};
    const gonio_i_stretch stretch = {
        .log_ratio = log(4.0), .rotation = 0.4, .symmetry = 2, .mirrored = true};
    const double phi = 0.5; /* from the grain */
    const double stretched = atan(tan(phi) / 4.0);
    const gonio_half_difference there = gonio_i_stretch_apply(&stretch, at(0.6, 0.4 + phi));
    const gonio_i_azimuth_point a = gonio_i_azimuth_of(&stretch, at(0.6, 0.4 + phi));
    const gonio_i_azimuth_point b = gonio_i_azimuth_of(&none, at(there.theta_h, stretched));
    assert_close(a.x, b.x, 1e-12);
    assert_close(a.y, b.y, 1e-12);
    const gonio_i_azimuth_point between = gonio_i_azimuth_of(&stretch, at(0.6, 0.4 + 0.25 * M_PI));
    const gonio_i_azimuth_point along = gonio_i_azimuth_of(&stretch, at(0.6, 0.4));
    const gonio_i_azimuth_point across = gonio_i_azimuth_of(&stretch, at(0.6, 0.4 + 0.5 * M_PI));
    assert_true(gonio_i_azimuth_kernel(between, along) >
                2.0 * gonio_i_azimuth_kernel(between, across));
}

/* Facets that are stretched keep the density of their slopes, which is theirs times cos^4. */
static void test_facets_keep_the_density_of_slopes(void **state)
{
    (void)state;
    const gonio_i_stretch slopes = {.log_ratio = log(4.0), .rotation = 0.5};
    const gonio_i_stretch facets = {.log_ratio = log(4.0), .rotation = 0.5, .facets = true};
    const gonio_i_oriented here = at(0.3, 0.9);
    const double there = gonio_i_stretch_apply(&facets, here).theta_h;
    const double factor = exp(gonio_i_stretch_log_factor(&facets, here));
    assert_close(factor * pow(cos(0.3), 4.0), pow(cos(there), 4.0), 1e-12);
    assert_close(gonio_i_stretch_log_factor(&slopes, here), 0.0, 0.0);
    assert_close(gonio_i_stretch_apply(&slopes, here).theta_h, there, 0.0);
}

static void test_values_are_multiplied(void **state)
{
    (void)state;
    const double values[] = {-0.5, 0.0, 1e-4, 2.0, 8.0};
    for (int k = 0; k < 5; k++) {
        double slope = 0.0;
        double back = 0.0;
        double ignored = 0.0;
        const double g = gonio_i_multiplied(values[k], 1.5, &slope);
        const double step = 1e-5;
        const double above = gonio_i_multiplied(values[k] + step, 1.5, &ignored);
        assert_close(expm1(fabs(g)), exp(1.5) * expm1(fabs(values[k])), 1e-9 * expm1(fabs(g)));
        assert_close((above - g) / step, slope, 1e-3);
        back = gonio_i_multiplied(g, -1.5, &ignored);
        assert_close(back, values[k], 1e-12);
        assert_close(slope * ignored, 1.0, 1e-12);
    }
}

/* Half vectors of fibres stay. What they add is alike along a line across them, at any place of the
 * axis along them unless half a turn changes nothing. */
static void test_fibres_see_the_sum_along_them(void **state)
{
    (void)state;
    gonio_i_stretch fibres = {
        .log_ratio = log(9.0), .rotation = 0.7, .symmetry = 1, .fibres = true};
    const gonio_i_oriented here = at(0.4, 1.2);
    const gonio_i_azimuth_point along = gonio_i_azimuth_of(&fibres, at(0.4, 0.7));
    const gonio_i_azimuth_point back = gonio_i_azimuth_of(&fibres, at(0.4, 0.7 + M_PI));
    const gonio_i_azimuth_point across = gonio_i_azimuth_of(&fibres, at(0.4, 0.7 + 0.5 * M_PI));
    const gonio_i_azimuth_point normal = gonio_i_azimuth_of(&fibres, at(0.0, 0.0));
    const gonio_i_azimuth_point image = gonio_i_azimuth_of(&fibres, at(0.4, 0.2));
    assert_close(gonio_i_stretch_apply(&fibres, here).theta_h, 0.4, 0.0);
    assert_close(gonio_i_azimuth_kernel(gonio_i_azimuth_of(&fibres, here), image), 1.0, 1e-12);
    assert_true(gonio_i_azimuth_kernel(across, normal) > 0.9);
    assert_true(gonio_i_azimuth_kernel(along, normal) < 0.1);
    assert_true(gonio_i_azimuth_kernel(along, back) < 0.01);
    fibres.symmetry = 2;
    assert_close(gonio_i_azimuth_kernel(gonio_i_azimuth_of(&fibres, at(0.4, 0.7)),
                                        gonio_i_azimuth_of(&fibres, at(0.4, 0.7 + M_PI))),
                 1.0, 1e-12);
}

/* The smooth part of the remainder is kappa alone for fibres. */
static void test_the_remainder_of_fibres_is_their_kernel(void **state)
{
    (void)state;
    const gonio_i_stretch plain = {.symmetry = 2};
    const gonio_i_stretch fibres = {.log_ratio = 1.0, .symmetry = 1, .fibres = true};
    const gonio_i_place a = gonio_i_place_of(at(0.01, 0.0).at);
    const gonio_i_place b = gonio_i_place_of(at(0.6, 0.0).at);
    assert_close(gonio_i_stretch_remainder(&fibres, &a, &b, 0.0, 0.0), 1.0, 1e-12);
    assert_close(gonio_i_stretch_remainder(&plain, &a, &b, 2.0, 0.0),
                 gonio_i_remainder(&a, &b, 2.0, 0.0), 0.0);
    assert_close(gonio_i_stretch_remainder(&fibres, &a, &a, 2.0, 0.0),
                 gonio_i_remainder(&a, &a, 2.0, 0.0), 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_places_become_pairs_and_back),
        cmocka_unit_test(test_the_same_seed_draws_the_same_places),
        cmocka_unit_test(test_slopes_are_stretched),
        cmocka_unit_test(test_isotropic_lobes_stay),
        cmocka_unit_test(test_the_horizon_stays),
        cmocka_unit_test(test_azimuths_follow_the_symmetry),
        cmocka_unit_test(test_azimuths_are_mirrored_in_the_grain),
        cmocka_unit_test(test_azimuths_are_stretched),
        cmocka_unit_test(test_facets_keep_the_density_of_slopes),
        cmocka_unit_test(test_values_are_multiplied),
        cmocka_unit_test(test_fibres_see_the_sum_along_them),
        cmocka_unit_test(test_the_remainder_of_fibres_is_their_kernel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
