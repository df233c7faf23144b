/* Readings of ALTA, pab-opto, ASTM E1392 and TracePro files: directions and values worked out by
 * hand, and files that are not what they should be. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "made_readings.h"

static void assert_near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-7 * fmax(1.0, fabs(expected)))) {
        fail_msg("%.17g where %.17g is expected", value, expected);
    }
}

static gonio_readings *read_good(const char *text, const char *taken_as)
{
    char *folder = support_folder();
    gonio_readings *readings = NULL;
    assert_int_equal(made_readings(NULL, folder, "r.txt", text, NULL, &readings), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->notes, 1);
    assert_non_null(strstr(view->note[0], taken_as));
    support_remove(folder);
    return readings;
}

/* One reading: theta_i, theta_o, phi_o - phi_i in degrees, and the first channel's value. */
static void assert_reading(const gonio_readings *readings, size_t k, double theta_i, double theta_o,
                           double difference, double value)
{
    const gonio_pair p = gonio_readings_describe(readings)->pair[k];
    const double degree = M_PI / 180.0;
    assert_near(p.incident.theta / degree, theta_i);
    assert_near(p.outgoing.theta / degree, theta_o);
    const double turned = (p.outgoing.phi - p.incident.phi) / degree;
    assert_near(cos(turned * degree), cos(difference * degree));
    assert_near(sin(turned * degree), sin(difference * degree));
    assert_near(gonio_readings_value(readings, k, 0), value);
}

/* ---- ALTA ---- */

/* (0.3, -0.4) radians is 0.5 along atan2(-0.4, 0.3) = -53.13 degrees. */
static void test_alta_projected(void **state)
{
    (void)state;
    gonio_readings *readings = read_good(
        "#SAMPLE \"x\"\n#DIM 3 1\n#VS 0\n#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n"
        "0.25 0.3 -0.4 0.7\n0.25 -0.2 0 0.1\n0.25 1.5707963268 0 9\n",
        "ALTA data: angles in radians, values in 1/sr; 2 readings; left out: 1 at or below");
    assert_reading(readings, 0, 0.25 * 180.0 / M_PI, 0.5 * 180.0 / M_PI,
                   atan2(-0.4, 0.3) * 180.0 / M_PI, 0.7);
    assert_reading(readings, 1, 0.25 * 180.0 / M_PI, 0.2 * 180.0 / M_PI, 180.0, 0.1);
    gonio_readings_free(&readings);
}

static void test_alta_others(void **state)
{
    (void)state;
    gonio_readings *readings = read_good("#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n"
                                         "#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n"
                                         "1.04719755 0.3 3.14159265 0.25\n",
                                         "values with cos theta_o");
    assert_reading(readings, 0, 0.3 * 180.0 / M_PI, 60.0, 180.0, 0.5);
    gonio_readings_free(&readings);

    /* View and light as vectors, two values. */
    readings = read_good("#DIM 6 2\n#PARAM_IN CARTESIAN\n0 0 1  0.6 0 0.8  0.25 0.5\n", "ALTA");
    assert_int_equal(gonio_readings_describe(readings)->channels, 2);
    assert_near(gonio_readings_describe(readings)->pair[0].incident.theta, atan2(0.6, 0.8));
    assert_near(gonio_readings_describe(readings)->pair[0].outgoing.theta, 0.0);
    gonio_readings_free(&readings);

    /* theta_h = 0, theta_d = 30: light and view mirror each other. */
    readings = read_good("#DIM 3 1\n#PARAM_IN RUSIN_TH_TD_PD\n0 0.523598776 0.4 0.3\n", "ALTA");
    assert_reading(readings, 0, 30.0, 30.0, 180.0, 0.3);
    gonio_readings_free(&readings);
}

/* ---- pab-opto ---- */

