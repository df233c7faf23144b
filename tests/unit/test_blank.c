/* A blank run, subtracted with its uncertainty, and readings relative to a reference. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "made_readings.h"

#define NAMES "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,"

static gonio_readings *read_text(const char *text)
{
    const gonio_readings_options any = {.size = sizeof any,
                                        .values_needed = true,
                                        .average_repeats = true,
                                        .negative_to_zero = true};
    gonio_context *context = support_context();
    gonio_readings *readings = NULL;
    if (gonio_readings_read_text(context, "run", text, strlen(text), &any, &readings) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    gonio_context_free(&context);
    return readings;
}

/* Reads a text as readings of an instrument with these values. */
static gonio_status read_of(const char *values, const char *text, gonio_readings **readings)
{
    gonio_readings_options how = {
        .size = sizeof how, .values_needed = true, .average_repeats = true};
    gonio_context *context = support_context();
    gonio_instrument *instrument = NULL;
    char rig[512];
    snprintf(rig, sizeof rig,
             "{\"gonio_instrument\": 1, \"kinematics\": \"direct\", \"values\": %s,"
             "\"axes\": {\"theta_i\": {\"from_deg\": 0, \"to_deg\": 80},"
             "\"theta_o\": {\"from_deg\": 0, \"to_deg\": 80}}}",
             values);
    if (gonio_instrument_parse(context, rig, "rig", &instrument) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    how.instrument = instrument;
    const gonio_status status =
        gonio_readings_read_text(context, "run", text, strlen(text), &how, readings);
    gonio_instrument_free(&instrument);
    gonio_context_free(&context);
    return status;
}

static void assert_note(const gonio_readings *readings, const char *part)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    bool found = false;
    for (size_t k = 0; k < view->notes; k++) {
        found = found || strstr(view->note[k], part) != NULL;
    }
    if (!found) {
        fail_msg("'%s' is not noted", part);
    }
}

static void assert_near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fmax(1.0, fabs(expected)))) {
        fail_msg("%.17g where %.17g is expected", value, expected);
    }
}

static gonio_readings *subtract(const char *sample, const char *dark, double noise, double floor)
{
    gonio_readings *readings = read_text(sample);
    gonio_readings *blank = read_text(dark);
    assert_int_equal(gonio_readings_subtract_blank(NULL, readings, blank, noise, floor), GONIO_OK);
    gonio_readings_free(&blank);
    return readings;
}

/* At the same directions the blank of these, elsewhere its median; deviations add up. */
static void test_levels(void **state)
{
    (void)state;
    gonio_readings *r = subtract(NAMES "value_per_sr\n30,0,40,180,0.5\n30,0,60,180,0.04\n",
                                 NAMES "value_per_sr\n30,0,40,180,0.02\n30,0,40,180,0.04\n"
                                       "30,0,20,180,0.03\n",
                                 0.1, 0.003);
    const gonio_readings_view *view = gonio_readings_describe(r);
    assert_near(view->value[0], 0.47);
    assert_near(view->value[1], 0.01);
    const double scatter = sqrt(0.02 * 0.02 / 2.0);
    assert_near(view->deviation[0], hypot(hypot(0.05, 0.003), scatter / sqrt(2.0)));
    assert_near(view->deviation[1], hypot(hypot(0.004, 0.003), scatter));
    assert_note(r, "at 1 the blank of the same directions, at 1 its median");
    gonio_readings_free(&r);
}

/* Own deviations count. A level is the same in the unit of the file, whatever the direction. */
static void test_units(void **state)
{
    (void)state;
    gonio_readings *r = subtract(NAMES "brdf_cos,u(brdf_cos)\n30,0,60,180,0.5,0.03\n",
                                 NAMES "brdf_cos,u(brdf_cos)\n0,0,10,0,0.1,0.04\n", 0.01, 1e-5);
    const gonio_readings_view *view = gonio_readings_describe(r);
    assert_near(view->value[0], 0.4 / cos(M_PI / 3.0));
    assert_near(view->deviation[0], 0.03 / cos(M_PI / 3.0));
    gonio_readings_free(&r);
    r = subtract(NAMES "value_per_sr,value_deviation_per_sr\n30,0,60,180,0.5,0.03\n",
                 NAMES "value_per_sr,value_deviation_per_sr\n30,0,60,180,0.1,0.04\n", 0.01, 1e-5);
    assert_near(gonio_readings_describe(r)->deviation[0], 0.05);
    gonio_readings_free(&r);
}

static void test_brighter_than_the_sample(void **state)
{
    (void)state;
    gonio_readings *r = subtract(NAMES "value_per_sr\n30,0,40,180,0.5\n30,0,60,180,0.01\n"
                                       "30,0,70,180,0.01\n",
                                 NAMES "value_per_sr\n30,0,40,180,0.1\n30,0,60,180,0.1\n"
                                       "30,0,70,180,0.1\n",
                                 0.01, 1e-5);
    assert_near(gonio_readings_value(r, 1, 0), 0.0);
    assert_note(r, "brighter than the sample in 2 of 3 values (first in line 3)");
    assert_note(r, "are the two files exchanged");
    gonio_readings_free(&r);
}

static void test_other_channels(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_readings *r = read_text(NAMES "400nm_per_sr\n30,0,40,180,0.5\n");
    gonio_readings *dark = read_text(NAMES "500nm_per_sr\n30,0,40,180,0.5\n");
    assert_int_equal(gonio_readings_subtract_blank(context, r, dark, 0.01, 1e-5),
                     GONIO_ERROR_MISMATCH);
    assert_near(gonio_readings_value(r, 0, 0), 0.5);
    gonio_readings_free(&r);
    gonio_readings_free(&dark);
    gonio_context_free(&context);
}

