/* Materials in the formats of other databases: made files with known values, and files that lie. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/material.h>

#include "core/random.h"
#include "material/tensor_write.h"
#include "material_files.h"
#include "mutations.h"

enum { PHIS = 5, DIFFERENCES = 4, HALVES = 4, LINES = 2 };

/* Linear in the coordinates, so that interpolation between nodes is exact. */
static double kaist_value(double phi_d, double theta_d, double theta_h, size_t line)
{
    return 0.5 + 0.1 * phi_d + 0.2 * theta_d + 0.3 * theta_h + 0.01 * (double)line;
}

static void make_kaist(const char *path, double hole)
{
    static float m[PHIS][DIFFERENCES][HALVES][LINES][16];
    for (size_t p = 0; p < PHIS; p++) {
        for (size_t d = 0; d < DIFFERENCES; d++) {
            for (size_t h = 0; h < HALVES; h++) {
                for (size_t c = 0; c < LINES; c++) {
                    for (size_t k = 1; k < 16; k++) {
                        m[p][d][h][c][k] = -77.0F;
                    }
                    m[p][d][h][c][0] =
                        (float)kaist_value(((double)p / (PHIS - 1) * 2.0 - 1.0) * M_PI,
                                           (double)d / (DIFFERENCES - 1) * M_PI / 2.0,
                                           (double)h / (HALVES - 1) * M_PI / 2.0, c);
                }
            }
        }
    }
    if (!isinf(hole)) {
        m[3][1][1][0][0] = (float)hole;
    }
    const uint16_t wavelength[LINES] = {450, 622};
    const gonio_i_tensor_field fields[] = {
        {"theta_d", GONIO_I_TENSOR_F32, 2, {0, DIFFERENCES}, m},
        {"theta_h", GONIO_I_TENSOR_F32, 2, {0, HALVES}, m},
        {"phi_d", GONIO_I_TENSOR_F32, 2, {0, PHIS}, m},
        {"wvls", GONIO_I_TENSOR_U16, 1, {LINES}, wavelength},
        {"M", GONIO_I_TENSOR_F32, 6, {PHIS, DIFFERENCES, HALVES, LINES, 4, 4}, m},
    };
    assert_int_equal(gonio_i_tensor_write(NULL, path, fields, 5), GONIO_OK);
}

static void test_kaist(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.pbsdf", folder);
    make_kaist(path, INFINITY);
    gonio_material *material = open_good(path);
    const gonio_material_view *view = gonio_material_describe(material);
    assert_int_equal(view->channels, LINES);
    assert_true(view->wavelength[0] == 450.0 && view->wavelength[1] == 622.0);
    assert_false(view->anisotropic);
    for (int k = 1; k < 12; k++) {
        const gonio_half_difference at = {0.03 * k, 0.6 - 0.04 * k, 0.25 * k};
        gonio_pair pair = gonio_pair_from_half_difference(at);
        const gonio_pair back = {pair.outgoing, pair.incident};
        double values[LINES];
        pair.incident.phi += 1.0; /* isotropic */
        pair.outgoing.phi += 1.0;
        assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, values), GONIO_OK);
        for (size_t c = 0; c < LINES; c++) {
            const double expected = kaist_value(at.phi_d, at.theta_d, at.theta_h, c);
            assert_true(fabs(values[c] - expected) < 1e-6);
        }
        assert_int_equal(gonio_material_evaluate(NULL, material, &back, 1, values), GONIO_OK);
        const double expected = kaist_value(at.phi_d - M_PI, at.theta_d, at.theta_h, 0);
        assert_true(fabs(values[0] - expected) < 1e-6);
    }
    gonio_material_free(&material);
    check_mutations(path, folder);
    support_remove(folder);
}

/* A node without data: the others stand in for it, and at the node itself there is nothing. */
static void test_kaist_without_data(void **state)
{
    (void)state;
    static const double holes[] = {0.0, NAN};
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.pbsdf", folder);
    for (int k = 0; k < 2; k++) {
        make_kaist(path, holes[k]);
        gonio_material *material = open_good(path);
        const gonio_pair pair = gonio_pair_from_half_difference(
            (gonio_half_difference){M_PI / 6.0, M_PI / 6.0, M_PI / 2.0});
        double values[LINES];
        assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, values), GONIO_OK);
        /* rounding puts a trace of the weight on nodes around */
        assert_true(isnan(values[0]) || fabs(values[0] - values[1]) < 0.5);
        assert_true(fabs(values[1] - kaist_value(M_PI / 2.0, M_PI / 6.0, M_PI / 6.0, 1)) < 1e-6);
        gonio_material_free(&material);
    }
    support_remove(folder);
}

enum { UTIA_DIRECTIONS = 288, UTIA_VALUES = 3 * 288 * 288 };

static double utia_value(size_t channel, size_t in, size_t out)
{
    return 0.01 * (double)(channel + 1) + 1e-4 * (double)in + 1e-7 * (double)out;
}

static double *make_utia(double unit)
{
    double *values = malloc(UTIA_VALUES * sizeof *values);
    assert_non_null(values);
    for (size_t k = 0; k < UTIA_VALUES; k++) {
        values[k] = unit * utia_value(k / (UTIA_DIRECTIONS * UTIA_DIRECTIONS),
                                      k / UTIA_DIRECTIONS % UTIA_DIRECTIONS, k % UTIA_DIRECTIONS);
    }
    return values;
}

