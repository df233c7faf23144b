/* Readings of BRDF JSON, OpenMATERIAL and CUReT files: values worked out by hand, and files that
 * are not what they should be. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "made_readings.h"

static void assert_near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fmax(1.0, fabs(expected)))) {
        fail_msg("%.17g where %.17g is expected", value, expected);
    }
}

static gonio_readings *read_good(const char *text, const char *taken_as)
{
    char *folder = support_folder();
    gonio_readings *readings = NULL;
    assert_int_equal(made_readings(NULL, folder, "r.brdf", text, NULL, &readings), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->notes, 1);
    assert_non_null(strstr(view->note[0], taken_as));
    support_remove(folder);
    return readings;
}

/* ---- BRDF JSON ---- */

#define ANGLES(theta_r)                                                                            \
    "\"theta_i\":{\"unit\":\"deg\",\"values\":[30,30,30,30]},"                                     \
    "\"phi_i\":{\"unit\":\"\u00B0\",\"values\":0},"                                                \
    "\"theta_r\":{\"unit\":\"rad\",\"value\":[" theta_r "]},"                                      \
    "\"phi_r\":{\"unit\":\"deg\",\"values\":[180,180,180,180]}"

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

/* ---- OpenMATERIAL ---- */

static void test_open_material(void **state)
{
    (void)state;
    gonio_readings *readings = read_good(
        "{\"$schema\":\"material_brdf_schema.json\",\"brdf\":{\"lookupTable\":["
        "[5.5e-07,0.5,0.25,3.141592653589793,0.3],[6.5e-07,0.5,0.25,3.141592653589793,0.4],"
        "[5.50000000001e-07,0.5,1.6,0,0.5]]}}",
        "an OpenMATERIAL lookup table: angles in radians, values in 1/sr, wavelengths in metres; 1 "
        "reading; left out: 1 at or below the horizon");
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_near(view->wavelength[1], 650.0);
    assert_true(fabs(view->pair[0].outgoing.theta - 0.25) < 1e-8);
    assert_true(fabs(view->pair[0].outgoing.phi - M_PI) < 1e-8);
    assert_near(gonio_readings_value(readings, 0, 1), 0.4);
    gonio_readings_free(&readings);
}

/* ---- CUReT ---- */

enum { PAIRS = 205 };

static void write_text(const char *folder, const char *name, const char *text)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static char *make_table(size_t rows)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    for (size_t k = 0; k < rows; k++) {
        fprintf(stream, "%zu %.6f 3.0 0.5 0.0\n", k + 1, 0.005 * (double)k);
    }
    fclose(stream);
    return text;
}

static char *make_samples(void)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    for (int sample = 3; sample <= 7; sample += 4) {
        fprintf(stream, "%d ", sample);
        for (int k = 0; k < PAIRS; k++) {
            fprintf(stream, " %.3f", k == 9 ? -0.002 : 0.1 * sample);
        }
        fprintf(stream, "\n");
    }
    fclose(stream);
    return text;
}

static gonio_status read_sample(const char *table, int sample, gonio_readings **readings)
{
    char *folder = support_folder();
    char *samples = make_samples();
    gonio_context *context = support_context();
    gonio_readings_options options;
    gonio_readings_options_default(&options);
    options.as.sample = sample;
    if (table != NULL) {
        write_text(folder, "table.txt", table);
    }
    const gonio_status status =
        made_readings(context, folder, "abrdf.dat", samples, &options, readings);
    gonio_context_free(&context);
    free(samples);
    support_remove(folder);
    return status;
}