static gonio_status read_reference(gonio_context *context, const char *text,
                                   gonio_reference_row **row, size_t *rows)
{
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/tile.csv", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    const gonio_status status = gonio_reference_read(context, path, row, rows);
    support_remove(folder);
    return status;
}

static void test_reference(void **state)
{
    (void)state;
    gonio_reference_row *row = NULL;
    size_t rows = 0;
    assert_int_equal(
        read_reference(NULL, "theta_r;brf\n75;0,907\n12;1,072\n45;1,023\n", &row, &rows), GONIO_OK);
    assert_int_equal(rows, 3);
    gonio_readings *r = read_text(NAMES "brf\n30,0,0,180,0.5\n30,0,60,180,0.5\n30,0,80,180,0.5\n");
    assert_int_equal(gonio_readings_times_reference(NULL, r, row, rows), GONIO_OK);
    assert_near(gonio_readings_value(r, 0, 0), 0.5 / M_PI * 1.072);
    assert_near(gonio_readings_value(r, 1, 0), 0.5 / M_PI * 0.965);
    assert_near(gonio_readings_value(r, 2, 0), 0.5 / M_PI * 0.907);
    assert_note(r, "reflectance factor 0.907 to 1.072");
    gonio_readings_free(&r);
    free(row);
}

static void test_bad_references(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        gonio_status status;
        const char *message;
    } cases[] = {{"a,b\n1,2\n", GONIO_ERROR_FORMAT, "theta_r_deg and brf"},
                 {"theta_r,brf\n", GONIO_ERROR_DATA, "no rows"},
                 {"theta_r,brf\n95,1\n", GONIO_ERROR_DATA, "tile.csv:2"},
                 {"theta_r,brf\n45,0\n", GONIO_ERROR_DATA, "above 0"},
                 {"theta_r,brf\n45,white\n", GONIO_ERROR_DATA, "above 0"}};
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_reference_row *row = NULL;
        size_t rows = 0;
        assert_int_equal(read_reference(context, cases[k].text, &row, &rows), cases[k].status);
        assert_non_null(strstr(support_message(), cases[k].message));
        assert_null(row);
    }
    gonio_context_free(&context);
}

#define RELATIVE                                                                                   \
    "{\"kind\": \"relative\", \"reference\": \"tile\", \"reference_factors\": [[0, 1], [80, "      \
    "0.6]]}"
#define COUNTS "{\"kind\": \"counts\", \"counts_of_1_per_sr\": 5e4}"

static double value_of(const char *values, const char *text)
{
    gonio_readings *r = NULL;
    if (read_of(values, text, &r) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    const double value = gonio_readings_describe(r)->value[0];
    gonio_readings_free(&r);
    return value;
}

/* Numbers of which a table says nothing are the instrument's; what it says comes first. */
static void test_numbers_of_an_instrument(void **state)
{
    (void)state;
    const double cosine = cos(40.0 * M_PI / 180.0);
    assert_near(value_of(RELATIVE, NAMES "value\n30,0,40,180,0.5\n"), 0.5 * 0.8 / M_PI);
    assert_near(value_of(COUNTS, NAMES "value\n30,0,40,180,5000\n"), 0.1 / cosine);
    assert_near(value_of(COUNTS, NAMES "counts\n30,0,40,180,5000\n"), 0.1 / cosine);
    assert_near(value_of("\"factor\"", NAMES "value\n30,0,40,180,0.5\n"), 0.5 / M_PI);
    assert_near(value_of(COUNTS, NAMES "value_per_sr\n30,0,40,180,0.5\n"), 0.5);
    assert_near(value_of(RELATIVE, "# values: cosine\n" NAMES "value\n30,0,40,180,0.5\n"),
                0.5 / cosine);
    assert_near(value_of(COUNTS, NAMES "value_per_sr,counts\n30,0,40,180,0.5,7\n"), 0.5);
}

static void test_counts_need_an_instrument(void **state)
{
    (void)state;
    gonio_readings *r = NULL;
    assert_int_equal(read_of("\"brdf\"", NAMES "counts\n30,0,40,180,5000\n", &r),
                     GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(support_message(), "counts_of_1_per_sr"));
    assert_null(r);
}

/* Dark counts are the same at all directions, and drift is that of a reference of counts. */
static void test_counts_and_blanks(void **state)
{
    (void)state;
    gonio_readings *r = NULL;
    gonio_readings *dark = NULL;
    assert_int_equal(read_of(COUNTS, NAMES "value\n30,0,0,0,5100\n30,0,60,180,5100\n", &r),
                     GONIO_OK);
    assert_int_equal(read_of(COUNTS, NAMES "value\n0,0,20,0,100\n0,0,40,0,100\n", &dark), GONIO_OK);
    assert_int_equal(gonio_readings_subtract_blank(NULL, r, dark, 0.01, 0.0), GONIO_OK);
    const double *value = gonio_readings_describe(r)->value;
    assert_near(value[0], 0.1);
    assert_near(value[1], 0.2);
    gonio_readings *copy = NULL;
    assert_int_equal(gonio_readings_copy(NULL, r, &copy), GONIO_OK);
    gonio_readings_free(&r);
    assert_int_equal(gonio_readings_subtract_blank(NULL, copy, dark, 0.01, 0.0), GONIO_OK);
    assert_near(gonio_readings_describe(copy)->value[0], 0.098);
    gonio_readings_free(&copy);
    gonio_readings_free(&dark);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_levels),
        cmocka_unit_test(test_numbers_of_an_instrument),
        cmocka_unit_test(test_counts_need_an_instrument),
        cmocka_unit_test(test_counts_and_blanks),
        cmocka_unit_test(test_units),
        cmocka_unit_test(test_brighter_than_the_sample),
        cmocka_unit_test(test_other_channels),
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_bad_references),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
