/* Readings as CSV as people have them: names, units, comments and shapes of tables. Each text is
 * what one program or another writes. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "made_readings.h"
#include "measurement/formats/csv_names.h"

#define ANGLES "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg"

static void assert_near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fmax(1.0, fabs(expected)))) {
        fail_msg("%.17g where %.17g is expected", value, expected);
    }
}

static gonio_status read_text(gonio_context *context, const char *text, const char *as,
                              bool values_needed, gonio_readings **readings)
{
    gonio_readings_options options;
    char *folder = support_folder();
    gonio_readings_options_default(&options);
    options.values_needed = values_needed;
    assert_int_equal(gonio_convention_parse(NULL, as, &options.as), GONIO_OK);
    const gonio_status status = made_readings(context, folder, "r.csv", text, &options, readings);
    support_remove(folder);
    return status;
}

static gonio_readings *read_good(const char *text, const char *as)
{
    gonio_context *context = support_context();
    gonio_readings *readings = NULL;
    if (read_text(context, text, as, true, &readings) != GONIO_OK) {
        fail_msg("%s\n%s", support_message(), text);
    }
    gonio_context_free(&context);
    return readings;
}

static void assert_note(const gonio_readings *readings, const char *part)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    bool found = false;
    for (size_t k = 0; k < view->notes; k++) {
        found = found || strstr(view->note[k], part) != NULL;
    }
    if (part[0] == '\0' && view->notes > 0) {
        fail_msg("no note is expected: '%s'", view->note[0]);
    }
    if (part[0] != '\0' && !found) {
        fail_msg("'%s' is in no note: '%s'", part, view->notes > 0 ? view->note[0] : "");
    }
}

static void assert_degrees(const gonio_readings *readings, size_t k, const double degrees[4])
{
    const gonio_pair *pair = &gonio_readings_describe(readings)->pair[k];
    assert_near(pair->incident.theta * 180.0 / M_PI, degrees[0]);
    assert_near(pair->incident.phi * 180.0 / M_PI, degrees[1]);
    assert_near(pair->outgoing.theta * 180.0 / M_PI, degrees[2]);
    assert_near(pair->outgoing.phi * 180.0 / M_PI, degrees[3]);
}

/* ---- columns of values ---- */

/* One value of 0.5 in a file's first row, what it is in 1/sr, and what is said of it. */
typedef struct value_case {
    const char *before; /* comment lines */
    const char *name;
    double wavelength; /* 0: none */
    double expected;
    const char *note;
} value_case;

static void check_value(const value_case *c)
{
    char text[512];
    snprintf(text, sizeof text, "%s" ANGLES ",%s\n10,0,60,180,0.5\n20,0,30,180,0.25\n", c->before,
             c->name);
    print_message("%s%s\n", c->before, c->name);
    gonio_readings *readings = read_good(text, "");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    const bool colours = gonio_readings_are_colours(readings);
    assert_int_equal(view->channels, colours ? 3 : 1);
    assert_near(view->wavelength != NULL ? view->wavelength[0] : 0.0, c->wavelength);
    size_t channel = 0;
    while (channel + 1 < view->channels && isnan(gonio_readings_value(readings, 0, channel))) {
        channel++;
    }
    assert_near(gonio_readings_value(readings, 0, channel), c->expected);
    assert_note(readings, c->note);
    gonio_readings_free(&readings);
}