static void test_curet(void **state)
{
    (void)state;
    char *table = make_table(PAIRS);
    gonio_readings *readings = NULL;
    assert_int_equal(read_sample(table, 0, &readings), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, PAIRS);
    assert_int_equal(view->notes, 2);
    assert_non_null(strstr(view->note[0], "2 samples, of which the first is read; --as sample=N "
                                          "reads another: 3, 7"));
    assert_non_null(strstr(view->note[1], "1 value below zero taken as 0"));
    assert_near(gonio_readings_value(readings, 0, 0), 0.3);
    assert_near(gonio_readings_value(readings, 9, 0), 0.0);
    assert_true(fabs(view->pair[10].outgoing.theta - 0.05) < 1e-8); /* the first angles: the view */
    assert_true(fabs(view->pair[10].outgoing.phi - 3.0) < 1e-8);
    assert_true(fabs(view->pair[10].incident.theta - 0.5) < 1e-8);
    gonio_readings_free(&readings);

    assert_int_equal(read_sample(table, 7, &readings), GONIO_OK);
    assert_near(gonio_readings_value(readings, 0, 0), 0.7);
    assert_int_equal(gonio_readings_describe(readings)->notes, 1);
    gonio_readings_free(&readings);

    assert_int_equal(read_sample(table, 4, &readings), GONIO_ERROR_DATA);
    assert_non_null(strstr(support_message(), "no sample 4; there are 3, 7"));
    assert_int_equal(read_sample(NULL, 7, &readings), GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), "are expected in table.txt beside it"));
    free(table);
    table = make_table(PAIRS - 1);
    assert_int_equal(read_sample(table, 7, &readings), GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "table.txt:205: the number 205"));
    free(table);
}

/* ---- RGL ---- */

/* The samples are where the material's own parameterisation has its nodes: there nothing is
 * interpolated. The file is a material all the same. */