static void test_pab(void **state)
{
    (void)state;
    gonio_readings *readings = read_good("#sample_name x\n#incident_angle 30 90\n#upphi 90\n"
                                         "#format: theta phi DSF\n#datapoints 3\n"
                                         "60 270 0.25\n 0 10 0.4\n120 0 7\n",
                                         "pab-opto text: angles in degrees, values with cos");
    assert_int_equal(gonio_readings_describe(readings)->count, 2);
    assert_reading(readings, 0, 30.0, 60.0, 180.0, 0.5);
    assert_near(gonio_readings_describe(readings)->pair[0].incident.phi, 0.0);
    gonio_readings_free(&readings);

    /* Two incidences in a file. */
    readings = read_good("#format: theta phi BSDF\n#intheta 10\n#inphi 0\n20 180 1\n"
                         "#intheta 40\n20 180 2\n",
                         "pab-opto");
    assert_reading(readings, 0, 10.0, 20.0, 180.0, 1.0);
    assert_reading(readings, 1, 40.0, 20.0, 180.0, 2.0);
    gonio_readings_free(&readings);

    /* Equal X, Y, Z are grey. */
    readings = read_good("#format: theta phi X Y Z\n#colorimetry: CIE-XYZ\n#intheta 10\n"
                         "20 180 0.2 0.2 0.2\n",
                         "pab-opto");
    assert_true(gonio_readings_are_colours(readings));
    for (size_t k = 0; k < 3; k++) {
        assert_near(gonio_readings_value(readings, 0, k), 0.2);
    }
    gonio_readings_free(&readings);
}

/* ---- ASTM E1392 ---- */

static void test_astm(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_good("ASTM x\nNUM_POINTS 2\nWAVELENGTH 0\n"
                  "VARS theta_i,phi_i,theta_s,phi_s,400nm, 500nm\n"
                  "0.3, 0, 1.04719755, 3.14159265, 0.5, 0.25\n0.3,0,0,0,0.1,0.2\n",
                  "an ASTM E1392 table: angles in radians, values in 1/sr; 2 readings");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->channels, 2);
    assert_near(view->wavelength[1], 500.0);
    assert_reading(readings, 0, 0.3 * 180.0 / M_PI, 60.0, 180.0, 0.5);
    assert_near(gonio_readings_value(readings, 1, 1), 0.2);
    gonio_readings_free(&readings);

    readings = read_good("VARS theta_i,phi_i,theta_s,phi_s,X,Y,Z\n0,0,0.1,0,0.3,0.3,0.3\n", "ASTM");
    assert_near(gonio_readings_value(readings, 0, 2), 0.3);
    gonio_readings_free(&readings);

    readings = read_good("VARS theta_i,phi_i,theta_s,phi_s,R,G,B\n0,0,0.1,0,0.3,0.2,0.1\n", "ASTM");
    assert_true(gonio_readings_are_colours(readings));
    assert_near(gonio_readings_value(readings, 0, 2), 0.1);
    gonio_readings_free(&readings);
}

/* ---- TracePro ---- */

/* Incidence 30 degrees: beta_0 = 0.5. 0.2 beyond it is asin(0.7); 0.5 back is the normal; 0.3 at
 * 90 degrees is (0.5, 0.3). */
static void test_tracepro(void **state)
{
    (void)state;
    static const char text[] =
        "TracePro Surface Property Data\nTemperature\tWavelength\tIncAngle\n300\t0.55\t30\n"
        "Table_BSDF_Data\nTemperature\tWavelength\tIncAngle\tAziAngle\tScatterBeta\t"
        "ScatterAzimuth\tBRDF\tBTDF\n"
        "300\t0.55\t30\t0\t0.2\t0\t0.1\t\n300\t0.55\t30\t0\t0.5\t180\t0.2\t\n"
        "300\t0.55\t30\t0\t0.3\t90\t0.3\t\n300\t0.55\t30\t0\t0.6\t0\t0.4\t\n"
        "300\t0.65\t30\t0\t0.2\t0\t0.5\t\n";
    gonio_readings *readings =
        read_good(text, "a TracePro table: angles in degrees, values in 1/sr, wavelengths in "
                        "micrometres; 3 readings; left out: 1 at or below the horizon");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->channels, 2);
    assert_near(view->wavelength[0], 550.0);
    assert_near(view->wavelength[1], 650.0);
    assert_reading(readings, 0, 30.0, asin(0.7) * 180.0 / M_PI, 180.0, 0.1);
    assert_near(gonio_readings_value(readings, 0, 1), 0.5);
    assert_reading(readings, 1, 30.0, 0.0, 0.0, 0.2);
    assert_true(isnan(gonio_readings_value(readings, 1, 1)));
    assert_reading(readings, 2, 30.0, asin(hypot(0.5, 0.3)) * 180.0 / M_PI,
                   180.0 + atan2(0.3, 0.5) * 180.0 / M_PI, 0.3);
    gonio_readings_free(&readings);
}

