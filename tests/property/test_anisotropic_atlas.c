/* What every built-in anisotropic material must satisfy: a name of its own, reciprocity, the
 * symmetry that is stated, values that depend on the azimuth of the sample, no negative light, and
 * no more light out than in at any incidence and azimuth. */
#include <gonio/atlas.h>
#include <gonio/material.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../support.h"

static const double PI = 3.14159265358979323846;

enum { ENOUGH = 16 };

/* ---- The catalogue ---- */

static void test_names(void **state)
{
    (void)state;
    assert_true(gonio_atlas_anisotropic_count() >= ENOUGH);
    for (int k = 0; k < gonio_atlas_anisotropic_count(); k++) {
        const char *name = gonio_atlas_anisotropic_name(k);
        assert_int_equal(strspn(name, "abcdefghijklmnopqrstuvwxyz-"), strlen(name));
        assert_int_equal(gonio_atlas_anisotropic_find(name), k);
        assert_int_equal(gonio_atlas_find(name), -1);
    }
    assert_int_equal(gonio_atlas_anisotropic_find("gold-polished"), -1);
    assert_int_equal(gonio_atlas_anisotropic_find(NULL), -1);
    assert_int_equal(gonio_atlas_anisotropic_symmetry(-1), 0);
    assert_null(gonio_atlas_anisotropic_class(gonio_atlas_anisotropic_count()));
}

/* ---- Pointwise properties ---- */

/* Uniform in [0, 1); Knuth's 64-bit linear congruential generator. */
static double uniform(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) * 0x1p-53;
}

static gonio_pair random_pair(uint64_t *seed)
{
    const double limit = 0.49 * PI;
    const double a = uniform(seed) * limit;
    const double b = uniform(seed) * limit;
    return (gonio_pair){{a, uniform(seed) * 2.0 * PI}, {b, uniform(seed) * 2.0 * PI}};
}

static gonio_pair turned(gonio_pair pair, double angle)
{
    pair.incident.phi += angle;
    pair.outgoing.phi += angle;
    return pair;
}

/* The largest relative difference of a channel. */
static double difference(int index, gonio_pair a, gonio_pair b)
{
    double first[GONIO_CHANNELS];
    double second[GONIO_CHANNELS];
    double most = 0.0;
    gonio_atlas_anisotropic_value(index, a, first);
    gonio_atlas_anisotropic_value(index, b, second);
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        assert_true(isfinite(first[c]) && first[c] > 0.0);
        most = fmax(most, fabs(first[c] - second[c]) / first[c]);
    }
    return most;
}

static void test_swapping_directions_changes_nothing(void **state)
{
    uint64_t seed = 1;
    (void)state;
    for (int k = 0; k < gonio_atlas_anisotropic_count(); k++) {
        for (int n = 0; n < 1000; n++) {
            const gonio_pair pair = random_pair(&seed);
            assert_true(difference(k, pair, (gonio_pair){pair.outgoing, pair.incident}) < 1e-10);
        }
    }
}

/* The stated rotation changes nothing, half of it does. */
static void test_symmetry(void **state)
{
    uint64_t seed = 2;
    (void)state;
    for (int k = 0; k < gonio_atlas_anisotropic_count(); k++) {
        const int symmetry = gonio_atlas_anisotropic_symmetry(k);
        const double least = 2.0 * PI / symmetry;
        double half = 0.0;
        for (int n = 0; n < 1000; n++) {
            const gonio_pair pair = random_pair(&seed);
            assert_true(difference(k, pair, turned(pair, least)) < 1e-10);
            half = fmax(half, difference(k, pair, turned(pair, 0.5 * least)));
        }
        assert_true(symmetry == 1 || symmetry == 2 || symmetry == 4);
        assert_true(half > 0.2);
    }
}

static void test_values_are_finite_and_not_negative(void **state)
{
    static const double theta[] = {0.0, 1e-9, 0.3, 1.2, 1.57, 1.5707963};
    enum { THETAS = sizeof theta / sizeof *theta, PHIS = 5 };
    (void)state;
    for (int k = 0; k < gonio_atlas_anisotropic_count(); k++) {
        for (int n = 0; n < THETAS * THETAS * PHIS; n++) {
            const double phi = 0.5 * PI * (n % PHIS);
            const gonio_pair pair = {{theta[n / PHIS % THETAS], 0.1},
                                     {theta[n / PHIS / THETAS], phi}};
            double rho[GONIO_CHANNELS];
            gonio_atlas_anisotropic_value(k, pair, rho);
            for (int c = 0; c < GONIO_CHANNELS; c++) {
                assert_true(isfinite(rho[c]) && rho[c] >= 0.0);
            }
        }
    }
}

static void test_below_the_horizon_is_dark(void **state)
{
    const gonio_pair below = {{0.2, 0.0}, {1.6, 0.0}};
    const gonio_pair above = {{0.2, 0.0}, {0.3, 0.0}};
    double rho[GONIO_CHANNELS] = {1.0, 1.0, 1.0};
    (void)state;
    gonio_atlas_anisotropic_value(0, below, rho);
    assert_true(rho[0] == 0.0 && rho[1] == 0.0 && rho[2] == 0.0);
    rho[0] = 1.0;
    gonio_atlas_anisotropic_value(gonio_atlas_anisotropic_count(), above, rho);
    assert_true(rho[0] == 0.0);
}

