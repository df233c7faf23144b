/* From the conventions of files to readings: units, sides, what is left out, and what is said. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "../../src/measurement/import.h"
#include "made_readings.h"

static void assert_near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fmax(1.0, fabs(expected)))) {
        fail_msg("%.17g where %.17g is expected", value, expected);
    }
}

/* ---- conventions ---- */

static void test_conventions_from_text(void **state)
{
    (void)state;
    gonio_convention c = {.zeros = GONIO_ZEROS_DARK};
    assert_int_equal(gonio_convention_parse(NULL,
                                            "angles=radians,values=factor-cosine,mirror=0,"
                                            "wavelengths=um,sample=12,format=scattered",
                                            &c),
                     GONIO_OK);
    assert_int_equal(c.angles, GONIO_RADIANS);
    assert_int_equal(c.values, GONIO_VALUE_FACTOR_COSINE);
    assert_int_equal(c.mirror, GONIO_MIRROR_0);
    assert_int_equal(c.wavelengths, GONIO_MICROMETRES);
    assert_int_equal(c.zeros, GONIO_ZEROS_DARK);
    assert_int_equal(c.sample, 12);
    assert_string_equal(c.format, "scattered");
    assert_null(gonio_readings_format_word(-1));
}

static void test_what_is_no_convention(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *message;
    } cases[] = {
        {"angles=turns", "the choices are degrees, radians, gon"},
        {"scale=log", "the choices are linear, log10, ln, db"},
        {"angle=degrees", "'angle': KEY=WORD is expected"},
        {"degrees", "'degrees': KEY=WORD is expected"},
        {"sample=0", "the number of a sample, from 1"},
        {"sample=2x", "the number of a sample, from 1"},
        {"format=word", "the choices are "},
        {"values=", "the choices are brdf, factor, percent, cosine, factor-cosine"},
    };
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_convention c = {.angles = GONIO_DEGREES, .sample = 3};
        assert_int_equal(gonio_convention_parse(context, cases[k].text, &c), GONIO_ERROR_ARGUMENT);
        assert_non_null(strstr(support_message(), cases[k].message));
        assert_int_equal(c.angles, GONIO_DEGREES);
        assert_int_equal(c.sample, 3);
    }
    gonio_context_free(&context);
}

/* ---- what the user says of a file ---- */

static gonio_readings *read_as(const char *text, const char *as)
{
    gonio_readings_options options;
    gonio_readings *readings = NULL;
    char *folder = support_folder();
    gonio_readings_options_default(&options);
    assert_int_equal(gonio_convention_parse(NULL, as, &options.as), GONIO_OK);
    assert_int_equal(made_readings(NULL, folder, "r.brdf", text, &options, &readings), GONIO_OK);
    support_remove(folder);
    return readings;
}

static void test_units(void **state)
{
    (void)state;
    static const char text[] = "1\n0.5\n30 0 60 180 0.5\n";
    static const struct {
        const char *values;
        double expected;
    } cases[] = {{"brdf", 0.5},
                 {"factor", 0.5 / M_PI},
                 {"percent", 0.005 / M_PI},
                 {"cosine", 1.0},
                 {"factor-cosine", 1.0 / M_PI}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char as[128];
        snprintf(as, sizeof as, "angles=degrees,wavelengths=um,format=scattered,values=%s",
                 cases[k].values);
        gonio_readings *readings = read_as(text, as);
        const gonio_readings_view *view = gonio_readings_describe(readings);
        assert_near(view->wavelength[0], 500.0);
        assert_near(view->pair[0].outgoing.theta, M_PI / 3.0);
        assert_near(gonio_readings_value(readings, 0, 0), cases[k].expected);
        gonio_readings_free(&readings);
    }
}

