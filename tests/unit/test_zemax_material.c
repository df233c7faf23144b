/* Zemax BSDF files as materials: values between the angles of the grid, rotations of the sample,
 * holes, and files that are no material. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROOM = 8192 };

static double radians(double degrees)
{
    return degrees * M_PI / 180.0;
}

/* A file of one channel with two azimuths, 0 and 180, unless `azimuths` says others. */
static gonio_status open_text(gonio_context *context, const char *rotations, const char *incidences,
                              const char *azimuths, const char *values, gonio_material **material)
{
    char path[256];
    char *folder = support_folder();
    snprintf(path, sizeof path, "%s/grid.bsdf", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file,
            "Source Measured\nScatterType BRDF\nSampleRotation %s\nAngleOfIncidence %s\n"
            "ScatterAzimuth %s\nScatterRadial 2\n0 20\nMonochrome\nDataBegin\n%s\nDataEnd\n",
            rotations, incidences, azimuths, values);
    assert_int_equal(fclose(file), 0);
    const gonio_status status = gonio_material_open(context, path, material);
    support_remove(folder);
    return status;
}

/* The value with light and viewer in degrees; NaN if there is none. */
static double value_at(const gonio_material *material, double theta_i, double phi_i, double theta_o,
                       double phi_o)
{
    const gonio_pair pair = {{radians(theta_i), radians(phi_i)},
                             {radians(theta_o), radians(phi_o)}};
    double value[3] = {NAN, NAN, NAN};
    assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, value), GONIO_OK);
    return value[0];
}

static void assert_value(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * expected)) {
        fail_msg("%.17g where %.17g is expected", value, expected);
    }
}

/* ---- one rotation ---- */

static void test_between_the_angles(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    assert_int_equal(open_text(NULL, "1\n0", "2\n10 30", "2\n0 180",
                               "TIS 0 8 1\n8 2\nTIS 0 32 4\n32 0", &material),
                     GONIO_OK);
    const gonio_material_view *view = gonio_material_describe(material);
    assert_false(view->anisotropic);
    assert_int_equal(view->channels, 1);
    assert_value(value_at(material, 10, 40, 10, 220), 8.0);
    assert_value(value_at(material, 10, 0, 30, 180), 2.0); /* azimuth 180: away from the normal */
    assert_value(value_at(material, 10, 0, 10, 0), 1.0);   /* azimuth 0 */
    assert_value(value_at(material, 10, 0, 20, 180), 4.0); /* the mean of logarithms */
    assert_value(value_at(material, 20, 0, 20, 180), 16.0);
    assert_value(value_at(material, 20, 0, 40, 180), 2.0); /* not measured at 30: that of 10 */
    assert_value(value_at(material, 0, 0, 0, 0), 8.0);     /* below the first incidence */
    assert_value(value_at(material, 40, 0, 20, 180), value_at(material, 20, 180, 40, 0));
    assert_true(isnan(value_at(material, 10, 0, 60, 180))); /* beyond the radial angles */
    assert_true(isnan(value_at(material, 60, 0, 60, 180)));
    gonio_material_free(&material);
}

/* Azimuths of a whole turn tell both sides of the plane of incidence apart. */
static void test_both_sides(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    assert_int_equal(
        open_text(NULL, "1\n0", "1\n0", "4\n0 90 180 270", "TIS 0 1 1\n1 2\n1 3\n1 4", &material),
        GONIO_OK);
    assert_value(value_at(material, 0, 0, 20, 90), 2.0);
    assert_value(value_at(material, 0, 0, 20, 180), 3.0);
    assert_value(value_at(material, 0, 0, 20, 270), 4.0);
    assert_value(value_at(material, 0, 0, 20, 315), 2.0); /* between 4 and 1 */
    gonio_material_free(&material);
}

/* ---- rotations of the sample ---- */