static void test_names_of_values(void **state)
{
    (void)state;
    static const value_case cases[] = {
        {"", "value_per_sr", 0.0, 0.5, ""},
        {"", "R_per_sr", 0.0, 0.5, ""},
        {"", "550nm_per_sr", 550.0, 0.5, ""},
        {"", "brdf", 0.0, 0.5, "taken as CSV (values 'brdf'): angles in degrees, values in 1/sr"},
        {"", "BRDF", 0.0, 0.5, "'BRDF'"},
        {"", "BRDF [1/sr]", 0.0, 0.5, "values in 1/sr"},
        {"", "f_r", 0.0, 0.5, "'f_r'"},
        {"", "fr (sr^-1)", 0.0, 0.5, "values in 1/sr"},
        {"", "rho", 0.0, 0.5, "'rho'"},
        {"", "value", 0.0, 0.5, "'value'"},
        {"", "brf", 0.0, 0.5 / M_PI, "reflectance factors (divided by pi)"},
        {"", "Reflectance factor", 0.0, 0.5 / M_PI, "reflectance factors"},
        {"", "reflectance (%)", 0.0, 0.005 / M_PI, "per cent"},
        {"", "BRDF*cos (1/sr)", 0.0, 1.0, "values with cos theta_o"},
        {"", "G", 0.0, 0.5, "'G'"},
        {"", "red", 0.0, 0.5, "'red'"},
        {"", "brdf_B", 0.0, 0.5, "'brdf_B'"},
        {"", "550nm", 550.0, 0.5, "'550nm'"},
        {"", "550 nm", 550.0, 0.5, "'550 nm'"},
        {"", "450 nm_per_sr", 450.0, 0.5, "'450 nm_per_sr'"},
        {"", " 390nm ", 390.0, 0.5, "'390nm'"},
        {"", "632.8nm", 632.8, 0.5, "'632.8nm'"},
        {"", "550", 550.0, 0.5, "'550'"},
        {"", "400_per_sr", 400.0, 0.5, "'400_per_sr'"},
        {"", "brdf_550", 550.0, 0.5, "'brdf_550'"},
        {"", "brf 550 nm", 550.0, 0.5 / M_PI, "reflectance factors"},
        {"", "0.55um", 550.0, 0.5, "wavelengths in micrometres"},
        {"", "1.064 \xc2\xb5m", 1064.0, 0.5, "wavelengths in micrometres"},
        {"# unit: 1/sr\n", "R", 0.0, 0.5, "values in 1/sr"},
        {"# unit: reflectance factor\n", "R", 0.0, 0.5 / M_PI, "reflectance factors"},
        {"# values: reflectance factor\n", "550nm", 550.0, 0.5 / M_PI, "reflectance factors"},
        {"# values: reflectance factor, per cent\n", "550nm", 550.0, 0.005 / M_PI, "per cent"},
        {"# values: percent\n", "550nm", 550.0, 0.005 / M_PI, "per cent"},
        {"# Values: BRF\n", "550nm", 550.0, 0.5 / M_PI, "reflectance factors"},
        {"# units: degrees, %\n", "550nm", 550.0, 0.005 / M_PI, "per cent"},
        {"# unit: bananas\n", "R", 0.0, 0.5, "the comment 'bananas' is not understood"},
        {"# unit: reflectance factor\n", "R_per_sr", 0.0, 0.5,
         "the comment 'reflectance factor' is not used"},
        {"# unit: 1/sr\n", "R_per_sr", 0.0, 0.5, ""},
        {"# values: corrected for the lamp\n", "R_per_sr", 0.0, 0.5, ""},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        check_value(&cases[k]);
    }
}

