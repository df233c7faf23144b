/* Readings as BRDF JSON: values worked out by hand, round trips, the published schema. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "database_readings.h"
#include "made_readings.h"

/* Lit by s and by p: the mean; two wavelengths in micrometres; expanded uncertainties, k = 2. */
static void test_polarisations_wavelengths_and_uncertainties(void **state)
{
    (void)state;
    gonio_readings *readings = read_good(
        "{\"metadata\":{\"type\":\"BRDF\"},\"data\":{" ANGLES(
            "0.5,0.5,0.5,0.5") ",\"wavelength_i\":{\"unit\":\"um\",\"values\":[0.65,0.65,0.55,0.55]"
                               "},"
                               "\"polarization_i\":{\"values\":[\"s\",\"p\",\"s\",\"p\"]},"
                               "\"BRDF\":{\"unit\":\"sr^-1\",\"values\":[0.2,0.4,0.1,null],"
                               "\"uncertainty\":{\"coverage_factor\":2,\"values\":[0.06,0.08,0.02,"
                               "0.02]}}}}",
        "BRDF JSON: angles in degrees, values in 1/sr, wavelengths in micrometres; 1 reading");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->channels, 2);
    assert_near(view->wavelength[0], 550.0);
    assert_near(gonio_readings_value(readings, 0, 0), 0.1);
    assert_near(gonio_readings_value(readings, 0, 1), 0.3);
    assert_near(view->deviation[0], 0.01);
    assert_near(view->deviation[1], 0.025); /* hypot(0.03, 0.04) / 2 */
    assert_true(fabs(view->pair[0].outgoing.theta - 0.5) < 1e-8);
    assert_near(view->pair[0].outgoing.phi, M_PI);
    gonio_readings_free(&readings);
}

/* Detected as s and as p: the sum. */
static void test_analysed_light_adds_up(void **state)
{
    (void)state;
    gonio_readings *readings = read_good(
        "{\"data\":{" ANGLES(
            "0.5,0.5,0.6,0.6") ",\"polarization_r\":{\"values\":[\"s\",\"p\",\"s\",\"p\"]},"
                               "\"BRDF\":{\"values\":[0.2,0.4,0.1,0.3]}}}",
        "BRDF JSON");
    assert_int_equal(gonio_readings_describe(readings)->count, 2);
    assert_near(gonio_readings_value(readings, 0, 0), 0.6);
    assert_near(gonio_readings_value(readings, 1, 0), 0.4);
    gonio_readings_free(&readings);
}

/* The same of light whose states are Stokes vectors. */
static void test_stokes_vectors(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_good("{\"data\":{" ANGLES(
                      "0.5,0.5,0.5,0.5") ",\"polarization_i\":{\"values\":[[1,1,0,0],[1,1,0,0],[1,"
                                         "-1,0,0],[1,-1,0,0]]},\"polarization_r\":{\"values\":[[1,"
                                         "1,0,0],[1,-1,0,0],[1,1,0,0],[1,-1,0,0]]},"
                                         "\"BRDF\":{\"values\":[0.2,0.1,0.3,0.4]}}}",
                  "BRDF JSON");
    assert_int_equal(gonio_readings_describe(readings)->count, 1);
    assert_near(gonio_readings_value(readings, 0, 0), 0.5); /* (0.2 + 0.1 + 0.3 + 0.4) / 2 */
    gonio_readings_free(&readings);
}

static gonio_readings *read_text(const char *text, const gonio_readings_options *options)
{
    char *folder = support_folder();
    gonio_readings *readings = NULL;
    assert_int_equal(made_readings(NULL, folder, "r.json", text, options, &readings), GONIO_OK);
    support_remove(folder);
    return readings;
}

/* One state alone is said to be no unpolarised light. */
static void test_a_single_polarisation(void **state)
{
    (void)state;
    gonio_readings *readings = read_text(
        "{\"data\":{" ANGLES("0.5,0.6,0.7,0.8") ",\"polarization_i\":{\"values\":[\"p\",\"p\","
                                                "\"p\",\"p\"]},\"BRDF\":[1,2,3,4]}}",
        NULL);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->notes, 2);
    assert_string_equal(view->note[0],
                        "the light on the sample is polarised, p only; it is taken as unpolarised");
    gonio_readings_free(&readings);
}

