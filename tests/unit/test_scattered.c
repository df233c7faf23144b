/* Scattered readings as text, and spectral columns of CSV files: good ones, and hostile ones. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "made_readings.h"

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

static gonio_readings *read_good(const char *name, const char *text)
{
    char *folder = support_folder();
    gonio_readings *readings = NULL;
    assert_int_equal(made_readings(NULL, folder, name, text, NULL, &readings), GONIO_OK);
    support_remove(folder);
    return readings;
}

/* Comments and line breaks anywhere. */
static void test_a_good_file(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_good("good.brdf", "# a paint\n\n3 # wavelengths\n# nm\n400 550.5\n700\n"
                               "0.872665 0 0.573513 0.5\n0.001 0.002 3e-3\n"
                               "0.1 6.2 0.2 -0.26 # angles\r\n0 1e-6 12.5\n");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, 2);
    assert_int_equal(view->channels, 3);
    assert_false(gonio_readings_are_colours(readings));
    static const double wavelengths[3] = {400.0, 550.5, 700.0};
    static const double values[2][3] = {{0.001, 0.002, 0.003}, {0.0, 1e-6, 12.5}};
    for (size_t k = 0; k < 3; k++) {
        assert_close(view->wavelength[k], wavelengths[k], 1e-12);
        assert_close(gonio_readings_scale(readings, k), 1.0 / 1500.0, 1e-15);
        for (size_t i = 0; i < 2; i++) {
            assert_close(gonio_readings_value(readings, i, k), values[i][k], 1e-12);
        }
    }
    const gonio_pair a = view->pair[0];
    const gonio_pair b = view->pair[1];
    assert_close(a.incident.theta, 0.872665, 1e-9);
    assert_close(a.outgoing.theta, 0.573513, 1e-9);
    assert_close(a.outgoing.phi, 0.5, 1e-9);
    assert_close(b.incident.phi, 6.2, 1e-8);
    assert_close(b.outgoing.phi, 2.0 * M_PI - 0.26, 1e-8);
    gonio_readings_free(&readings);
}

static void test_bad_files(void **state)
{
    (void)state;
    static const made_bad_file cases[] = {
        {"2\n400 500\n0.1 0.2 0.3 0.4 1", GONIO_ERROR_FORMAT, "ends within a reading"},
        {"2\n400 500\n0.1 0.2 0.3 0.4 1 2\n0.1 0.2", GONIO_ERROR_FORMAT, "ends within a reading"},
        {"5\n400 500", GONIO_ERROR_FORMAT, "ends within a reading"},
        {"2\n400 500\n", GONIO_ERROR_DATA, "no readings in it"},
        {"2\n400 500\n0.1 0.2 bright 0.4 1 2\n", GONIO_ERROR_FORMAT,
         ":3: 'bright' is not a number"},
        {"2\n400 500\n0.1 0.2 0.3 0.4 1 nan\n", GONIO_ERROR_FORMAT, ":3: 'nan' is not a number"},
        {"2\n400 500\n0.1 0.2 0.3 0.4 inf 1\n", GONIO_ERROR_FORMAT, "'inf' is not a number"},
        {"2\n400 500\n0.1 0.2 0.3 0.4 1e999 1\n", GONIO_ERROR_FORMAT, "'1e999' is not a number"},
        {"2\n400 500\n0.1 0.2 0.3 0.4 1,5 2\n", GONIO_ERROR_FORMAT, "'1,5' is not a number"},
        {"2\n400 red\n0.1 0.2 0.3 0.4 1 2\n", GONIO_ERROR_FORMAT, ":2: 'red' is not a number"},
        {"2\n400 0\n0.1 0.2 0.3 0.4 1 2\n", GONIO_ERROR_FORMAT, "0 is not a wavelength"},
        {"2\n-400 500\n0.1 0.2 0.3 0.4 1 2\n", GONIO_ERROR_FORMAT, "-400 is not a wavelength"},
        {"2\n400 400\n0.1 0.2 0.3 0.4 1 2\n", GONIO_ERROR_FORMAT, "400 nm occurs twice"},
        {"2\n0.4 0.5\n0.1 0.2 0.3 0.4 1 2\n", GONIO_ERROR_FORMAT,
         "a wavelength of 0.4 nm is not light; is it in um?"},
        {"0\n0.1 0.2 0.3 0.4\n", GONIO_ERROR_FORMAT, "0 wavelengths; 1 to 4096"},
        {"99999999999999999999\n400\n", GONIO_ERROR_FORMAT, "wavelengths; 1 to 4096"},
        {"4097\n400\n", GONIO_ERROR_FORMAT, "4097 wavelengths; 1 to 4096"},
        {"2\n400 500\n0.1 0.2 0.3 0.4 -1 2\n", GONIO_ERROR_DATA, "is negative"},
        {"2\n400 500\n1.6 0.2 0.3 0.4 1 2\n", GONIO_ERROR_DATA,
         "none of the 1 rows is a reading above the horizon"},
        {"2\n400 500\n45 0.2 0.3 0.4 1 2\n", GONIO_ERROR_DATA,
         ":3: theta_i = 45 is impossible in radians; these look like degrees"},
        {"2\n400 500\n0.1 50 0.3 0.4 1 2\n", GONIO_ERROR_DATA, ":3: phi_i = 50 is impossible"},
    };
    assert_bad_files("bad.brdf", cases, sizeof cases / sizeof *cases);
}