static void test_rgl_samples(void **state)
{
    (void)state;
    char path[256];
    char *folder = support_folder();
    gonio_material *material = NULL;
    gonio_readings *samples = NULL;
    gonio_readings *known = NULL;
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    snprintf(path, sizeof path, "%s/x.bsdf", folder);
    assert_int_equal(gonio_material_open(NULL, "atlas:red-cotton", &material), GONIO_OK);
    assert_int_equal(gonio_material_write(NULL, material, path, NULL), GONIO_OK);
    gonio_material_free(&material);
    assert_int_equal(gonio_file_kind(NULL, path, &kind, NULL), GONIO_OK);
    assert_int_equal(kind, GONIO_KIND_MATERIAL);
    assert_int_equal(gonio_file_expect(NULL, path, GONIO_KIND_READINGS, &kind), GONIO_OK);
    assert_int_equal(kind, GONIO_KIND_READINGS);

    assert_int_equal(gonio_material_open(NULL, path, &material), GONIO_OK);
    assert_int_equal(gonio_readings_read(NULL, path, NULL, &samples), GONIO_OK);
    assert_int_equal(gonio_readings_read(NULL, path, NULL, &known), GONIO_OK);
    assert_int_equal(gonio_measure_material(NULL, known, material, NULL), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(samples);
    double error = 0.0;
    double all = 0.0;
    assert_true(view->count > 50000);
    for (size_t k = 0; k < view->count; k++) {
        assert_true(view->pair[k].incident.theta <= 80.0001 * M_PI / 180.0);
        assert_true(view->pair[k].outgoing.theta <= 80.0001 * M_PI / 180.0);
        for (size_t c = 0; c < 3; c++) {
            const double is = gonio_readings_value(samples, k, c);
            const double was = gonio_readings_value(known, k, c);
            const double off = log1p(1500.0 * is) - log1p(1500.0 * was);
            error += isnan(off) ? 0.0 : off * off;
            all += isnan(off) ? 0.0 : pow(log1p(1500.0 * was), 2.0);
        }
    }
    assert_true(sqrt(error / all) < 1e-3); /* half vectors along the normal have several samples */
    gonio_readings_free(&samples);
    gonio_readings_free(&known);
    gonio_material_free(&material);
    support_remove(folder);
}

/* ---- bad files ---- */

static void test_bad_files(void **state)
{
    (void)state;
    static const made_bad_file cases[] = {
        {"{\"BRDF\":", GONIO_ERROR_FORMAT, ":1: JSON: "},
        {"{\"BRDF\":{}}", GONIO_ERROR_FORMAT, "no data.theta_i with values"},
        {"{\"data\":{" ANGLES("1,1,1,1") "},\"BRDF\":[1]}", GONIO_ERROR_FORMAT,
         "no data.BRDF with values"},
        {"{\"data\":{" ANGLES("1,1,1,1") ",\"BRDF\":[1,2]}}", GONIO_ERROR_FORMAT,
         "2 values of the BRDF, but 4 of theta_i"},
        {"{\"data\":{" ANGLES("1,1,1") ",\"BRDF\":[1,2,3,4]}}", GONIO_ERROR_FORMAT,
         "4 values of the BRDF, but 3 of theta_r"},
        {"{\"data\":{" ANGLES("1,1,\"x\",1") ",\"BRDF\":[1,2,3,4]}}", GONIO_ERROR_FORMAT,
         "entry 3: an angle is not a number"},
        {"{\"data\":{" ANGLES("1,1,1,1") ",\"wavelength_i\":{\"unit\":\"inch\",\"values\":1},"
                                         "\"BRDF\":[1,2,3,4]}}",
         GONIO_ERROR_FORMAT, "the unit 'inch' of wavelengths"},
        {"{\"data\":{\"theta_i\":{\"unit\":\"gon\",\"values\":1},\"BRDF\":[1]}}",
         GONIO_ERROR_FORMAT, "the unit 'gon' is neither"},
        {"{\"data\":{" ANGLES("1,1,1,1") ",\"BRDF\":[\"a\",\"b\",null,{}]}}", GONIO_ERROR_DATA,
         "none of the 1 rows"},
        {"{\"data\":{" ANGLES(
             "1,1,1,1") ",\"adhoc_variables\":{\"channel\":{\"values\":[\"R\",\"X\",1,"
                        "2]}},\"BRDF\":[1,2,3,4]}}",
         GONIO_ERROR_FORMAT, "entry 2: a channel is R, G, B"},
        {"{\"data\":{" ANGLES(
             "1,1,1,1") ",\"wavelength_i\":[500,null,500,500],\"BRDF\":[1,2,3,4]}}",
         GONIO_ERROR_FORMAT, "entry 2: the wavelength is not a number"},
        {"{\"data\":{" ANGLES("1,1,1,1") ",\"BRDF\":{\"unit\":\"%\",\"values\":[1,2,3,4]}}}",
         GONIO_ERROR_FORMAT, "the unit '%' is not 1/sr; say what the values are with --as values="},
        {"{\"data\":{" ANGLES("1,1,1,1") ",\"uBRDF\":{\"unit\":\"dB\",\"values\":1},"
                                         "\"BRDF\":[1,2,3,4]}}",
         GONIO_ERROR_FORMAT, "the unit 'dB' of uncertainties is neither 1/sr nor %"},
        {"{\"brdf\":{\"lookupTable\":[[0.1,0.2,3,0,5e-7,1,null]]}}", GONIO_ERROR_FORMAT,
         "row 1 of lookupTable has 7 elements; five numbers are expected"},
        {"{\"lookupTable\":1}", GONIO_ERROR_FORMAT, "no brdf.lookupTable"},
        {"{\"brdf\":{\"lookupTable\":[[1,2,3,4]]}}", GONIO_ERROR_FORMAT,
         "row 1 of lookupTable has 4 elements"},
        {"{\"brdf\":{\"lookupTable\":[]}}", GONIO_ERROR_DATA, "no readings in it"},
    };
    assert_bad_files("bad.json", cases, sizeof cases / sizeof *cases);
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
        cmocka_unit_test(test_conventions_of_json),
        cmocka_unit_test(test_json_round_trips),
        cmocka_unit_test(test_json_keeps_to_the_schema),
        cmocka_unit_test(test_open_material),
        cmocka_unit_test(test_curet),
        cmocka_unit_test(test_rgl_samples),
        cmocka_unit_test(test_bad_files),
        cmocka_unit_test(test_sparse_tables),
        cmocka_unit_test(test_deep_json),
    };
    return cmocka_run_group_tests_name("formats of databases and institutes", tests, NULL, NULL);
}
