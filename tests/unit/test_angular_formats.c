/* Readings of ALTA, pab-opto, ASTM E1392, TracePro, Zemax and FRED files: directions and values
 * worked out by hand, and files that are not what they should be. */
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

/* ---- Zemax ---- */

#define ZEMAX_HEADER                                                                               \
    "# a sheet\nSource  Measured\nSymmetry  PlaneSymmetrical\nSpectralContent  Monochrome\n"       \
    "ScatterType  BRDF\nSampleRotation  1\n0\nAngleOfIncidence  2\n10 30\n"                        \
    "ScatterAzimuth 3\n0 90\n180\nScatterRadial 2\n0 20\n"

/* About the mirror direction of 30 degrees: 20 towards the normal is theta 10, away from it 50; at
 * 90 degrees cos theta = cos 30 cos 20, and the difference of azimuths from the mirror's is
 * atan2(sin 20, sin 30 cos 20). */
static void test_zemax(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_good(ZEMAX_HEADER "Monochrome\nDataBegin\nTIS 0.1\n1 2\n1 3\n1 4\n"
                               "TIS 0.2\n5 6\n5 7\n5 0\nDataEnd\n",
                  "a Zemax BSDF (angles about the mirror direction): angles in degrees, values in "
                  "1/sr, 0 means not measured; 7 readings; left out: 1 not measured, 4 repeated");
    const double side = atan2(sin(M_PI / 9.0), 0.5 * cos(M_PI / 9.0)) * 180.0 / M_PI;
    assert_reading(readings, 0, 10.0, 10.0, 180.0, 1.0);
    assert_reading(readings, 1, 10.0, 10.0, 0.0, 2.0);
    assert_reading(readings, 3, 10.0, 30.0, 180.0, 4.0);
    assert_reading(readings, 4, 30.0, 30.0, 180.0, 5.0);
    assert_reading(readings, 5, 30.0, 10.0, 180.0, 6.0);
    const double theta = acos(cos(M_PI / 6.0) * cos(M_PI / 9.0)) * 180.0 / M_PI;
    const gonio_pair p = gonio_readings_describe(readings)->pair[6];
    assert_near(p.outgoing.theta * 180.0 / M_PI, theta);
    assert_near(fabs(fabs(p.outgoing.phi - p.incident.phi) * 180.0 / M_PI - 180.0), side);
    gonio_readings_free(&readings);
}

/* X, Y, Z of equal energy are colours; a rotation of the sample turns the light. */
static void test_zemax_colours_and_rotation(void **state)
{
    (void)state;
    gonio_readings *readings = read_good(
        "Symmetry ASymmetrical4D\nScatterType BRDF\nSampleRotation 2\n0 90\nAngleOfIncidence 1\n"
        "30\nScatterAzimuth 1\n0\nScatterRadial 1\n0\nTristimulusX\nDataBegin\nTIS 1\n0.2\nTIS "
        "1\n0.3\nDataEnd\nTristimulusY\nDataBegin\nTIS 1\n0.2\nTIS 1\n0.3\nDataEnd\nTristimulusZ\n"
        "DataBegin\nTIS 1\n0.2\nTIS 1\n0.3\nDataEnd\n",
        "Zemax");
    assert_true(gonio_readings_are_colours(readings));
    assert_near(gonio_readings_value(readings, 0, 2), 0.2);
    assert_reading(readings, 1, 30.0, 30.0, 180.0, 0.3);
    assert_near(gonio_readings_describe(readings)->pair[1].incident.phi, M_PI / 2.0);
    gonio_readings_free(&readings);
}

/* What gonio writes of a material is what the material is there. */
static void test_zemax_round_trip(void **state)
{
    (void)state;
    char path[256];
    char *folder = support_folder();
    gonio_material *material = NULL;
    gonio_write_options how;
    gonio_write_options_default(&how);
    how.format = "zemax";
    snprintf(path, sizeof path, "%s/x.bsdf", folder);
    assert_int_equal(gonio_material_open(NULL, "atlas:gold-polished", &material), GONIO_OK);
    assert_int_equal(gonio_material_write(NULL, material, path, &how), GONIO_OK);
    gonio_readings *written = NULL;
    gonio_readings *known = NULL;
    assert_int_equal(gonio_readings_read(NULL, path, NULL, &written), GONIO_OK);
    assert_int_equal(gonio_readings_read(NULL, path, NULL, &known), GONIO_OK);
    assert_int_equal(gonio_measure_material(NULL, known, material, NULL), GONIO_OK);
    const size_t count = gonio_readings_describe(written)->count;
    double sum = 0.0;
    double square = 0.0;
    for (size_t k = 0; k < 3 * count; k++) {
        const double is = log1p(1500.0 * gonio_readings_value(written, k / 3, k % 3));
        const double was = log1p(1500.0 * gonio_readings_value(known, k / 3, k % 3));
        sum += isnan(is - was) ? 0.0 : (is - was) * (is - was);
        square += isnan(is - was) ? 0.0 : was * was;
    }
    assert_true(count > 5000);
    assert_true(sqrt(sum / square) < 1e-4);
    gonio_readings_free(&written);
    gonio_readings_free(&known);
    gonio_material_free(&material);
    support_remove(folder);
}