static void test_rotations(void **state)
{
    (void)state;
    static const struct {
        const char *rotations;
        double at[4]; /* degrees */
        double value[4];
    } cases[] = {
        {"4\n0 90 180 270", {0, 45, 270, 315}, {1, 2, 64, 8}},
        {"4\n0 120 240 360", {60, 120, 360, -60}, {2, 4, 1, 32}},
        {"4\n0 45 90 135", {0, 180, 225, 157.5}, {1, 1, 4, 8}},
        {"4\n0 30 60 90", {90, 120, 180, -30}, {64, 16, 1, 4}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_material *material = NULL;
        assert_int_equal(open_text(NULL, cases[k].rotations, "1\n20", "2\n0 180",
                                   "TIS 0 1 1 1 1\nTIS 0 4 1 4 1\nTIS 0 16 1 16 1\nTIS 0 64 1 64 1",
                                   &material),
                         GONIO_OK);
        assert_true(gonio_material_describe(material)->anisotropic);
        for (size_t n = 0; n < 4; n++) {
            const double phi = cases[k].at[n];
            assert_value(value_at(material, 20, phi, 20, phi + 180), cases[k].value[n]);
        }
        gonio_material_free(&material);
    }
}

/* Of a quarter turn, the other side of the plane of incidence is seen at mirrored rotations. */
static void test_mirrored_quarter(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    assert_int_equal(open_text(NULL, "3\n0 45 90", "1\n20", "4\n0 90 180 270",
                               "TIS 0 1 1 1 2 1 1 1 3\nTIS 0 1 1 1 5 1 1 1 7\n"
                               "TIS 0 1 1 1 2 1 1 1 3",
                               &material),
                     GONIO_OK);
    const gonio_pair seen = {{radians(20), radians(45)}, {0.7, 0.3}};
    const gonio_pair mirrored = {{radians(20), radians(-45)}, {0.7, -0.3}};
    double value[2];
    assert_int_equal(gonio_material_evaluate(NULL, material, &seen, 1, &value[0]), GONIO_OK);
    assert_int_equal(gonio_material_evaluate(NULL, material, &mirrored, 1, &value[1]), GONIO_OK);
    if (isnan(value[0])) {
        assert_true(isnan(value[1]));
    } else {
        assert_value(value[1], value[0]);
    }
    gonio_material_free(&material);
}

/* ---- files that are no material ---- */

static void test_refused(void **state)
{
    (void)state;
    static const struct {
        const char *rotations;
        const char *incidences;
        const char *values;
        const char *message;
    } cases[] = {
        {"2\n0 30", "1\n20", "TIS 0 1 1 1 1\nTIS 0 1 1 1 1", "is no whole, half or quarter turn"},
        {"2\n90 0", "1\n20", "TIS 0 1 1 1 1\nTIS 0 1 1 1 1", "SampleRotation 0 after 90"},
        {"1\n0", "2\n20 20", "TIS 0 1 1 1 1\nTIS 0 1 1 1 1", "AngleOfIncidence 20 after 20"},
        {"1\n0", "1\n90", "TIS 0 1 1 1 1", "incidences below 90"},
        {"1\n0", "1\n20", "TIS 0 0 0 0 0", "nothing was measured"},
        {"1\n0", "1\n20", "TIS 0 1 1 1 1e12", "too large for a BRDF"},
        {"1\n0", "1\n20", "TIS 0 1 1 1", "'DataEnd' is not a number"},
    };
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_material *material = NULL;
        assert_int_not_equal(open_text(context, cases[k].rotations, cases[k].incidences, "2\n0 180",
                                       cases[k].values, &material),
                             GONIO_OK);
        if (strstr(support_message(), cases[k].message) == NULL) {
            fail_msg("'%s' is not in '%s'", cases[k].message, support_message());
        }
    }
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_between_the_angles),
        cmocka_unit_test(test_both_sides),
        cmocka_unit_test(test_rotations),
        cmocka_unit_test(test_mirrored_quarter),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests_name("Zemax files as materials", tests, NULL, NULL);
}
