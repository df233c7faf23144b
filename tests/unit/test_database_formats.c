/* Readings of OpenMATERIAL, CUReT and RGL files: values worked out by hand, and files of databases
 * that are refused. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "database_readings.h"
#include "made_readings.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_open_material),
        cmocka_unit_test(test_curet),
        cmocka_unit_test(test_rgl_samples),
        cmocka_unit_test(test_bad_files),
    };
    return cmocka_run_group_tests_name("formats of databases and institutes", tests, NULL, NULL);
}
