/* What every built-in material must satisfy: a name of its own, reciprocity, no negative light, no
 * more light out than in, and slabs that say the same as single values. */
#include <gonio/atlas.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../support.h"

static const double PI = 3.14159265358979323846;

enum { ROW = GONIO_PHI_D_BINS, SLAB = GONIO_THETA_D_BINS * GONIO_PHI_D_BINS };

static double slab[GONIO_CHANNELS * SLAB];

/* ---- The catalogue ---- */

static void test_names_are_unique_and_findable(void **state)
{
    (void)state;
    assert_true(gonio_atlas_count() >= 100);
    for (int i = 0; i < gonio_atlas_count(); i++) {
        const char *name = gonio_atlas_name(i);

        assert_non_null(name);
        assert_non_null(gonio_atlas_class(i));
        assert_int_equal(strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789-"), strlen(name));
        assert_int_equal(gonio_atlas_find(name), i); /* finds the first: so names are unique */
    }
}

/* Both can be learned from together. */
static void test_names_are_not_those_of_merl(void **state)
{
    (void)state;
    for (int k = 0; k < SUPPORT_MERL; k++) {
        assert_int_equal(gonio_atlas_find(support_merl[k]), -1);
    }
}

static void test_out_of_range_is_refused(void **state)
{
    const int outside[] = {-1, gonio_atlas_count()};
    const gonio_half_difference above = {0.1, 0.2, 0.3};
    (void)state;

    assert_int_equal(gonio_atlas_find("no-such-material"), -1);
    assert_int_equal(gonio_atlas_find(""), -1);
    for (int i = 0; i < 2; i++) {
        double rho[GONIO_CHANNELS] = {1.0, 1.0, 1.0};

        assert_null(gonio_atlas_name(outside[i]));
        assert_null(gonio_atlas_class(outside[i]));
        gonio_atlas_value(outside[i], above, rho);
        for (int c = 0; c < GONIO_CHANNELS; c++)
            assert_true(rho[c] == 0.0);
    }
}

/* ---- Pointwise properties ---- */

/* Uniform in [0, 1); Knuth's 64-bit linear congruential generator. */
static double uniform(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) * 0x1p-53;
}

/* A random point, theta_h crowding around the mirror direction as the bins do. */
static gonio_half_difference random_point(uint64_t *seed)
{
    double root = uniform(seed);
    double theta_d = uniform(seed) * PI / 2;

    return (gonio_half_difference){root * root * PI / 2, theta_d, uniform(seed) * PI};
}

/* Whether both directions stand clear of the horizon, so that the rounding of phi_d + pi (4e-16)
 * changes no cosine by more than 1e-13 of itself. */
static bool is_clear_of_horizon(gonio_half_difference point)
{
    double incident, outgoing;

    gonio_cosines(point, &incident, &outgoing);
    return incident > 5e-3 && outgoing > 5e-3;
}

static void test_swapping_directions_changes_nothing(void **state)
{
    uint64_t seed = 1;
    (void)state;

    for (int i = 0; i < gonio_atlas_count(); i++) {
        for (int n = 0; n < 1000; n++) {
            gonio_half_difference there = random_point(&seed), back = there;
            double rho[GONIO_CHANNELS], swapped[GONIO_CHANNELS];

            if (!is_clear_of_horizon(there))
                continue;
            back.phi_d += PI;
            gonio_atlas_value(i, there, rho);
            gonio_atlas_value(i, back, swapped);
            for (int c = 0; c < GONIO_CHANNELS; c++)
                assert_true(fabs(rho[c] - swapped[c]) <= 1e-12 * rho[c]);
        }
    }
}

static void assert_sound(int index, gonio_half_difference point)
{
    double rho[GONIO_CHANNELS], incident, outgoing;

    gonio_cosines(point, &incident, &outgoing);
    gonio_atlas_value(index, point, rho);
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        assert_true(isfinite(rho[c]) && rho[c] >= 0.0);
        if (!(incident > 0.0 && outgoing > 0.0))
            assert_true(rho[c] == 0.0);
    }
}