/* ---- FRED ---- */

static void test_fred(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_good("type bsdf_data\nformat angles=deg bsdf=value scale=2\n!! a comment\n10\t0\n"
                  "0 0 0.3\n0 90 0.3\n10 180 0.00001\n30 0 0.4\n95 0 1\n50 90\n20 90 0.5\n",
                  "FRED text: angles in degrees, phi_o = phi_i on the mirror's side, values in "
                  "1/sr, 0 means not measured; 3 readings; left out: 1 at or below the horizon, 1 "
                  "not measured, 1 repeated");
    assert_reading(readings, 0, 10.0, 0.0, 0.0, 0.6);
    assert_reading(readings, 1, 10.0, 30.0, 180.0, 0.8);
    assert_reading(readings, 2, 50.0, 20.0, 180.0, 1.0);
    gonio_readings_free(&readings);

    readings = read_good("type bsdf_data\nformat angles=sin bsdf=log scale=1\n0.5 0\n"
                         "0.5 180 -2\n",
                         "FRED");
    assert_reading(readings, 0, 30.0, 30.0, 0.0, 0.01);
    gonio_readings_free(&readings);
}

/* ---- columns of text ---- */

/* Scatterworks' names: phi is the polar angle, signed, and theta the azimuth. */
static void test_columns_with_names_in_a_comment(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_good("# a panel, measured at 532 nm\n# phi_i theta_i phi_o theta_o brdf\n"
                  "60.0 -180.0 -45.0 0.0 2.0e-03\n60.0 -180.0 60.0 0.0 5.0\n"
                  "60.0 -180.0 89.0 0.0 1.0e-04\n60.0 -180.0 90.0 0.0 1.0\n",
                  "columns of text (phi is the polar angle, theta the azimuth): angles in degrees, "
                  "values in 1/sr, 0 means not measured; 2 readings; left out: 1 at or below the "
                  "horizon, 1 not measured");
    assert_near(gonio_readings_describe(readings)->wavelength[0], 532.0);
    assert_reading(readings, 0, 60.0, 45.0, 0.0, 0.002);
    assert_reading(readings, 1, 60.0, 60.0, 180.0, 5.0);
    gonio_readings_free(&readings);

    readings = read_good("# theta_i phi_i theta_r phi_r value\n30 10 40 100 0.5\n",
                         "columns of text: angles");
    assert_null(gonio_readings_describe(readings)->wavelength);
    assert_reading(readings, 0, 30.0, 40.0, 90.0, 0.5);
    gonio_readings_free(&readings);
}

/* A column called brdf is no reflectance factor, azimuths or not. */
static void test_a_plane_without_azimuths(void **state)
{
    (void)state;
    gonio_readings *readings = read_good("# theta_i theta_o brdf\n30 30 0.5\n30 -10 0.25\n",
                                         "values in 1/sr, 0 means not measured; 2 readings");
    assert_reading(readings, 0, 30.0, 30.0, 180.0, 0.5);
    assert_reading(readings, 1, 30.0, 10.0, 0.0, 0.25);
    gonio_readings_free(&readings);
}

static void test_in_plane_spectra(void **state)
{
    (void)state;
    gonio_readings *readings = read_good(
        " Incident_angle,Measure_angle, 390nm , 400nm \n10,-78,0.31415926536,0.1\n"
        "10,30,0.2,0.62831853072\n10,-12,0,0\n",
        "in-plane readings (OMS; positive on the mirror's side): angles in degrees, "
        "reflectance factors (divided by pi), 0 means not measured; 2 readings; left out: "
        "1 not measured");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->channels, 2);
    assert_near(view->wavelength[1], 400.0);
    assert_reading(readings, 0, 10.0, 78.0, 0.0, 0.1);
    assert_reading(readings, 1, 10.0, 30.0, 180.0, 0.2 / M_PI);
    assert_near(gonio_readings_value(readings, 1, 1), 0.2);
    gonio_readings_free(&readings);
}

