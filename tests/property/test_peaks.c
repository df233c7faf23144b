/* Narrow peaks may be longer across the plane of incidence than along it. */
#include "posterior_fixture.h"

#include <math.h>

static const double DEGREE = M_PI / 180.0;

static gonio_i_place place_at(double theta_h_deg, double theta_d_deg, double phi_d_deg)
{
    return gonio_i_place_of((gonio_half_difference){.theta_h = theta_h_deg * DEGREE,
                                                    .theta_d = theta_d_deg * DEGREE,
                                                    .phi_d = phi_d_deg * DEGREE});
}

/* The correlation that narrow peaks have between two azimuths of d. */
static double correlation(double theta_h_deg, double theta_d_deg, double phi_d_deg,
                          double other_deg)
{
    const gonio_i_place a = place_at(theta_h_deg, theta_d_deg, phi_d_deg);
    const gonio_i_place b = place_at(theta_h_deg, theta_d_deg, other_deg);
    return gonio_i_peaked(&a, &b) / sqrt(gonio_i_peaked(&a, &a) * gonio_i_peaked(&b, &b));
}

static void test_azimuths_matter_where_they_can(void **state)
{
    (void)state;
    assert_true(correlation(1.0, 65.0, 0.0, 90.0) < 0.2);
    assert_true(correlation(1.0, 65.0, 0.0, 15.0) > 0.7);
    assert_true(correlation(1.0, 5.0, 0.0, 90.0) > 0.9);
    assert_close(correlation(0.0, 65.0, 0.0, 90.0), 1.0, 1e-12);
    assert_close(correlation(1.0, 65.0, 20.0, 200.0), 1.0, 1e-12);
}

static void test_peaks_are_wider_at_oblique_incidence(void **state)
{
    (void)state;
    const gonio_i_place steep = place_at(1.0, 0.0, 0.0);
    const gonio_i_place oblique = place_at(2.0, acos(0.25) / DEGREE, 0.0);
    const gonio_i_place grazing = place_at(1.0, 90.0, 0.0);
    assert_close(steep.peak, exp(-0.5), 1e-12);
    assert_close(oblique.peak, steep.peak, 1e-12);
    assert_true(isfinite(grazing.peak) && grazing.peak > oblique.peak);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_azimuths_matter_where_they_can),
        cmocka_unit_test(test_peaks_are_wider_at_oblique_incidence),
    };
    return cmocka_run_group_tests_name("peaks", tests, fixture_set_up, fixture_tear_down);
}
