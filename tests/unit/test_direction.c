/* Directions, bins and the interpolation between their centres. */
#include "../support.h"

#include <math.h>

#include <gonio/direction.h>

#include "core/random.h"
#include "direction/grid.h"

enum { PAIRS = 200000, VALID_BINS = 1096216 };

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

/* Directions above the horizon, uniform in the angles. */
static gonio_pair random_pair(gonio_i_random *random)
{
    const double polar = M_PI / 2.0;
    const double turn = 2.0 * M_PI;
    return (gonio_pair){
        {polar * gonio_i_random_uniform(random), turn * gonio_i_random_uniform(random)},
        {polar * gonio_i_random_uniform(random), turn * gonio_i_random_uniform(random)}};
}

/* phi_d counts for less the closer h is to the normal and d to h. */
static void assert_same_coordinates(gonio_half_difference a, gonio_half_difference b)
{
    const double turn = fabs(a.phi_d - b.phi_d);
    assert_close(a.theta_h, b.theta_h, 1e-12);
    assert_close(a.theta_d, b.theta_d, 1e-12);
    assert_close(fmin(turn, M_PI - turn) * sin(a.theta_h) * sin(a.theta_d), 0.0, 1e-12);
}

static double dot(gonio_angles a, gonio_angles b)
{
    return sin(a.theta) * sin(b.theta) * cos(a.phi - b.phi) + cos(a.theta) * cos(b.theta);
}

/* By definition: |i + o|^2 = 2 + 2 i.o, h.z = (i.z + o.z)/|i + o|, i.h = |i + o|/2. */
static void test_coordinates_agree_with_vectors(void **state)
{
    (void)state;
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, 0);
    for (int k = 0; k < PAIRS; k++) {
        const gonio_pair pair = random_pair(&random);
        const gonio_half_difference c = gonio_half_difference_from_pair(pair);
        const double length = sqrt(fmax(0.0, 2.0 + 2.0 * dot(pair.incident, pair.outgoing)));
        const double up = cos(pair.incident.theta) + cos(pair.outgoing.theta);
        assert_true(c.phi_d >= 0.0 && c.phi_d < M_PI);
        assert_close(cos(c.theta_d), length / 2.0, 1e-12);
        assert_close(cos(c.theta_h) * length, up, 1e-12);
        double incident = 0.0;
        double outgoing = 0.0;
        gonio_cosines(c, &incident, &outgoing);
        assert_close(incident + outgoing, up, 1e-12);
        assert_close(incident * outgoing, cos(pair.incident.theta) * cos(pair.outgoing.theta),
                     1e-12);
    }
}

static void test_pairs_and_coordinates_go_round(void **state)
{
    (void)state;
    gonio_i_random random;
    gonio_i_random_seed(&random, 2, 0);
    for (int k = 0; k < PAIRS; k++) {
        const gonio_pair pair = random_pair(&random);
        const gonio_half_difference c = gonio_half_difference_from_pair(pair);
        const gonio_pair back = gonio_pair_from_half_difference(c);
        assert_close(dot(back.incident, back.outgoing), dot(pair.incident, pair.outgoing), 1e-12);
        assert_same_coordinates(gonio_half_difference_from_pair(back), c);
    }
}

static void test_light_and_view_may_be_swapped(void **state)
{
    (void)state;
    gonio_i_random random;
    gonio_i_random_seed(&random, 3, 0);
    for (int k = 0; k < PAIRS; k++) {
        const gonio_pair pair = random_pair(&random);
        const gonio_pair swapped = {pair.outgoing, pair.incident};
        assert_same_coordinates(gonio_half_difference_from_pair(swapped),
                                gonio_half_difference_from_pair(pair));
    }
}

static void test_turning_both_directions_changes_nothing(void **state)
{
    (void)state;
    gonio_i_random random;
    gonio_i_random_seed(&random, 4, 0);
    for (int k = 0; k < PAIRS; k++) {
        const gonio_pair pair = random_pair(&random);
        gonio_pair turned = pair;
        turned.incident.phi += 1.0;
        turned.outgoing.phi += 1.0;
        assert_same_coordinates(gonio_half_difference_from_pair(turned),
                                gonio_half_difference_from_pair(pair));
    }
}