/* ---- bad files ---- */

static void test_bad_files(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        gonio_status status;
        const char *message;
    } cases[] = {
        {"#DIM 3 1\n#PARAM_IN BARYCENTRIC_ALPHA_SIGMA\n1 2 3 4\n", GONIO_ERROR_FORMAT,
         "#PARAM_IN BARYCENTRIC_ALPHA_SIGMA: gonio knows"},
        {"#DIM 4 1\n#PARAM_IN RUSIN_TH_TD_PD\n1 2 3 4\n", GONIO_ERROR_FORMAT, "does not fit"},
        {"#DIM 3 99999999999\n#PARAM_IN RUSIN_TH_TD_PD\n1 2 3 4\n", GONIO_ERROR_FORMAT,
         "does not fit"},
        {"#DIM 3 1\n#PARAM_IN RUSIN_TH_TD_PD\n0.1 0.2 0.3\n", GONIO_ERROR_FORMAT,
         ":3: a row of 4 numbers"},
        {"#DIM 3 1\n#PARAM_IN RUSIN_TH_TD_PD\n0.1 0.2 0.3 nan\n", GONIO_ERROR_FORMAT, ":3:"},
        {"#DIM 3 1\n#PARAM_IN RUSIN_TH_TD_PD\n", GONIO_ERROR_DATA, "no readings in it"},
        {"#format: theta phi BSDF\n#intheta x\n1 2 3\n", GONIO_ERROR_FORMAT, "no '#intheta'"},
        {"#format: theta phi\n#intheta 3\n1 2\n", GONIO_ERROR_FORMAT, "names 0 values"},
        {"#format: theta phi BSDF\n#intheta 3\n1 2\n", GONIO_ERROR_FORMAT,
         ":3: a row of 3 numbers"},
        {"#format: theta phi BSDF\n#intheta 3\n1 2 3\n#format: theta phi a b\n1 2 3 4\n",
         GONIO_ERROR_FORMAT, "changes within the file"},
        {"VARS theta_i,phi_i,theta_s\n1,2,3\n", GONIO_ERROR_FORMAT, "are expected, in this order"},
        {"VARS theta_i,phi_i,theta_s,phi_s\n1,2,3\n", GONIO_ERROR_FORMAT, "names no values"},
        {"NUM_POINTS 2\nVARS theta_i,phi_i,theta_s,phi_s,R\n0,0,0.1,0,0.3\n", GONIO_ERROR_FORMAT,
         "1 rows where NUM_POINTS says 2"},
        {"VARS theta_i,phi_i,theta_s,phi_s,R\n0,0,0.1,0\n", GONIO_ERROR_FORMAT,
         ":2: a row of 5 numbers"},
        {"VARS theta_i,phi_i,theta_s,phi_s,4nm\n0,0,0.1,0,1\n", GONIO_ERROR_FORMAT, "no light"},
        {"Table_BSDF_Data\nx\n300 0.55 30 0 0.2\n", GONIO_ERROR_FORMAT, ":3: 5 numbers"},
        {"Table_BSDF_Data\nx\n", GONIO_ERROR_DATA, "no readings in it"},
    };
    char *folder = support_folder();
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_readings *readings = NULL;
        const gonio_status status =
            made_readings(context, folder, "bad.txt", cases[k].text, NULL, &readings);
        if (status != cases[k].status || strstr(support_message(), cases[k].message) == NULL) {
            fail_msg("case %zu: status %d, '%s'; expected %d, '%s'", k, (int)status,
                     support_message(), (int)cases[k].status, cases[k].message);
        }
        assert_null(readings);
    }
    gonio_context_free(&context);
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_alta_projected),
        cmocka_unit_test(test_alta_others),
        cmocka_unit_test(test_pab),
        cmocka_unit_test(test_astm),
        cmocka_unit_test(test_tracepro),
        cmocka_unit_test(test_bad_files),
    };
    return cmocka_run_group_tests_name("formats with a row for each direction", tests, NULL, NULL);
}