static gonio_angles utia_direction(double theta, double phi)
{
    return (gonio_angles){15.0 * degree * theta, 7.5 * degree * phi};
}

static void check_utia(const char *path, bool scaled)
{
    gonio_material *material = open_good(path);
    assert_true(gonio_material_describe(material)->anisotropic);
    assert_int_equal(strstr(gonio_material_format(material), "140") != NULL, scaled);
    const gonio_pair pairs[3] = {
        {utia_direction(2.0, 5.0), utia_direction(4.0, 47.0)},  /* measured ones */
        {utia_direction(2.0, 5.0), utia_direction(4.0, 47.5)},  /* between the last and the first */
        {utia_direction(1.5, -48.0), utia_direction(5.0, 3.0)}, /* between 1 and 2; a turn back */
    };
    double values[3][3];
    assert_int_equal(gonio_material_evaluate(NULL, material, pairs, 3, values[0]), GONIO_OK);
    for (size_t c = 0; c < 3; c++) {
        const size_t in = 2 * 48 + 5;
        const double first = utia_value(c, in, 4 * 48 + 47);
        const double between = 0.5 * (first + utia_value(c, in, 4 * 48));
        const double last =
            0.5 * (utia_value(c, 48, 5 * 48 + 3) + utia_value(c, 2 * 48, 5 * 48 + 3));
        assert_true(fabs(values[0][c] - first) < 1e-12);
        assert_true(fabs(values[1][c] - between) < 1e-12);
        assert_true(fabs(values[2][c] - last) < 1e-12);
    }
    const gonio_pair steep = {{76.0 * degree, 0.0}, {0.1, 0.0}};
    assert_int_equal(gonio_material_evaluate(NULL, material, &steep, 1, values[0]), GONIO_OK);
    assert_true(isnan(values[0][0]));
    gonio_material_free(&material);
}

static void test_utia(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.bin", folder);
    for (int k = 0; k < 2; k++) {
        double *values = make_utia(k == 0 ? 1.0 : 140.0);
        write_bytes(path, values, UTIA_VALUES * sizeof *values);
        check_utia(path, k == 1);
        free(values);
    }
    double *values = make_utia(1.0);
    values[70000] = NAN;
    write_bytes(path, values, UTIA_VALUES * sizeof *values);
    check_refused(path, "value 70000");
    values[70000] = -0.5;
    values[1] = 1e300;
    write_bytes(path, values, UTIA_VALUES * sizeof *values);
    check_refused(path, "not a material");
    write_bytes(path, values, UTIA_VALUES * sizeof *values - 8);
    check_refused(path, "not a material");
    free(values);
    support_remove(folder);
}

/* Other steps than the database's, by the size. */
static void test_utia_of_other_sizes(void **state)
{
    (void)state;
    static const struct {
        size_t thetas, phis;
        double theta, phi; /* steps, degrees */
        const char *said;
    } cases[] = {{3, 24, 30.0, 15.0, "72 x 72 directions in steps of 30 and 15 degrees"},
                 {6, 24, 15.0, 15.0, "144 x 144 directions in steps of 15 and 15 degrees"}};
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.bin", folder);
    for (size_t k = 0; k < 2; k++) {
        const size_t directions = cases[k].thetas * cases[k].phis;
        double *values = malloc(3 * directions * directions * sizeof *values);
        assert_non_null(values);
        for (size_t n = 0; n < 3 * directions * directions; n++) {
            values[n] = 1e-3 + 1e-6 * (double)n;
        }
        write_bytes(path, values, 3 * directions * directions * sizeof *values);
        gonio_material *material = open_good(path);
        assert_non_null(strstr(gonio_material_format(material), cases[k].said));
        const gonio_pair pair = {{cases[k].theta * degree, 5.0 * cases[k].phi * degree},
                                 {2.0 * cases[k].theta * degree, 23.0 * cases[k].phi * degree}};
        double value[3];
        assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, value), GONIO_OK);
        for (size_t c = 0; c < 3; c++) {
            const size_t in = cases[k].phis + 5;
            const size_t out = 2 * cases[k].phis + 23;
            assert_true(fabs(value[c] - values[(c * directions + in) * directions + out]) < 1e-12);
        }
        gonio_material_free(&material);
        free(values);
    }
    support_remove(folder);
}

static void test_utia_of_unknown_sizes(void **state)
{
    (void)state;
    enum { COUNT = 3 * 110 * 110, BYTES = COUNT * (int)sizeof(double) };
    char *folder = support_folder();
    char path[4096];
    double *values = malloc(BYTES);
    assert_non_null(values);
    snprintf(path, sizeof path, "%s/x.bin", folder);
    for (size_t n = 0; n < COUNT; n++) {
        values[n] = 0.1;
    }
    write_bytes(path, values, BYTES);
    check_refused(path, "290400 bytes are of no known grid: theta in steps of 15 degrees (1990656");
    memset(values, '7', BYTES); /* a text of digits */
    write_bytes(path, values, BYTES);
    check_refused(path, "not a material");
    memset(values, 0, BYTES);
    write_bytes(path, values, BYTES);
    check_refused(path, "not a material");
    free(values);
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kaist),
        cmocka_unit_test(test_kaist_without_data),
        cmocka_unit_test(test_utia),
        cmocka_unit_test(test_utia_of_other_sizes),
        cmocka_unit_test(test_utia_of_unknown_sizes),
    };
    return cmocka_run_group_tests_name("material_formats", tests, NULL, NULL);
}