static void test_special_directions(void **state)
{
    (void)state;
    const gonio_angles up = {0.0, 0.0};
    const gonio_angles east = {M_PI / 2.0, 0.0};
    const gonio_angles west = {M_PI / 2.0, M_PI};
    gonio_half_difference c = gonio_half_difference_from_pair((gonio_pair){up, up});
    assert_true(c.theta_h == 0.0 && c.theta_d == 0.0 && c.phi_d == 0.0);
    c = gonio_half_difference_from_pair((gonio_pair){east, west});
    assert_true(c.theta_h == 0.0);
    assert_close(c.theta_d, M_PI / 2.0, 1e-15);
    c = gonio_half_difference_from_pair((gonio_pair){east, up});
    assert_close(c.theta_h, M_PI / 4.0, 1e-15);
    assert_close(c.theta_d, M_PI / 4.0, 1e-15);
}

static void test_every_bin(void **state)
{
    (void)state;
    int valid = 0;
    for (int32_t index = 0; index < GONIO_BINS; index++) {
        const gonio_bin bin = gonio_bin_from_index(index);
        const gonio_half_difference centre = gonio_bin_centre(bin);
        const gonio_bin found = gonio_bin_of(centre);
        const int first = gonio_i_first_valid_phi(bin.theta_h, bin.theta_d);
        const bool is_valid = gonio_bin_is_valid(bin);
        assert_int_equal(gonio_bin_index(bin), index);
        assert_int_equal(gonio_bin_index(found), index);
        assert_int_equal(is_valid, bin.phi_d >= first && bin.phi_d < GONIO_PHI_D_BINS - first);
        valid += is_valid;
        if (index % 7 == 0) {
            const gonio_pair pair = gonio_pair_from_half_difference(centre);
            double incident = 0.0;
            double outgoing = 0.0;
            gonio_cosines(centre, &incident, &outgoing);
            assert_close(cos(pair.incident.theta), incident, 1e-14);
            assert_close(cos(pair.outgoing.theta), outgoing, 1e-14);
        }
    }
    assert_int_equal(valid, VALID_BINS);
}

static void test_bins_at_the_edges(void **state)
{
    (void)state;
    const gonio_bin right_angle = gonio_bin_of((gonio_half_difference){0.3, 0.3, M_PI / 2.0});
    const gonio_bin low = gonio_bin_of((gonio_half_difference){-1.0, -1.0, 0.0});
    const gonio_bin high = gonio_bin_of((gonio_half_difference){2.0, 2.0, M_PI - 1e-12});
    assert_int_equal(right_angle.phi_d, 90);
    assert_int_equal(gonio_bin_index(low), 0);
    assert_int_equal(high.theta_h, 89);
    assert_int_equal(high.theta_d, 89);
    assert_int_equal(high.phi_d, 0); /* the same sample as phi_d = 0 */
}

/* ---- interpolation ---- */

/* A function that is linear where the stencils are. */
static double linear(gonio_half_difference c)
{
    return 2.0 + 3.0 * sqrt(c.theta_h) - 5.0 * c.theta_d + 7.0 * c.phi_d;
}

/* A point between the first and the last centre. */
static gonio_half_difference random_inside(gonio_i_random *random)
{
    const double root = (0.5 + 89.0 * gonio_i_random_uniform(random)) / 90.0;
    return (gonio_half_difference){
        root * root * M_PI / 2.0, (0.5 + 89.0 * gonio_i_random_uniform(random)) / 90.0 * M_PI / 2.0,
        (0.5 + 179.0 * gonio_i_random_uniform(random)) / 180.0 * M_PI};
}