static void test_negative_values_may_be_taken_as_zero(void **state)
{
    (void)state;
    const gonio_readings_options options = {
        .size = sizeof options, .values_needed = true, .negative_to_zero = true};
    char *folder = support_folder();
    gonio_readings *readings = NULL;
    assert_int_equal(
        made_readings(NULL, folder, "r.brdf", "1\n400\n0.1 0 0.2 0 -1e-5\n", &options, &readings),
        GONIO_OK);
    assert_true(gonio_readings_value(readings, 0, 0) == 0.0);
    gonio_readings_free(&readings);
    support_remove(folder);
}

/* ---- CSV ---- */

static const char angles[] = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg";

static gonio_status read_csv(gonio_context *context, const char *columns, const char *line,
                             gonio_readings **readings)
{
    char text[1024];
    char *folder = support_folder();
    snprintf(text, sizeof text, "%s,%s\n10,0,20,180,%s\n", angles, columns, line);
    const gonio_status status = made_readings(context, folder, "r.csv", text, NULL, readings);
    support_remove(folder);
    return status;
}

static void test_spectral_columns(void **state)
{
    (void)state;
    gonio_readings *readings = NULL;
    assert_int_equal(
        read_csv(NULL, "note,700nm_per_sr,400.5NM_PER_SR,550nm_per_sr", "x,0.7,0.4,", &readings),
        GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->channels, 3);
    assert_non_null(view->wavelength);
    assert_close(view->wavelength[0], 700.0, 0.0);
    assert_close(view->wavelength[1], 400.5, 0.0);
    assert_close(view->wavelength[2], 550.0, 0.0);
    assert_close(gonio_readings_value(readings, 0, 0), 0.7, 0.0);
    assert_close(gonio_readings_value(readings, 0, 1), 0.4, 0.0);
    assert_true(isnan(gonio_readings_value(readings, 0, 2)));
    gonio_readings_free(&readings);
}

static void test_bad_spectral_columns(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_readings *readings = NULL;
    assert_int_equal(read_csv(context, "400nm_per_sr,R_per_sr", "1,1", &readings),
                     GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "delete one kind"));
    assert_int_equal(read_csv(context, "400nm_per_sr", "-1", &readings), GONIO_ERROR_DATA);
    assert_non_null(strstr(support_message(), "400nm_per_sr '-1' is negative"));
    assert_int_equal(read_csv(context, "400nm_per_sr", "bright", &readings), GONIO_ERROR_FORMAT);
    /* What is not named by a wavelength is no column of values. */
    static const char *const others[] = {"0nm_per_sr", "-400nm_per_sr", "nm_per_sr", "infnm_per_sr",
                                         "1e9nm_per_sr"};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        assert_int_equal(read_csv(context, others[k], "1", &readings), GONIO_ERROR_FORMAT);
        assert_non_null(strstr(support_message(), "no column of values"));
        assert_non_null(strstr(support_message(), others[k])); /* it holds a number */
        assert_null(readings);
    }
    gonio_context_free(&context);
}

/* What is written is read again as the same. */
static void test_the_round_trip(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_good("r.brdf", "2\n400 500\n0.123456 1 0.2 3 0.001 0.002\n0.3 0 0.1 2 0.5 0\n");
    char *folder = support_folder();
    char path[256];
    gonio_readings *again = NULL;
    snprintf(path, sizeof path, "%s/w.csv", folder);
    assert_int_equal(gonio_readings_write(NULL, readings, NULL, path), GONIO_OK);
    assert_int_equal(gonio_readings_read(NULL, path, NULL, &again), GONIO_OK);
    const gonio_readings_view *a = gonio_readings_describe(readings);
    const gonio_readings_view *b = gonio_readings_describe(again);
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->channels, b->channels);
    assert_memory_equal(a->wavelength, b->wavelength, a->channels * sizeof *a->wavelength);
    for (size_t i = 0; i < a->count; i++) {
        assert_close(b->pair[i].incident.theta, a->pair[i].incident.theta, 1e-8);
        assert_close(b->pair[i].outgoing.phi, a->pair[i].outgoing.phi, 1e-8);
        for (size_t k = 0; k < a->channels; k++) {
            const double value = gonio_readings_value(readings, i, k);
            assert_close(gonio_readings_value(again, i, k), value, 1e-6 * value);
        }
    }
    gonio_readings_free(&again);
    gonio_readings_free(&readings);
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_good_file),
        cmocka_unit_test(test_bad_files),
        cmocka_unit_test(test_negative_values_may_be_taken_as_zero),
        cmocka_unit_test(test_spectral_columns),
        cmocka_unit_test(test_bad_spectral_columns),
        cmocka_unit_test(test_the_round_trip),
    };
    return cmocka_run_group_tests_name("scattered and spectral readings", tests, NULL, NULL);
}