/* Per cent of each value, k in words: 10 % of 0.2 are 0.01 of a standard deviation for k = 2. */
static void test_relative_uncertainties(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_text("{\"data\":{" ANGLES(
                      "0.5,0.6,0.7,0.8") ",\"uBRDF\":{\"unit\":\"%\",\"values\":[10,10,20,null],"
                                         "\"comments\":\"thank you; expanded, k = 2\"},"
                                         "\"BRDF\":{\"unit\":\"1/sr\",\"values\":[0.2,0.4,0.6,0.8],"
                                         "\"uncertainty\":{\"unit\":\"1/sr\",\"value\":7}}}}",
                  NULL);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_near(view->deviation[0], 0.01);
    assert_near(view->deviation[1], 0.02);
    assert_near(view->deviation[2], 0.06);
    assert_true(isnan(view->deviation[3]));
    gonio_readings_free(&readings);

    readings = read_text(
        "{\"data\":{" ANGLES("0.5,0.6,0.7,0.8") ",\"BRDF\":{\"values\":[0.2,0.4,0.6,0.8],"
                                                "\"uncertainty\":{\"unit\":\"%\",\"value\":3}}}}",
        NULL);
    assert_near(gonio_readings_describe(readings)->deviation[3], 0.024);
    gonio_readings_free(&readings);
}

/* Equal directions, wavelengths and states are repeats, each a reading of its own. */
static void test_repeats_stay(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_text("{\"data\":{" ANGLES("0.5,0.5,0.5,0.5") ",\"wavelength_i\":[500,600,500,600],"
                                                          "\"BRDF\":[0.1,0.2,0.3,0.4]}}",
                  NULL);
    assert_int_equal(gonio_readings_describe(readings)->count, 2);
    assert_near(gonio_readings_value(readings, 0, 1), 0.2);
    assert_near(gonio_readings_value(readings, 1, 0), 0.3);
    gonio_readings_free(&readings);

    readings =
        read_text("{\"data\":{" ANGLES("0.5,0.5,0.5,0.5") ",\"wavelength_i\":[500,600,500,600],"
                                                          "\"BRDF\":[null,0.2,0.3,null]}}",
                  NULL);
    assert_int_equal(gonio_readings_describe(readings)->count, 1);
    assert_near(gonio_readings_value(readings, 0, 0), 0.3);
    assert_near(gonio_readings_value(readings, 0, 1), 0.2);
    gonio_readings_free(&readings);
}

/* Channels without wavelengths: an ad-hoc variable or a column, colours or numbers in any words. */
static void test_channels_of_other_programs(void **state)
{
    (void)state;
    static const struct {
        const char *column;
        size_t channels;
        size_t last; /* the channel of the last value */
    } cases[] = {
        {"\"adhoc_variables\":{\"channel\":{\"values\":[\"R\",\"G\",\"B\",\"G\"]}}", 3, 1},
        {"\"channel\":{\"values\":[\"red\",\"green\",\"blue\",\"Green\"]}", 3, 1},
        {"\"channel\":[\"1\",\"2\",\"1\",\"2\"]", 2, 1},
        {"\"channel\":[1.0,2.0,3.0,2.0]", 3, 1},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[1024];
        snprintf(text, sizeof text, "{\"data\":{%s,%s,\"BRDF\":[0.1,0.2,0.3,0.4]}}",
                 ANGLES("0.5,0.5,0.5,0.5"), cases[k].column);
        gonio_readings *readings = read_text(text, NULL);
        const gonio_readings_view *view = gonio_readings_describe(readings);
        assert_int_equal(view->channels, cases[k].channels);
        assert_int_equal(view->count, 2);
        assert_near(gonio_readings_value(readings, 0, 0), 0.1);
        assert_near(gonio_readings_value(readings, 1, cases[k].last), 0.4);
        gonio_readings_free(&readings);
    }
    gonio_context *context = support_context();
    gonio_readings *readings = NULL;
    char *folder = support_folder();
    assert_int_equal(made_readings(context, folder, "r.json",
                                   "{\"data\":{" ANGLES("0.5,0.5,0.5,0.5") ",\"channel\":[1,2,1.5,2"
                                                                           "],\"BRDF\":[1,2,3,4]}}",
                                   NULL, &readings),
                     GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "entry 3: a channel is R, G, B or a number from 1"));
    support_remove(folder);
    gonio_context_free(&context);
}

/* What the user says comes before the units of the file. */
static void test_conventions_of_json(void **state)
{
    (void)state;
    gonio_readings_options options = {.size = sizeof options};
    options.as = (gonio_convention){.angles = GONIO_RADIANS, .values = GONIO_VALUE_FACTOR};
    gonio_readings *readings = read_text(
        "{\"data\":{\"theta_i\":{\"unit\":\"deg\",\"values\":[0.5]},\"phi_i\":[0],\"theta_r\":"
        "[0.25],\"phi_r\":[3],\"BRDF\":{\"unit\":\"1\",\"values\":[0.5]}}}",
        &options);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_true(fabs(view->pair[0].incident.theta - 0.5) < 1e-8);
    assert_true(fabs(view->pair[0].outgoing.phi - 3.0) < 1e-8);
    assert_near(gonio_readings_value(readings, 0, 0), 0.5 / M_PI);
    assert_non_null(strstr(view->note[0], "angles in radians"));
    gonio_readings_free(&readings);
}