/* ---- Energy ---- */

/* Light from theta_i at azimuth phi_i, mirrored at a half vector. */
static gonio_pair mirrored(gonio_angles in, double theta_h, double phi_h, double *cosine_d)
{
    const double i[3] = {sin(in.theta) * cos(in.phi), sin(in.theta) * sin(in.phi), cos(in.theta)};
    const double h[3] = {sin(theta_h) * cos(phi_h), sin(theta_h) * sin(phi_h), cos(theta_h)};
    const double d = i[0] * h[0] + i[1] * h[1] + i[2] * h[2];
    const double o[3] = {2.0 * d * h[0] - i[0], 2.0 * d * h[1] - i[1], 2.0 * d * h[2] - i[2]};
    *cosine_d = d;
    return (gonio_pair){in, {atan2(hypot(o[0], o[1]), o[2]), atan2(o[1], o[0])}};
}

/* Directional-hemispherical albedo as an integral over half vectors, dw_o = 4 (i.h) dw_h, by
 * midpoints that crowd around theta_h = 0. */
static void albedo(int index, gonio_angles in, int steps, double total[GONIO_CHANNELS])
{
    total[0] = total[1] = total[2] = 0.0;
    const double largest = 0.5 * (0.5 * PI + in.theta);
    for (int n = 0; n < 2 * steps * steps; n++) {
        const double x = (n / (2 * steps) + 0.5) / steps;
        const double theta_h = x * x * largest;
        const double phi_h = (n % (2 * steps) + 0.5) * PI / steps;
        double cosine_d = 0.0;
        double rho[GONIO_CHANNELS];
        const gonio_pair pair = mirrored(in, theta_h, phi_h, &cosine_d);
        const double area = sin(theta_h) * 2.0 * x * largest / steps * PI / steps * 4.0 * cosine_d;
        gonio_atlas_anisotropic_value(index, pair, rho);
        for (int c = 0; c < GONIO_CHANNELS && cosine_d > 0.0; c++) {
            total[c] += rho[c] * cos(pair.outgoing.theta) * area;
        }
    }
}

enum { STEPS = 48 };

static void test_no_material_reflects_more_than_it_receives(void **state)
{
    static const double incidence[] = {0.0, 20.0, 45.0, 65.0, 76.0, 82.0, 86.0, 88.5};
    enum { INCIDENCES = sizeof incidence / sizeof *incidence, AZIMUTHS = 4 };
    const int azimuths = support_small() ? 2 : AZIMUTHS;
    (void)state;
    for (int k = 0; k < gonio_atlas_anisotropic_count(); k++) {
        for (int n = 0; n < INCIDENCES * azimuths; n++) {
            const gonio_angles in = {incidence[n / azimuths] * PI / 180.0,
                                     PI * (n % azimuths) / azimuths};
            double total[GONIO_CHANNELS];
            albedo(k, in, STEPS, total);
            for (int c = 0; c < GONIO_CHANNELS; c++) {
                if (!(total[c] > 0.0 && total[c] <= 1.0)) {
                    print_error("%s: %g of the light from %g degrees, azimuth %g\n",
                                gonio_atlas_anisotropic_name(k), total[c], incidence[n / azimuths],
                                in.phi * 180.0 / PI);
                    fail();
                }
            }
        }
    }
}

static void test_quadrature_has_converged(void **state)
{
    static const double incidence[] = {0.0, 60.0, 86.0};
    (void)state;
    for (int k = 0; k < gonio_atlas_anisotropic_count(); k++) {
        for (int n = 0; n < 3; n++) {
            const gonio_angles in = {incidence[n] * PI / 180.0, 0.4};
            double coarse[GONIO_CHANNELS];
            double fine[GONIO_CHANNELS];
            albedo(k, in, STEPS, coarse);
            albedo(k, in, 3 * STEPS / 2, fine);
            for (int c = 0; c < GONIO_CHANNELS; c++) {
                assert_true(fabs(coarse[c] - fine[c]) < 5e-3);
            }
        }
    }
}

/* ---- As materials ---- */

static void test_materials(void **state)
{
    const gonio_pair pair = {{0.5, 0.2}, {0.6, 3.0}};
    (void)state;
    for (int k = 0; k < gonio_atlas_anisotropic_count(); k++) {
        char path[64];
        gonio_material *material = NULL;
        double rho[GONIO_CHANNELS];
        double same[GONIO_CHANNELS];
        snprintf(path, sizeof path, "atlas:%s", gonio_atlas_anisotropic_name(k));
        assert_int_equal(gonio_material_open(NULL, path, &material), GONIO_OK);
        assert_true(gonio_material_describe(material)->anisotropic);
        assert_true(gonio_material_describe(material)->evaluated);
        assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, rho), GONIO_OK);
        gonio_atlas_anisotropic_value(k, pair, same);
        assert_memory_equal(rho, same, sizeof rho);
        gonio_material_free(&material);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_swapping_directions_changes_nothing),
        cmocka_unit_test(test_symmetry),
        cmocka_unit_test(test_values_are_finite_and_not_negative),
        cmocka_unit_test(test_below_the_horizon_is_dark),
        cmocka_unit_test(test_quadrature_has_converged),
        cmocka_unit_test(test_no_material_reflects_more_than_it_receives),
        cmocka_unit_test(test_materials),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