/* ---- bad files ---- */

static void test_bad_files(void **state)
{
    (void)state;
    static const made_bad_file cases[] = {
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
        {"VARS theta_i,phi_i,theta_s,phi_s,4nm\n0,0,0.1,0,1\n", GONIO_ERROR_FORMAT, "not light"},
        {"Table_BSDF_Data\nx\n300 0.55 30 0 0.2\n", GONIO_ERROR_FORMAT, ":3: 5 numbers"},
        {"Table_BSDF_Data\nx\n", GONIO_ERROR_DATA, "no readings in it"},
        {ZEMAX_HEADER "DataBegin\nTIS 0.1\n1 2\n1 3\n1 4\nTIS 0.2\n5 6\n", GONIO_ERROR_FORMAT,
         "ends within a reading"},
        {ZEMAX_HEADER "DataBegin\n1 2\n1 3\n1 4\n5 6\n5 7\n5 8 9 0 1 2 3 4 5 6 7 8\n",
         GONIO_ERROR_FORMAT, "'1' where TIS is expected"},
        {ZEMAX_HEADER, GONIO_ERROR_FORMAT, "0 tables of values"},
        {"ScatterType BTDF\nAngleOfIncidence 1\n1\nScatterAzimuth 1\n1\n", GONIO_ERROR_DATA,
         "ScatterType BTDF: transmitted light"},
        {"AngleOfIncidence 99999\n1\nScatterAzimuth 1\n1\n", GONIO_ERROR_FORMAT,
         "AngleOfIncidence 99999: a number of angles"},
        {"AngleOfIncidence 1\n1\nScatterAzimuth 0\n1\n", GONIO_ERROR_FORMAT, "ScatterAzimuth 0"},
        {"AngleOfIncidence 1\n1\nScatterAzimuth 1\n1\nDataBegin\nTIS 0\n1\n", GONIO_ERROR_FORMAT,
         "DataBegin before the angles"},
        {"SampleRotation 9\n1 2 3 4 5 6 7 8 9\nAngleOfIncidence 9\n1 2 3 4 5 6 7 8 9\n"
         "ScatterAzimuth 9\n1 2 3 4 5 6 7 8 9\nScatterRadial 9\n1 2 3 4 5 6 7 8 9\nDataBegin\n1\n",
         GONIO_ERROR_FORMAT, "of more values than the file has room for"},
        {"type bsdf_data\n10 20 30\n", GONIO_ERROR_FORMAT,
         ":2: a value before the first incidence"},
        {"type bsdf_data\n10 20\n10 20 30 40\n", GONIO_ERROR_FORMAT, ":3: 2 numbers (an incid"},
        {"# theta_i phi_i theta_o phi_o brdf\n1 2 3 4\n", GONIO_ERROR_FORMAT,
         ":2: a row of 5 numbers"},
        {"# theta_i phi_i theta_o phi_o brdf\n1 2 3 4 bright\n", GONIO_ERROR_FORMAT, ":2: a row"},
        {"Incident_angle,Measure_angle,390nm,390nm\n1,2,3,4\n", GONIO_ERROR_FORMAT,
         "390 nm occurs twice"},
        {"type bsdf_data\nformat scale=0\n", GONIO_ERROR_FORMAT, "the scale is not a number"},
    };
    assert_bad_files("bad.txt", cases, sizeof cases / sizeof *cases);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_alta_projected),
        cmocka_unit_test(test_alta_others),
        cmocka_unit_test(test_pab),
        cmocka_unit_test(test_astm),
        cmocka_unit_test(test_tracepro),
        cmocka_unit_test(test_zemax),
        cmocka_unit_test(test_zemax_colours_and_rotation),
        cmocka_unit_test(test_zemax_round_trip),
        cmocka_unit_test(test_fred),
        cmocka_unit_test(test_columns_with_names_in_a_comment),
        cmocka_unit_test(test_a_plane_without_azimuths),
        cmocka_unit_test(test_in_plane_spectra),
        cmocka_unit_test(test_bad_files),
    };
    return cmocka_run_group_tests_name("formats with a row for each direction", tests, NULL, NULL);
}