static void test_angles_in_gon(void **state)
{
    (void)state;
    gonio_readings_options options = {.size = sizeof options};
    options.as.angles = GONIO_GRADIANS;
    gonio_readings *readings =
        read_text("{\"data\":{\"theta_i\":{\"unit\":\"gon\",\"values\":[50]},"
                  "\"phi_i\":[0],\"theta_r\":{\"unit\":\"deg\",\"values\":[40]"
                  "},\"phi_r\":[200],\"BRDF\":[0.3]}}",
                  &options);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_near(view->pair[0].incident.theta, M_PI / 4.0);
    assert_near(view->pair[0].outgoing.theta, M_PI / 5.0);
    assert_near(view->pair[0].outgoing.phi, M_PI);
    assert_non_null(strstr(view->note[0], "angles in gon"));
    gonio_readings_free(&readings);
}

/* Values of another sensor in each channel; NaN where nothing was read. */
static void round_trip(const double *wavelength, size_t channels, bool deviations)
{
    enum { COUNT = 3, MOST = 4 };
    static const gonio_pair pair[COUNT] = {
        {{0.1, 0.0}, {0.2, 3.0}}, {{0.3, 1.0}, {1.1, 2.0}}, {{1.0 / 3.0, 6.0}, {0.0, 0.0}}};
    double value[COUNT * MOST];
    double deviation[COUNT * MOST];
    for (size_t k = 0; k < COUNT * channels; k++) {
        const bool missing = k == 1 && channels > 1;
        value[k] = missing ? NAN : 1.0 / (3.0 + (double)k);
        deviation[k] = missing ? NAN : 1e-3 / (7.0 + (double)k);
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = COUNT,
                                          .channels = channels,
                                          .pair = pair,
                                          .wavelength = wavelength,
                                          .value = value,
                                          .deviation = deviations ? deviation : NULL};
    char path[256];
    char *folder = support_folder();
    gonio_readings *made = NULL;
    gonio_readings *back = NULL;
    snprintf(path, sizeof path, "%s/r.json", folder);
    assert_int_equal(gonio_readings_create(NULL, &arrays, NULL, &made), GONIO_OK);
    assert_int_equal(gonio_readings_write(NULL, made, "a \"command\"", path), GONIO_OK);
    assert_int_equal(gonio_readings_read(NULL, path, NULL, &back), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(back);
    assert_int_equal(view->count, COUNT);
    assert_int_equal(view->channels, channels);
    assert_int_equal(view->wavelength != NULL, wavelength != NULL);
    assert_int_equal(view->deviation != NULL, deviations);
    for (size_t k = 0; k < COUNT * channels; k++) {
        const double read = view->value[k];
        assert_true(read == value[k] || (isnan(read) && isnan(value[k])));
        assert_true(!deviations || view->deviation[k] == deviation[k] || isnan(deviation[k]));
        assert_true(fabs(view->pair[k / channels].incident.theta -
                         pair[k / channels].incident.theta) < 1e-12);
    }
    gonio_readings_free(&made);
    gonio_readings_free(&back);
    support_remove(folder);
}

static void test_json_round_trips(void **state)
{
    (void)state;
    static const double wavelength[4] = {400.0, 500.5, 633.0, 1064.0};
    round_trip(wavelength, 4, true);
    round_trip(NULL, 3, false);
    round_trip(NULL, 1, true);
    round_trip(NULL, 2, true);
}

static char *text_of(const char *path)
{
    char *text = calloc(1, 8192);
    FILE *file = fopen(path, "r");
    assert_true(text != NULL && file != NULL && fread(text, 1, 8191, file) > 0);
    fclose(file);
    return text;
}

/* What is written keeps to the names and ranges of the published schema: azimuths from 0 to below
 * 360, no null where a value is only missing among others, deviations beside the values. */
static void test_json_keeps_to_the_schema(void **state)
{
    (void)state;
    char path[256];
    char *folder = support_folder();
    gonio_readings *made = NULL;
    gonio_readings *back = NULL;
    assert_int_equal(made_readings(NULL, folder, "r.csv",
                                   "# grid: half/difference 90 x 90 x 180\n"
                                   "# basis: 00000000000000ff\n"
                                   "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R_per_sr,G_per_sr,"
                                   "B_per_sr,R_deviation_per_sr,G_deviation_per_sr,"
                                   "B_deviation_per_sr\n"
                                   "30,-90,40,360,0.1,,0.3,0.01,,0.03\n"
                                   "30,-90,50,270,0.4,0.5,0.6,0.04,0.05,0.06\n",
                                   NULL, &made),
                     GONIO_OK);
    snprintf(path, sizeof path, "%s/r.json", folder);
    assert_int_equal(gonio_readings_write(NULL, made, "a command", path), GONIO_OK);
    char *text = text_of(path);
    static const char *const parts[] = {
        "\"schema\": \"https://",
        "\"software\": {\"name\": \"gonio\", \"version\": ",
        "\"comments\": \"a command\"}",
        "\"comments\": \"grid: half/difference 90 x 90 x 180\\nbasis: 00000000000000ff\"\n",
        "\"phi_i\": {\"unit\": \"deg\", \"values\": [270, 270, 270, 270, 270]}",
        "\"phi_r\": {\"unit\": \"deg\", \"values\": [0, 0, 270, 270, 270]}",
        "\"unit\": \"\", \"type\": \"string\", \"values\": [\"R\", \"B\", \"R\", \"G\", \"B\"]",
        "\"polarization_i\": {\"notation\": \"sp\", \"values\": [\"u\", ",
        "k = 1\", \"unit\": \"sr^-1\", \"values\": [0.01, 0.03, 0.04, 0.05, 0.06]}",
        "\"BRDF\": {\"unit\": \"sr^-1\", \"values\": [0.1, 0.3, 0.4, 0.5, 0.6]}"};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        if (strstr(text, parts[k]) == NULL) {
            fail_msg("no '%s' in %s", parts[k], text);
        }
    }
    free(text);
    assert_int_equal(gonio_readings_read(NULL, path, NULL, &back), GONIO_OK);
    assert_int_equal(gonio_readings_describe(back)->count, 2);
    assert_true(gonio_readings_describe(back)->basis == 0xff);
    assert_true(isnan(gonio_readings_value(back, 0, 1)));
    gonio_readings_free(&back);
    gonio_readings_free(&made);
    support_remove(folder);
}