static void test_sides_turns_and_the_horizon(void **state)
{
    (void)state;
    gonio_readings *readings = read_as("1\n500\n30 0 -60 0 1\n30 0 60 0 2\n30 0 90 0 3\n"
                                       "100 0 20 0 4\n10 -370 20 400 5\n",
                                       "angles=degrees");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, 3);
    assert_near(view->pair[0].outgoing.theta, M_PI / 3.0);
    assert_near(view->pair[0].outgoing.phi, M_PI);
    assert_near(view->pair[1].outgoing.phi, 0.0);
    assert_near(view->pair[2].incident.phi, 350.0 * M_PI / 180.0);
    assert_near(view->pair[2].outgoing.phi, 40.0 * M_PI / 180.0);
    assert_int_equal(view->notes, 1);
    assert_non_null(strstr(view->note[0], "3 readings; left out: 2 at or below the horizon"));
    gonio_readings_free(&readings);

    readings = read_as("1\n500\n30 0 30 0 1\n", "angles=degrees,mirror=0");
    assert_near(gonio_readings_describe(readings)->pair[0].outgoing.phi, M_PI);
    gonio_readings_free(&readings);
}

static void test_zeros(void **state)
{
    (void)state;
    static const char text[] = "2\n500 600\n30 0 60 180 0 1\n30 0 50 180 0 0\n";
    gonio_readings *readings = read_as(text, "angles=degrees,zeros=missing");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, 1);
    assert_true(isnan(gonio_readings_value(readings, 0, 0)));
    assert_non_null(strstr(view->note[0], "0 means not measured"));
    assert_non_null(strstr(view->note[0], "1 not measured"));
    gonio_readings_free(&readings);
    readings = read_as(text, "angles=degrees");
    assert_int_equal(gonio_readings_describe(readings)->count, 2);
    gonio_readings_free(&readings);
}

/* ---- what readers are lenient about ---- */

static gonio_readings *import_rows(const double (*row)[5], size_t count)
{
    static const gonio_convention stated = {.angles = GONIO_DEGREES, .values = GONIO_VALUE_BRDF};
    gonio_readings *readings = NULL;
    gonio_i_import in;
    assert_int_equal(gonio_i_readings_new(NULL, "made", NULL, &readings), GONIO_OK);
    gonio_i_import_begin(&in, NULL, readings, "rows", &stated);
    gonio_i_import_leniently(&in);
    gonio_status status = gonio_i_import_channels(&in, 1, NULL);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        gonio_i_row r = {.planned = GONIO_ALL_CHANNELS, .line = k + 1, .value = &row[k][4]};
        memcpy(r.degrees, row[k], sizeof r.degrees);
        status = gonio_i_import_add(&in, &r);
    }
    assert_int_equal(gonio_i_import_end(&in, status), GONIO_OK);
    assert_int_equal(gonio_i_readings_finish(NULL, readings, true), GONIO_OK);
    return readings;
}

/* theta_o = 0 for each azimuth is one reading; other values of the same directions are kept. */
static void test_repeats_and_noise(void **state)
{
    (void)state;
    static const double row[][5] = {{30, 0, 0, 0, 0.2},  {30, 0, 0, 90, 0.2},  {30, 0, 0, 180, 0.2},
                                    {30, 0, 10, 0, 0.1}, {30, 0, 10, 0, 0.3},  {0, 50, 10, 0, 0.4},
                                    {0, 0, 10, 0, 0.4},  {30, 0, 70, 0, -1e-5}};
    gonio_readings *readings = import_rows(row, sizeof row / sizeof *row);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, 5);
    assert_int_equal(view->line[0], 1);
    assert_int_equal(view->line[1], 4);
    assert_int_equal(view->line[2], 5);
    assert_near(gonio_readings_value(readings, 4, 0), 0.0);
    assert_non_null(strstr(view->note[0], "3 repeated with the same values"));
    assert_non_null(strstr(view->note[0], "1 value below zero taken as 0"));
    gonio_readings_free(&readings);
}

/* A fan at 50 degrees: shadowed from 80 on at the mirror's side, stray light at the other. Where 0
 * is a value, nothing is judged. */
