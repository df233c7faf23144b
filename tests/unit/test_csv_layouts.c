/* Tables as laboratories and programs write them, that are not CSV with gonio's names: other
 * comment marks, separators, lines above the names, angles in the plane of incidence, rotations of
 * the sample. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "made_readings.h"

static gonio_status read_text(gonio_context *context, const char *text, gonio_readings **readings)
{
    gonio_readings_options options;
    gonio_readings_options_default(&options);
    options.values_needed = true;
    return gonio_readings_read_text(context, "table", text, strlen(text), &options, readings);
}

/* The only reading, or the last one. Azimuths count by their difference, and that of the light. */
static void assert_last(const char *text, const double expected[4], double value)
{
    gonio_readings *readings = NULL;
    gonio_context *context = support_context();
    if (read_text(context, text, &readings) != GONIO_OK) {
        fail_msg("%s%s", text, support_message());
    }
    const gonio_readings_view *view = gonio_readings_describe(readings);
    const gonio_pair *pair = &view->pair[view->count - 1];
    const double angle[4] = {pair->incident.theta, pair->incident.phi, pair->outgoing.theta,
                             pair->outgoing.phi};
    for (int k = 0; k < 4; k++) {
        const double degrees = angle[k] * 180.0 / M_PI;
        if (fabs(remainder(degrees - expected[k], 360.0)) > 1e-9) {
            fail_msg("%sangle %d is %g, not %g", text, k, degrees, expected[k]);
        }
    }
    assert_true(fabs(gonio_readings_value(readings, view->count - 1, 0) - value) < 1e-12);
    gonio_readings_free(&readings);
    gonio_context_free(&context);
}

#define NAMES "theta_i phi_i theta_o phi_o brdf\n"

static void test_layouts(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "% lab A, 2024\n% " NAMES "10 0 40 170 0.25\n20 0 30 180 0.5\n",
        "% " NAMES "10,0,40,170,0.25\n% a remark\n20,0,30,180,0.5\n",
        "; lab B\n; unit 1/sr\n" NAMES "10 0 40 170 0.25\n\n20  0\t30 180 0.5\n",
        "! " NAMES "! deg\n 20   0   30  180  0.5\n",
        "// theta_i, phi_i, theta_o, phi_o, brdf\n20, 0, 30, 180, 0.5\n",
        "| theta_i | phi_i | theta_o | phi_o | brdf |\n|---|:--|---|---|---|\n"
        "| 20 | 0 | 30 | 180 | 0.5 |\n",
        "theta_i|phi_i|theta_o|phi_o|brdf\n20|0|30|180|0.5\n",
        "Instrument,GON-3\nDate,2024-05-01\n\ntheta_i,phi_i,theta_o,phi_o,brdf\n20,0,30,180,0.5\n",
        "Sample: tile\n" NAMES "deg deg deg deg sr^-1\n20 0 30 180 0.5\n",
        "  theta_i  phi_i  theta_o  phi_o  brdf\n  20,0  0,0  30  180  0,5\n",
        "thetaIn,phiIn,thetaOut,phiOut,R550\n20,0,30,180,0.5\n",
        "inc,azimuth,scatter,value\n20,180,30,0.5\n",
        "AOI,scatter angle,BRDF\n20,30,0.5\n",
        "th_i,ph_i,th_r,ph_r,fr\n20,0,30,180,0.5\n",
        "theta_l,phi_l,theta_v,phi_v,brdf\n20,0,30,180,0.5\n",
        "AOI (deg);scatter angle (deg);BRDF (1/sr)\r\n20;30;0,5\r\n",
        /* a header of LabVIEW, whose rows end before the remarks */
        "Separator\tTab\r\n***End_of_Header***\t\r\n\r\ntheta_i\tphi_i\ttheta_o\tphi_"
        "o\tBRDF\tComment"
        "\r\n10\t0\t40\t170\t0.25\t\r\n20\t0\t30\t180\t0.5\r\n",
        /* long names, units and comments of a plotting program */
        "theta_i\tphi_i\ttheta_o\tphi_o\tBRDF\ndeg\tdeg\tdeg\tdeg\tsr\\+(-1)\n"
        "Comments\t\t\t\tblack tile\n20\t0\t30\t180\t0.5\n",
        "theta_i,phi_i,theta_o,phi_o,BRDF\n2.0D+01,0.0D+00,3.0D+01,1.8D+02,5.0D-01\n",
    };
    static const double expected[4] = {20, 0, 30, 180};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        assert_last(texts[k], expected, 0.5);
    }
}

/* In the plane of incidence, a negative angle is on the light's side. */
static void test_in_the_plane(void **state)
{
    (void)state;
    assert_last("theta_i,theta_o,brdf\n20,-30,0.5\n", (double[4]){20, 0, 30, 0}, 0.5);
    assert_last("theta_i,theta_o,sample rotation,brdf\n20,30,15,0.5\n",
                (double[4]){20, 15, 30, 195}, 0.5);
}

static void test_rotations_of_the_sample(void **state)
{
    (void)state;
    static const char *const names[] = {"sample_rotation", "rotation (deg)", "stage rotation",
                                        "sample azimuth",  "turntable",      "SampleAngle"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char text[160];
        snprintf(text, sizeof text, "%s,theta_i,phi_i,theta_o,phi_o,brdf\n90,20,5,30,170,0.5\n",
                 names[k]);
        assert_last(text, (double[4]){20, 95, 30, 260}, 0.5);
    }
    assert_last("sample,theta_i,phi_i,theta_o,phi_o,brdf\n90,20,5,30,170,0.5\n",
                (double[4]){20, 5, 30, 170}, 0.5); /* the number of a sample */
}

/* A reflectance at a wavelength, and a colour of it. */
static void test_reflectances_at_wavelengths(void **state)
{
    (void)state;
    gonio_readings *readings = NULL;
    assert_int_equal(
        read_text(NULL, "theta_i,phi_i,theta_o,phi_o,R450,R550\n20,0,30,180,0.5,0.6\n", &readings),
        GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->channels, 2);
    assert_true(view->wavelength != NULL && view->wavelength[1] == 550.0);
    gonio_readings_free(&readings);
}

static void test_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *message;
    } cases[] = {
        {"20,0,30,180,0.5\n30,0,30,180,0.5\n", "begins with numbers, not with names of columns"},
        {"[{\"theta_i\": 20, \"brdf\": 0.5}]\n", "JSON, but not BRDF JSON"},
        {"0 0 1 2 3\n", "begins with numbers, not with names of columns"},
        {"theta_i,theta_o,phi,brdf\n20,30,180,0.5\n", "no column 'phi_i_deg'"},
        {"% " NAMES "20 0 30 180\n", "table:2"},
        {"% " NAMES "20 0 30 180 x\n", "table:2"},
        {"theta_i,phi_i,theta_o,phi_o,brdf\ndeg,deg,deg,deg,1/sr\n2o,,,,x1\n", "table:3"},
        {"theta_i,phi_i,theta_o,phi_o,brdf\nwords,,,,\n20,0,30,180,0.5\n", "table:2"},
    };
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_readings *readings = NULL;
        assert_true(read_text(context, cases[k].text, &readings) != GONIO_OK);
        if (strstr(support_message(), cases[k].message) == NULL) {
            fail_msg("%s%s", cases[k].text, support_message());
        }
    }
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_layouts),
        cmocka_unit_test(test_in_the_plane),
        cmocka_unit_test(test_rotations_of_the_sample),
        cmocka_unit_test(test_reflectances_at_wavelengths),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests_name("tables that are not quite CSV", tests, NULL, NULL);
}