static void test_values_are_finite_and_not_negative(void **state)
{
    const double edges[] = {0.0, 1e-12, 1e-6, PI / 4, PI / 2 - 1e-6, PI / 2 - 1e-12, PI / 2};
    const int count = (int)(sizeof edges / sizeof edges[0]);
    uint64_t seed = 2;
    (void)state;

    for (int i = 0; i < gonio_atlas_count(); i++) {
        for (int n = 0; n < 2000; n++)
            assert_sound(i, random_point(&seed));
        for (int n = 0; n < count * count * count; n++)
            assert_sound(i, (gonio_half_difference){edges[n % count], edges[n / count % count],
                                                    2.0 * edges[n / (count * count)]});
    }
}

/* ---- Energy ---- */

/* A surface to integrate: what it reflects at a point, rho cos(theta_o) for each channel, 1/sr, and
 * whether it sends light below the horizon too. */
typedef struct reflector {
    void (*reflect)(const void *state, gonio_half_difference point, double incident,
                    double outgoing, double reflected[GONIO_CHANNELS]);
    const void *state;
    bool downwards;
} reflector;

/* Largest azimuth of h from i at which o is still above the horizon, 2 cd ch > ci; or, for a
 * surface that reflects downwards too, at which h still faces i, cd > 0. */
static double azimuth_limit(const reflector *surface, double theta_i, double theta_h)
{
    double facing = surface->downwards ? theta_h : 2.0 * theta_h;
    double least = -cos(theta_i) * cos(facing); /* of si sin(facing) cos(phi_h) */
    double reach = sin(theta_i) * sin(facing);

    return reach > 0.0 ? acos(fmax(-1.0, fmin(1.0, least / reach))) : (least < 0.0 ? PI : 0.0);
}

static gonio_half_difference point_at(double incident, double ch, double cd, double theta_h)
{
    double across = sqrt((1.0 - ch * ch) * fmax(0.0, 1.0 - cd * cd));
    double cos_phi_d = across > 0.0 ? (ch * cd - incident) / across : 1.0;

    return (gonio_half_difference){theta_h, acos(fmin(1.0, cd)),
                                   acos(fmax(-1.0, fmin(1.0, cos_phi_d)))};
}

/* Directional-hemispherical albedo, int rho co dw_o, as an integral over half vectors:
 * dw_o = 4 (i.h) dw_h (Walter et al. 2007, eq. 14). Midpoints, which crowd where the integrand
 * is steep: in theta_h as its cube root does at 0 (narrow lobes) and as a cosine does at the
 * largest theta_h, in phi_h as a sine does at the horizon; within the exact limits, so that no edge
 * is stepped over. */
static void albedo(const reflector *surface, double theta_i, int steps,
                   double total[GONIO_CHANNELS])
{
    const double incident = cos(theta_i), rows = 2.0 * steps;
    const double largest = surface->downwards ? PI / 2 : (PI / 2 + theta_i) / 2;

    total[0] = total[1] = total[2] = 0.0;
    for (int n = 0; n < 2 * steps * steps; n++) {
        double x = (n / steps + 0.5) / rows, bend = PI * x * sqrt(x);
        double theta_h = largest * 0.5 * (1.0 - cos(bend));
        double ch = cos(theta_h), sh = sin(theta_h);
        double limit = azimuth_limit(surface, theta_i, theta_h);
        double turn = (n % steps + 0.5) / steps * PI / 2, phi = limit * sin(turn);
        double cd = sin(theta_i) * sh * cos(phi) + incident * ch;
        double dtheta = largest * 0.5 * sin(bend) * 1.5 * PI * sqrt(x) / rows;
        double dphi = 2.0 * limit * cos(turn) * (PI / 2 / steps); /* 2: phi and -phi */
        double reflected[GONIO_CHANNELS];

        if (!(limit > 0.0 && cd > 0.0))
            continue;
        surface->reflect(surface->state, point_at(incident, ch, cd, theta_h), incident,
                         2.0 * cd * ch - incident, reflected);
        for (int c = 0; c < GONIO_CHANNELS; c++)
            total[c] += reflected[c] * 4.0 * cd * sh * dtheta * dphi;
    }
}

static void reflect_material(const void *state, gonio_half_difference point, double incident,
                             double outgoing, double reflected[GONIO_CHANNELS])
{
    (void)incident;
    gonio_atlas_value(*(const int *)state, point, reflected);
    for (int c = 0; c < GONIO_CHANNELS; c++)
        reflected[c] *= outgoing;
}

static void material_albedo(int index, double theta_i, int steps, double total[GONIO_CHANNELS])
{
    const reflector surface = {reflect_material, &index, false};

    albedo(&surface, theta_i, steps, total);
}