static void test_interpolation_is_exact_for_linear_functions(void **state)
{
    (void)state;
    gonio_i_random random;
    gonio_i_random_seed(&random, 5, 0);
    for (int k = 0; k < PAIRS; k++) {
        gonio_half_difference c = random_inside(&random);
        gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
        double weight = 0.0;
        double value = 0.0;
        gonio_i_trilinear(c, stencil);
        for (int j = 0; j < GONIO_I_TRILINEAR; j++) {
            assert_true(stencil[j].weight >= 0.0);
            weight += stencil[j].weight;
            value += stencil[j].weight * linear(gonio_bin_centre(stencil[j].bin));
        }
        assert_close(weight, 1.0, 1e-14);
        assert_close(value, linear(c), 1e-11);
        weight = 0.0;
        value = 0.0;
        gonio_i_bilinear(c, stencil);
        for (int j = 0; j < GONIO_I_BILINEAR; j++) {
            assert_true(stencil[j].weight >= 0.0);
            assert_int_equal(stencil[j].bin.phi_d, 0);
            weight += stencil[j].weight;
            value += stencil[j].weight * linear(gonio_bin_centre(stencil[j].bin));
        }
        c.phi_d = gonio_bin_centre((gonio_bin){0, 0, 0}).phi_d;
        assert_close(weight, 1.0, 1e-14);
        assert_close(value, linear(c), 1e-12);
    }
}

static void test_interpolation_at_the_edges(void **state)
{
    (void)state;
    const gonio_half_difference points[] = {
        {5e-5, 0.01, 0.0}, {M_PI / 2.0, M_PI / 2.0, M_PI - 1e-9}, {5e-5, M_PI / 2.0, 0.0}};
    for (size_t k = 0; k < sizeof points / sizeof *points; k++) {
        gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
        double first = 0.0;
        double last = 0.0;
        gonio_i_trilinear(points[k], stencil);
        for (int j = 0; j < GONIO_I_TRILINEAR; j++) {
            const gonio_bin bin = stencil[j].bin;
            assert_in_range(bin.theta_h, 0, 89);
            assert_in_range(bin.theta_d, 0, 89);
            first += bin.phi_d == 0 ? stencil[j].weight : 0.0;
            last += bin.phi_d == 179 ? stencil[j].weight : 0.0;
        }
        assert_close(first, 0.5, 1e-6); /* phi_d = 0 lies between the last and the first bin */
        assert_close(last, 0.5, 1e-6);
    }
}

/* Where phi_d means nothing it does not matter, and it comes to matter without a jump. */
static void test_interpolation_at_the_poles(void **state)
{
    (void)state;
    static const gonio_half_difference poles[] = {
        {0.0, 0.8, 0.0}, {0.6, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    for (size_t k = 0; k < 3 * GONIO_SECTORS; k++) {
        gonio_half_difference c = poles[k / GONIO_SECTORS];
        gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
        double sum[2][2] = {{0.0}};
        c.phi_d = 0.1 + (double)(k % GONIO_SECTORS) * M_PI / GONIO_SECTORS;
        for (int near = 0; near < 2; near++) {
            c.theta_h = near == 1 && poles[k / GONIO_SECTORS].theta_h == 0.0 ? 1e-9 : c.theta_h;
            c.theta_d = near == 1 && poles[k / GONIO_SECTORS].theta_d == 0.0 ? 1e-9 : c.theta_d;
            const int points = gonio_i_trilinear(c, stencil);
            for (int j = 0; j < points; j++) {
                sum[near][0] += stencil[j].weight;
                sum[near][1] +=
                    stencil[j].weight * cos(2.0 * gonio_bin_centre(stencil[j].bin).phi_d);
            }
            assert_close(sum[near][0], 1.0, 1e-14);
            assert_close(sum[near][1], 0.0, near == 1 ? 1e-4 : 1e-14);
        }
    }
    gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
    const gonio_half_difference first = gonio_bin_centre((gonio_bin){0, 0, 7});
    assert_int_equal(gonio_i_trilinear(first, stencil), GONIO_I_TRILINEAR);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coordinates_agree_with_vectors),
        cmocka_unit_test(test_pairs_and_coordinates_go_round),
        cmocka_unit_test(test_light_and_view_may_be_swapped),
        cmocka_unit_test(test_turning_both_directions_changes_nothing),
        cmocka_unit_test(test_special_directions),
        cmocka_unit_test(test_every_bin),
        cmocka_unit_test(test_bins_at_the_edges),
        cmocka_unit_test(test_interpolation_is_exact_for_linear_functions),
        cmocka_unit_test(test_interpolation_at_the_poles),
        cmocka_unit_test(test_interpolation_at_the_edges),
    };
    return cmocka_run_group_tests_name("direction", tests, NULL, NULL);
}