/* A file of 10,000 lines may not ask for the memory of 10,000 x 4,000 values. */
static void test_sparse_tables(void **state)
{
    (void)state;
    enum { ROWS = 10000 };
    char *folder = support_folder();
    char *text = NULL;
    size_t size = 0;
    gonio_readings *readings = NULL;
    gonio_context *context = support_context();
    FILE *stream = open_memstream(&text, &size);
    fprintf(stream, "{\"brdf\":{\"lookupTable\":[");
    for (int k = 0; k < ROWS; k++) {
        fprintf(stream, "%s[%de-10,%.4f,0.5,0,1]", k > 0 ? "," : "", 4000 + k % 4000, 1e-4 * k);
    }
    fprintf(stream, "]}}");
    fclose(stream);
    assert_int_equal(made_readings(context, folder, "sparse.xompt", text, NULL, &readings),
                     GONIO_ERROR_FORMAT);
    assert_non_null(
        strstr(support_message(), "10000 directions and 4000 wavelengths, but only 10000 values"));
    free(text);
    gonio_context_free(&context);
    support_remove(folder);
}

/* Brackets without end are refused before they fill the stack. */
static void test_deep_json(void **state)
{
    (void)state;
    enum { DEPTH = 200000 };
    char *folder = support_folder();
    char *text = malloc(DEPTH + 16);
    gonio_readings *readings = NULL;
    strcpy(text, "{\"BRDF\":");
    memset(text + 8, '[', DEPTH);
    text[8 + DEPTH] = '\0';
    assert_int_equal(made_readings(NULL, folder, "deep.json", text, NULL, &readings),
                     GONIO_ERROR_FORMAT);
    free(text);
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_polarisations_wavelengths_and_uncertainties),
        cmocka_unit_test(test_analysed_light_adds_up),
        cmocka_unit_test(test_stokes_vectors),
        cmocka_unit_test(test_a_single_polarisation),
        cmocka_unit_test(test_relative_uncertainties),
        cmocka_unit_test(test_repeats_stay),
        cmocka_unit_test(test_channels_of_other_programs),
        cmocka_unit_test(test_conventions_of_json),
        cmocka_unit_test(test_angles_in_gon),
        cmocka_unit_test(test_json_round_trips),
        cmocka_unit_test(test_json_keeps_to_the_schema),
        cmocka_unit_test(test_sparse_tables),
        cmocka_unit_test(test_deep_json),
    };
    return cmocka_run_group_tests_name("BRDF JSON", tests, NULL, NULL);
}