/* Lossless facets without shadowing, D G1(i) / (4 ci): every ray leaves, though some downwards, so
 * that the integral over all half vectors is 1 for any width and incidence (the weak white furnace
 * of Heitz 2014). GGX, one alpha a channel. */
static void reflect_furnace(const void *state, gonio_half_difference point, double incident,
                            double outgoing, double reflected[GONIO_CHANNELS])
{
    const double *alpha = state;
    double slope = tan(point.theta_h), ch = cos(point.theta_h);
    double tan2 = 1.0 / (incident * incident) - 1.0;
    (void)outgoing;

    for (int c = 0; c < GONIO_CHANNELS; c++) {
        double a2 = alpha[c] * alpha[c], tail = 1.0 + slope * slope / a2;
        double density = 1.0 / (PI * a2 * ch * ch * ch * ch * tail * tail);
        double masking = 2.0 / (1.0 + sqrt(1.0 + a2 * tan2));
        reflected[c] = density * masking / (4.0 * incident);
    }
}

static void reflect_lambert(const void *state, gonio_half_difference point, double incident,
                            double outgoing, double reflected[GONIO_CHANNELS])
{
    (void)state, (void)point, (void)incident;
    for (int c = 0; c < GONIO_CHANNELS; c++)
        reflected[c] = outgoing / PI;
}

enum { STEPS = 40 };

static double radians(int degrees)
{
    return degrees * PI / 180.0;
}

/* The quadrature itself, against integrals that are known to be 1. */
static void test_quadrature_is_exact_to_a_thousandth(void **state)
{
    const double alpha[GONIO_CHANNELS] = {0.01, 0.1, 0.9};
    const reflector furnace = {reflect_furnace, alpha, true};
    const reflector lambertian = {reflect_lambert, NULL, false};
    (void)state;

    for (int degrees = 0; degrees < 90; degrees++) {
        double mirror[GONIO_CHANNELS], lambert[GONIO_CHANNELS];

        albedo(&furnace, radians(degrees), STEPS, mirror);
        albedo(&lambertian, radians(degrees), STEPS, lambert);
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            assert_true(fabs(mirror[c] - 1.0) < 1e-3);
            assert_true(fabs(lambert[c] - 1.0) < 1e-3);
        }
    }
}

static void test_quadrature_has_converged(void **state)
{
    const int degrees[] = {0, 75, 89};
    (void)state;

    for (int i = 0; i < gonio_atlas_count(); i++) {
        for (int n = 0; n < 3; n++) {
            double coarse[GONIO_CHANNELS], fine[GONIO_CHANNELS];

            material_albedo(i, radians(degrees[n]), STEPS, coarse);
            material_albedo(i, radians(degrees[n]), 2 * STEPS, fine);
            for (int c = 0; c < GONIO_CHANNELS; c++)
                assert_true(fabs(coarse[c] - fine[c]) < 1e-3);
        }
    }
}

static void test_no_material_reflects_more_than_it_receives(void **state)
{
    const int degrees[] = {0, 15, 30, 45, 60, 70, 78, 84, 87, 88, 89};
    const int count = (int)(sizeof degrees / sizeof degrees[0]);
    (void)state;

    for (int i = 0; i < gonio_atlas_count(); i++) {
        for (int n = 0; n < count; n++) {
            double total[GONIO_CHANNELS];

            material_albedo(i, radians(degrees[n]), STEPS, total);
            for (int c = 0; c < GONIO_CHANNELS; c++)
                assert_true(total[c] > 0.0 && total[c] <= 1.0);
        }
    }
}