/* What columns hold beside what is read is said. */
static void test_numbers_that_are_not_read(void **state)
{
    (void)state;
    static const struct {
        const char *columns;
        const char *row;
        const char *note;
    } cases[] = {
        {"R_per_sr,exposure_s", "0.5,12", "columns of numbers that are not read: 'exposure_s'"},
        {"R_per_sr,time_s", "0.5,12", ""},
        {"R_per_sr,remark", "0.5,wet", ""},
        {"R_per_sr,expected_e6_percent", "0.5,3.2", ""},
        {"R_per_sr,", "0.5,7", "not read: column 6 without a name"},
        {"R_per_sr,", "0.5,", ""},
        {"R_per_sr,550nm", "0.5,0.4", "not read: '550nm'"},
        {"brdf,brf", "0.5,1.57", "not read: 'brf'"},
        {"R_per_sr,a,b,c,d,e", "0.5,1,2,3,4,5", "not read: 'a', 'b', 'c', 'd' and 1 more"},
        {"550nm_per_sr,600nm_deviation_per_sr", "0.5,1", "not read: '600nm_deviation_per_sr'"},
        {"R_per_sr,theta_h_deg,phi_d", "0.5,1,2", "not read: 'theta_h_deg', 'phi_d'"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[512];
        snprintf(text, sizeof text, ANGLES ",%s\n10,0,60,180,%s\n", cases[k].columns, cases[k].row);
        gonio_readings *readings = read_good(text, "");
        assert_near(gonio_readings_value(readings, 0, 0), 0.5);
        assert_note(readings, cases[k].note);
        gonio_readings_free(&readings);
    }
}

static void test_what_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *columns;
        const char *row;
        const char *message;
    } cases[] = {
        {"voltage", "0.5", "no column of values: 'voltage' is not understood"},
        {"remark", "wet", "a plan that was not measured yet?"},
        {"0.633nm_per_sr", "0.5", "0.633 nm is not light; is it in um? Give nm"},
        {"0.55", "0.5", "0.55 nm is not light; is it in um?"},
        {"1,2", "0.5,1", "1 nm is not light"},
        {"R_per_sr,550nm_per_sr", "1,1", "colours (R_per_sr) and of wavelengths (550nm_per_sr)"},
        {"550nm,550.0 nm", "1,1", "two columns of 550 nm, '550nm' and '550.0 nm'"},
        {"red_per_sr,R_per_sr", "1,1", "two columns of R, 'red_per_sr' and 'R_per_sr'"},
        {"brdf,bsdf", "1,1", "two columns of values, 'brdf' and 'bsdf'"},
        {"R_percent,G_per_sr", "1,1", "'R_percent' and 'G_per_sr' differ in their unit"},
        {"brdf R (%),brdf G (1/sr),brdf B (%)", "1,1,1", "differ in their unit"},
        {"brdf,sd", "0.5,-1", "sd '-1' is not a standard deviation"},
    };
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[512];
        gonio_readings *readings = NULL;
        snprintf(text, sizeof text, ANGLES ",%s\n10,0,60,180,%s\n", cases[k].columns, cases[k].row);
        const gonio_status status = read_text(context, text, "", true, &readings);
        if (status == GONIO_OK || strstr(support_message(), cases[k].message) == NULL) {
            fail_msg("'%s': '%s'", cases[k].columns, support_message());
        }
        assert_null(readings);
    }
    gonio_context_free(&context);
}

static void test_deviations(void **state)
{
    (void)state;
    static const struct {
        const char *columns;
        const char *row;
        size_t channel;
        double expected;
    } cases[] = {
        {"G_per_sr,G_deviation_per_sr", "0.5,0.01", 1, 0.01},
        {"R_per_sr,G_per_sr,u(G),u(R)", "0.3,0.5,0.02,0.01", 1, 0.02},
        {"550nm,550nm_sd", "0.5,0.01", 0, 0.01},
        {"550nm,600nm,sd 600 nm", "0.4,0.5,0.03", 1, 0.03},
        {"brdf,brdf_uncertainty", "0.5,0.01", 0, 0.01},
        {"brdf,sd", "0.5,0.01", 0, 0.01},
        {"brdf,standard uncertainty (%)", "0.5,4", 0, 0.02},
        {"brdf,rel u", "0.5,0.1", 0, 0.05},
        {"brf,u", "1.5707963267948966,0.1", 0, 0.1 / M_PI},
        {"value1_per_sr,value2_per_sr,value2_deviation_per_sr", "0.1,0.5,0.01", 1, 0.01},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[512];
        snprintf(text, sizeof text, ANGLES ",%s\n10,0,60,180,%s\n", cases[k].columns, cases[k].row);
        print_message("%s\n", cases[k].columns);
        gonio_readings *readings = read_good(text, "");
        const gonio_readings_view *view = gonio_readings_describe(readings);
        assert_non_null(view->deviation);
        assert_near(view->value[cases[k].channel], 0.5);
        assert_near(view->deviation[cases[k].channel], cases[k].expected);
        gonio_readings_free(&readings);
    }
}

/* ---- angles ---- */