static void test_what_is_lost_near_the_horizon(void **state)
{
    (void)state;
    static const char fan[] =
        "type bsdf_data\n50 0\n0 0 0.01\n10 0 0.01\n20 0 0.011\n30 0 0.012\n"
        "40 0 0.02\n60 0 0.03\n70 0 0.045\n75 0 0.06\n80 0 0.002\n85 0 1e-7\n"
        "10 180 0.01\n20 180 0.01\n30 180 0.0099\n70 180 0.009\n75 180 0.008\n"
        "80 180 0.0001\n85 180 0.5\n";
    gonio_readings_options options;
    gonio_readings_options_default(&options);
    char *folder = support_folder();
    gonio_readings *readings = NULL;
    assert_int_equal(made_readings(NULL, folder, "r.txt", fan, &options, &readings), GONIO_OK);
    assert_int_equal(gonio_readings_describe(readings)->count, 13);
    assert_non_null(strstr(gonio_readings_describe(readings)->note[0],
                           "left out: 4 too low or too high near the horizon"));
    gonio_readings_free(&readings);
    options.as.zeros = GONIO_ZEROS_DARK;
    assert_int_equal(made_readings(NULL, folder, "r.txt", fan, &options, &readings), GONIO_OK);
    assert_int_equal(gonio_readings_describe(readings)->count, 17);
    gonio_readings_free(&readings);
    support_remove(folder);
}

/* A narrow peak towards grazing is no shadow. */
static void test_a_peak_near_the_horizon_stays(void **state)
{
    (void)state;
    static const char fan[] =
        "type bsdf_data\n70 0\n0 0 0.01\n10 0 0.01\n20 0 0.01\n30 0 0.01\n"
        "40 0 0.011\n50 0 0.012\n60 0 0.014\n68 0 1\n70 0 50\n72 0 10\n75 0 1\n"
        "78 0 0.05\n80 0 0.03\n85 0 0.025\n";
    char *folder = support_folder();
    gonio_readings *readings = NULL;
    assert_int_equal(made_readings(NULL, folder, "r.txt", fan, NULL, &readings), GONIO_OK);
    assert_int_equal(gonio_readings_describe(readings)->count, 14);
    gonio_readings_free(&readings);
    support_remove(folder);
}

/* ---- about the mirror direction ---- */

static void test_directions_about_the_mirror(void **state)
{
    (void)state;
    static const double cases[][5] = {
        /* theta_i, radial, azimuth: theta_o, phi_o - phi_i */
        {30, 0, 0, 30, 180},    {30, 0, 77, 30, 180},    {30, 10, 0, 20, 180},
        {30, 10, 180, 40, 180}, {30, 30, 0, 0, 0},       {30, 50, 0, 20, 0},
        {0, 20, 0, 20, 0},      {70, 30, 180, 100, 180}, {0, 20, 90, 20, 90},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double theta = 0.0;
        double phi = 0.0;
        gonio_i_from_mirror(cases[k][0], cases[k][1], cases[k][2], &theta, &phi);
        assert_near(theta, cases[k][3]);
        assert_near(fmod(phi + 360.0, 360.0), cases[k][4]);
    }
    /* The angle to the mirror direction is the radial one, whatever the azimuth. */
    for (double azimuth = 0.0; azimuth < 360.0; azimuth += 30.0) {
        double theta = 0.0;
        double phi = 0.0;
        gonio_i_from_mirror(50.0, 25.0, azimuth, &theta, &phi);
        const double t = theta * M_PI / 180.0;
        const double p = phi * M_PI / 180.0;
        const double m = 50.0 * M_PI / 180.0;
        const double cosine = -sin(m) * sin(t) * cos(p) + cos(m) * cos(t);
        assert_true(fabs(cosine - cos(25.0 * M_PI / 180.0)) < 1e-8); /* nine digits of degrees */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_conventions_from_text),
        cmocka_unit_test(test_what_is_no_convention),
        cmocka_unit_test(test_units),
        cmocka_unit_test(test_sides_turns_and_the_horizon),
        cmocka_unit_test(test_zeros),
        cmocka_unit_test(test_repeats_and_noise),
        cmocka_unit_test(test_what_is_lost_near_the_horizon),
        cmocka_unit_test(test_a_peak_near_the_horizon_stays),
        cmocka_unit_test(test_directions_about_the_mirror),
    };
    return cmocka_run_group_tests_name("from the conventions of files to readings", tests, NULL,
                                       NULL);
}