/* Random materials are as the named ones; those that a basis learns from, and a few more. */
static void test_random_materials_are_plausible(void **state)
{
    const int degrees[] = {0, 45, 75, 85, 89};
    char name[32];
    uint64_t seed = 3;
    (void)state;
    for (int k = 0; k < GONIO_ATLAS_RANDOM_COUNT; k += k < 210 ? 3 : 1399) {
        snprintf(name, sizeof name, "random-%04d", k);
        assert_int_equal(gonio_atlas_find(name), GONIO_ATLAS_RANDOM + k);
        assert_string_equal(gonio_atlas_class(GONIO_ATLAS_RANDOM + k), "random");
        for (size_t n = 0; n < sizeof degrees / sizeof *degrees; n++) {
            double total[GONIO_CHANNELS];
            material_albedo(GONIO_ATLAS_RANDOM + k, radians(degrees[n]), STEPS, total);
            for (int c = 0; c < GONIO_CHANNELS; c++)
                assert_true(total[c] > 0.0 && total[c] <= 1.0);
        }
        const gonio_half_difference at = random_point(&seed);
        double rho[GONIO_CHANNELS];
        gonio_atlas_value(GONIO_ATLAS_RANDOM + k, at, rho);
        for (int c = 0; c < GONIO_CHANNELS; c++)
            assert_true(isfinite(rho[c]) && rho[c] >= 0.0);
    }
    static const char *const none[] = {"random-", "random-1", "random-00000", "random-000x",
                                       "random--001"};
    for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
        assert_int_equal(gonio_atlas_find(none[k]), -1);
    }
    assert_null(gonio_atlas_class(GONIO_ATLAS_RANDOM + GONIO_ATLAS_RANDOM_COUNT));
}

/* ---- Slabs ---- */

static void test_slab_agrees_with_value(void **state)
{
    (void)state;
    for (int i = 0; i < gonio_atlas_count(); i++) {
        int theta_h = 7 * i % GONIO_THETA_H_BINS;

        gonio_atlas_slab(i, theta_h, slab);
        for (int n = i % 7; n < SLAB; n += 7) {
            gonio_bin bin = {theta_h, n / ROW, n % ROW};
            double rho[GONIO_CHANNELS];

            if (!gonio_bin_is_valid(bin))
                continue;
            gonio_atlas_value(i, gonio_bin_centre(bin), rho);
            for (int c = 0; c < GONIO_CHANNELS; c++)
                assert_true(fabs(slab[c * SLAB + n] - rho[c]) <= 1e-9 * rho[c]);
        }
    }
}

/* How many bins of the slab are valid; fails if a channel disagrees with gonio_bin_is_valid. */
static int count_valid(int theta_h)
{
    int valid = 0;

    for (int n = 0; n < SLAB; n++) {
        bool is_valid = gonio_bin_is_valid((gonio_bin){theta_h, n / ROW, n % ROW});

        for (int c = 0; c < GONIO_CHANNELS; c++) {
            double rho = slab[c * SLAB + n];
            assert_true(is_valid ? isfinite(rho) && rho >= 0.0 : rho == -1.0);
        }
        valid += is_valid;
    }
    return valid;
}

/* Few directions are looked up in the rows that they need: the values of the whole table. */
static void test_few_directions_have_the_values_of_the_table(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    assert_int_equal(gonio_material_open(NULL, "atlas:random-0007", &material), GONIO_OK);
    assert_int_equal(gonio_table_load(NULL, material, &table), GONIO_OK);
    for (int k = 0; k < 200; k++) {
        const gonio_pair pair = {{k * 0.0078, 0.3}, {(k * 37 % 200) * 0.0078, 0.3 + k * 0.11}};
        double expected[GONIO_CHANNELS];
        double value[GONIO_CHANNELS];
        assert_true(gonio_table_value(table, gonio_half_difference_from_pair(pair), expected));
        assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, value), GONIO_OK);
        assert_memory_equal(value, expected, sizeof value);
    }
    gonio_table_free(&table);
    gonio_material_free(&material);
}

static void test_slab_marks_invalid_bins(void **state)
{
    int valid = 0;
    (void)state;

    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h++) {
        gonio_atlas_slab(theta_h % gonio_atlas_count(), theta_h, slab);
        valid += count_valid(theta_h);
    }
    assert_int_equal(valid, 1096216);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_are_unique_and_findable),
        cmocka_unit_test(test_names_are_not_those_of_merl),
        cmocka_unit_test(test_out_of_range_is_refused),
        cmocka_unit_test(test_swapping_directions_changes_nothing),
        cmocka_unit_test(test_values_are_finite_and_not_negative),
        cmocka_unit_test(test_quadrature_is_exact_to_a_thousandth),
        cmocka_unit_test(test_quadrature_has_converged),
        cmocka_unit_test(test_no_material_reflects_more_than_it_receives),
        cmocka_unit_test(test_random_materials_are_plausible),
        cmocka_unit_test(test_slab_agrees_with_value),
        cmocka_unit_test(test_slab_marks_invalid_bins),
        cmocka_unit_test(test_few_directions_have_the_values_of_the_table),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