static void test_names_of_angles(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double degrees[4];
        const char *note;
    } cases[] = {
        {"theta_i,phi_i,theta_o,phi_o,brdf\n10,20,30,200,1\n", {10, 20, 30, 200}, "'theta_i'"},
        {"theta_in,phi_in,theta_out,phi_out,brdf\n10,20,30,200,1\n", {10, 20, 30, 200}, "degrees"},
        {"thetai,phii,thetar,phir,brdf\n10,20,30,200,1\n", {10, 20, 30, 200}, "degrees"},
        {"thetaIn,phiIn,thetaOut,phiOut,brdf\n10,20,30,200,1\n", {10, 20, 30, 200}, "degrees"},
        {"incidence angle,incident azimuth,viewing angle,viewing azimuth,brdf\n10,20,30,200,1\n",
         {10, 20, 30, 200},
         "degrees"},
        {"SZA,SAA,VZA,VAA,brf\n10,20,30,200,1\n", {10, 20, 30, 200}, "factors"},
        {"\xce\xb8_i [\xc2\xb0],\xcf\x86_i [\xc2\xb0],\xce\xb8_r [\xc2\xb0],\xcf\x86_r [\xc2\xb0],"
         "brdf\n10,20,30,200,1\n",
         {10, 20, 30, 200},
         "degrees"},
        {"phi_o_deg,theta_o_deg,phi_i_deg,theta_i_deg,brdf\n200,30,20,10,1\n",
         {10, 20, 30, 200},
         "(values 'brdf')"},
        {"theta_i_rad,phi_i_rad,theta_o_rad,phi_o_rad,value_per_sr\n0.5235988,0,1.0471976,"
         "3.1415927,1\n",
         {30.0000014, 0, 60.0000028, 180.000003},
         "angles in radians"},
        {"# angles: radians\ntheta_i,phi_i,theta_o,phi_o,brdf\n0.5,0,1,6.28319,1\n",
         {28.6478898, 0, 57.2957795, 0.000269},
         "angles in radians"},
        {"# angles: radians\n" ANGLES ",value_per_sr\n10,20,30,200,1\n", {10, 20, 30, 200}, ""},
        {"theta_i_deg,theta_o_deg,dphi_deg,brdf\n10,30,170,1\n", {10, 0, 30, 170}, "'dphi_deg'"},
        {"theta_i_deg,theta_o_deg,delta_phi,brdf\n10,30,-170,1\n", {10, 0, 30, 190}, ""},
        {"theta_i_deg,theta_o_deg,phi_diff,brdf\n10,30,-170,1\n", {10, 0, 30, 190}, ""},
        {"theta_i_deg,theta_o_deg,relative azimuth,brdf\n10,30,170,1\n", {10, 0, 30, 170}, ""},
        {"sza,vza,raa,brdf\n10,30,170,1\n", {10, 0, 30, 170}, ""},
        {"theta_i_deg,phi_i_deg,theta_o_deg,dphi,brdf\n10,20,30,170,1\n", {10, 20, 30, 190}, ""},
        {ANGLES ",dphi,brdf\n10,20,30,200,170,1\n", {10, 20, 30, 200}, "not read: 'dphi'"},
        {ANGLES ",brdf\n10,20,-30,20,1\n", {10, 20, 30, 200}, "1 with theta below zero"},
        {ANGLES ",value_per_sr\n10,740,30,-520,1\n", {10, 20, 30, 200}, ""},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        print_message("%s", cases[k].text);
        gonio_readings *readings = read_good(cases[k].text, "");
        assert_degrees(readings, 0, cases[k].degrees);
        if (cases[k].note[0] != '\0') {
            assert_note(readings, cases[k].note);
        }
        gonio_readings_free(&readings);
    }
}

/* Without azimuths readings are in the plane of incidence. */
static void test_angles_in_the_plane(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *as;
        double degrees[4];
        const char *note;
    } cases[] = {
        {"theta_i,theta_o,brdf\n30,40,1\n", "", {30, 0, 40, 180}, "equal signs on the mirror"},
        {"theta_i,theta_o,brdf\n30,-40,1\n", "", {30, 0, 40, 0}, "1 with theta below zero"},
        {"theta_i,theta_o,brdf\n30,-40,1\n", "mirror=180", {30, 0, 40, 180}, "opposite signs"},
        {"theta_i,theta_o,brdf\n-30,40,1\n", "mirror=180", {30, 180, 40, 0}, "opposite signs"},
        {"theta_i,theta_o,brdf\n-30,-40,1\n", "mirror=0", {30, 180, 40, 0}, "equal signs"},
        {"# mirror: 180\ntheta_i,theta_o,brdf\n30,40,1\n", "", {30, 0, 40, 0}, "opposite signs"},
        {"# mirror: 0\n" ANGLES ",value_per_sr\n30,0,40,0,1\n", "", {30, 0, 40, 180}, "phi_i on"},
        {"theta_i,angle from specular,brdf\n30,10,1\n", "", {30, 0, 40, 180}, "away from the"},
        {"theta_i,off-specular angle [rad],brdf\n1,-0.5,1\n",
         "angles=degrees",
         {1, 0, 0.5, 180},
         "from the mirror direction"},
        {"theta_i,aspecular angle,brdf\n45,15,1\n", "", {45, 0, 30, 180}, "towards the light"},
        {"theta_i,aspecular angle,brdf\n45,110,1\n", "mirror=0", {45, 0, 65, 0}, "towards the"},
        {"theta_i,phi_i,delta specular,brdf\n30,20,10,1\n", "", {30, 20, 40, 200}, "away from"},
        {ANGLES ",from specular,brdf\n30,0,40,180,9,1\n", "", {30, 0, 40, 180}, "not read"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        print_message("%s", cases[k].text);
        gonio_readings *readings = read_good(cases[k].text, cases[k].as);
        assert_degrees(readings, 0, cases[k].degrees);
        assert_note(readings, cases[k].note);
        gonio_readings_free(&readings);
    }
}

/* What is written has gonio's azimuths, and nothing that turns them again. */
static void test_the_plane_is_written_with_azimuths(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    const gonio_readings_options how = {.size = sizeof how, .values_needed = true};
    const double degrees[4] = {30, 0, 40, 180};
    gonio_readings *again = NULL;
    gonio_context *context = support_context();
    gonio_readings *readings = read_good("# mirror: 0\ntheta_i,theta_o,brdf\n30,40,1\n", "");
    snprintf(path, sizeof path, "%s/again.csv", folder);
    assert_int_equal(gonio_readings_write(context, readings, NULL, path), GONIO_OK);
    assert_int_equal(gonio_readings_read(context, path, &how, &again), GONIO_OK);
    assert_degrees(again, 0, degrees);
    gonio_readings_free(&again);
    gonio_readings_free(&readings);
    gonio_context_free(&context);
    support_remove(folder);
}

static void test_names_that_are_no_angles(void **state)
{
    (void)state;
    static const char *const names[] = {"phi",
                                        "theta",
                                        "light",
                                        "in",
                                        "temperature",
                                        "",
                                        "angle",
                                        "theta_1",
                                        "time",
                                        "phi_i_theta_i",
                                        "specular",
                                        "delta_theta",
                                        "theta_i from specular"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        if (gonio_i_column_name_of(names[k]).kind == GONIO_I_ANGLE) {
            fail_msg("'%s' is no angle", names[k]);
        }
    }
}

static void test_angles_that_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *message;
    } cases[] = {
        {"theta_i,phi_i,theta_in,theta_o,phi_o,brdf\n1,2,3,4,5,6\n",
         "two columns of the same angle, 'theta_i' and 'theta_in'"},
        {"theta_i_rad,phi_i_deg,theta_o,phi_o,brdf\n1,2,3,4,5\n",
         "the angles of columns 'theta_i_rad' and 'phi_i_deg' differ in their unit"},
        {"theta_i,theta_o,phi_o,brdf\n1,2,3,4\n", "no column 'phi_i_deg'"},
        {"theta_i,theta_o,brdf\n-30,30,1\n", "--as mirror=180 says"},
        {"theta_i,off-specular angle,raa,brdf\n30,10,0,1\n", "no azimuth as in 'raa' belongs"},
        {"theta_i,off specular,aspecular,brdf\n30,10,0,1\n", "two columns of the same angle"},
        {"theta_i,off specular,brdf\n30,10,1\n30,inf,1\n", "is not a finite number"},
        {"# angles: radians\ntheta_i,phi_i,theta_o,phi_o,brdf\n45,0,30,180,1\n",
         "these look like degrees: use --as angles=degrees"},
        {ANGLES ",brdf\n10,0,95,0,1\n", "none of the 1 rows is a reading above the horizon"},
    };
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_readings *readings = NULL;
        assert_true(read_text(context, cases[k].text, "", true, &readings) != GONIO_OK);
        if (strstr(support_message(), cases[k].message) == NULL) {
            fail_msg("%s%s", cases[k].text, support_message());
        }
    }
    gonio_context_free(&context);
}

/* A line for each wavelength, as data bases and data frames have it. */
static void test_a_line_for_each_wavelength(void **state)
{
    (void)state;
    static const double second[4] = {10, 0, 30, 180};
    gonio_readings *readings = read_good("lambda (um),theta_i,phi_i,theta_o,phi_o,brf,u,remark\n"
                                         "0.55,10,0,20,180,0.5,0.1,x\n0.45,10,0,20,180,0.4,0.1,\n"
                                         "0.65,10,0,30,180,0.6,0.1,\n0.45,10,0,30,180,0.7,,y\n"
                                         "0.45,10,0,95,180,0.7,,y\n",
                                         "");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, 2);
    assert_int_equal(view->channels, 3);
    assert_near(view->wavelength[0], 450.0);
    assert_near(view->wavelength[2], 650.0);
    assert_degrees(readings, 1, second);
    assert_near(view->value[0], 0.4 / M_PI);
    assert_near(view->value[1], 0.5 / M_PI);
    assert_true(isnan(view->value[2]));
    assert_near(view->deviation[1], 0.1 / M_PI);
    assert_near(view->value[3], 0.7 / M_PI);
    assert_true(isnan(view->deviation[3]));
    assert_note(readings, "CSV with a line for each wavelength (angles 'theta_i'");
    assert_note(readings, "wavelengths in micrometres; 2 readings; left out: 1 at or below");
    gonio_readings_free(&readings);

    readings = read_good(ANGLES ",wavelength,value_per_sr\n10,0,20,180,633,0.5\n", "");
    assert_near(gonio_readings_describe(readings)->wavelength[0], 633.0);
    gonio_readings_free(&readings);
}

static void test_bad_lines_for_each_wavelength(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *message;
    } cases[] = {
        {ANGLES ",wavelength,brdf\n1,0,2,0,550,1\n1,0,2,0,500,1\n1,0,2,0,550,1\n",
         "r.csv:4: the same directions and channel as line 2"},
        {ANGLES ",wavelength,brdf\n1,0,2,0,,1\n", "r.csv:2: wavelength '' is not a wavelength"},
        {ANGLES ",wavelength,brdf\n1,0,2,0,-5,1\n", "r.csv:2: wavelength '-5' is not a wavelength"},
        {ANGLES ",wavelength,brdf\n1,0,2,0,0.55,1\n", "0.55 nm is not light; is it in um?"},
        {ANGLES ",wavelength,brdf\n", "no lines below the column names"},
        {ANGLES ",wavelength\n1,0,2,0,550\n", "'wavelength' is not understood"},
    };
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_readings *readings = NULL;
        assert_true(read_text(context, cases[k].text, "", true, &readings) != GONIO_OK);
        if (strstr(support_message(), cases[k].message) == NULL) {
            fail_msg("%s%s", cases[k].text, support_message());
        }
    }
    gonio_context_free(&context);
}

/* What the user says goes before names and comments. */
static void test_the_user_knows_better(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_good(ANGLES ",0.633nm_per_sr\n0.5,0,1,0,0\n0.25,0,1,0,1\n",
                  "angles=radians,values=factor,wavelengths=um,mirror=0,zeros=missing");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, 2);
    assert_near(view->wavelength[0], 633.0);
    assert_near(view->pair[1].outgoing.phi, M_PI);
    assert_true(fabs(view->pair[1].incident.theta - 0.25) < 1e-9);
    assert_true(isnan(view->value[0]));
    assert_near(view->value[1], 1.0 / M_PI);
    assert_note(readings, "angles in radians, phi_o = phi_i on the mirror's side, reflectance");
    gonio_readings_free(&readings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_of_values),
        cmocka_unit_test(test_numbers_that_are_not_read),
        cmocka_unit_test(test_what_is_refused),
        cmocka_unit_test(test_deviations),
        cmocka_unit_test(test_names_of_angles),
        cmocka_unit_test(test_angles_in_the_plane),
        cmocka_unit_test(test_the_plane_is_written_with_azimuths),
        cmocka_unit_test(test_names_that_are_no_angles),
        cmocka_unit_test(test_angles_that_are_refused),
        cmocka_unit_test(test_a_line_for_each_wavelength),
        cmocka_unit_test(test_bad_lines_for_each_wavelength),
        cmocka_unit_test(test_the_user_knows_better),
    };
    return cmocka_run_group_tests_name("csv readings", tests, NULL, NULL);
}
