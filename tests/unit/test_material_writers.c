/* Materials written in every format and read again: what the format can hold is kept. */
#include <gonio/material.h>
#include <gonio/measurement.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/hdf_write.h"

#include "../support.h"
#include "made_material.h"

static const double degree = M_PI / 180.0;

enum { MOST = 4 };

/* A smooth BRDF in any channels, not reciprocal if it is skewed, and with a preferred azimuth if it
 * is brushed. */
typedef struct smooth {
    size_t channels;
    double skew;
    double brush;
} smooth;

static double smooth_value(const smooth *s, gonio_pair pair, size_t channel)
{
    const double sum = cos(pair.incident.theta) + cos(pair.outgoing.theta);
    const double apart = cos(pair.incident.phi - pair.outgoing.phi);
    const double ground = s->brush * cos(2.0 * pair.incident.phi);
    const double skew = s->skew * (pair.incident.theta - pair.outgoing.theta);
    return (0.2 + 0.1 * (double)channel) * (1.0 + 0.2 * sum + skew + ground) -
           0.05 * apart * sin(pair.incident.theta) * sin(pair.outgoing.theta);
}

static gonio_status evaluate_smooth(void *self, gonio_context *context, const gonio_pair *pairs,
                                    size_t count, double *values)
{
    const smooth *s = self;
    (void)context;
    for (size_t k = 0; k < count; k++) {
        for (size_t c = 0; c < s->channels; c++) {
            values[k * s->channels + c] = smooth_value(s, pairs[k], c);
        }
    }
    return GONIO_OK;
}

static gonio_material *make_smooth(smooth values, const double *wavelength)
{
    gonio_material *material = NULL;
    smooth *self = malloc(sizeof *self);
    assert_non_null(self);
    *self = values;
    const gonio_material_source source = {.size = sizeof source,
                                          .evaluate = evaluate_smooth,
                                          .release = free,
                                          .self = self,
                                          .channels = values.channels,
                                          .wavelength = wavelength,
                                          .anisotropic = values.brush != 0.0};
    assert_int_equal(gonio_material_create(NULL, "smooth & <made>", "made", &source, &material),
                     GONIO_OK);
    return material;
}

static gonio_material *rewrite(gonio_material *material, const char *folder, const char *name,
                               const char *format)
{
    char path[4096];
    const gonio_write_options options = {
        .size = sizeof options, .format = format, .average_azimuths = true};
    gonio_material *again = NULL;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_int_equal(gonio_material_write(NULL, material, path, &options), GONIO_OK);
    assert_int_equal(gonio_material_open(NULL, path, &again), GONIO_OK);
    return again;
}

/* The largest difference in a channel, relative, over directions up to `steepest`. */
static double find_difference(const gonio_material *a, size_t channel, const gonio_material *b,
                              size_t other, double steepest)
{
    const size_t channels_a = gonio_material_describe(a)->channels;
    const size_t channels_b = gonio_material_describe(b)->channels;
    double worst = 0.0;
    for (int k = 0; k < 300; k++) {
        const gonio_pair pair = {{steepest * (k % 20) / 20.0, 1.0 + k},
                                 {steepest * (k / 20) / 15.0, 0.3 * k}};
        double x[MOST];
        double y[MOST];
        assert_true(channels_a <= MOST && channels_b <= MOST);
        assert_int_equal(gonio_material_evaluate(NULL, a, &pair, 1, x), GONIO_OK);
        assert_int_equal(gonio_material_evaluate(NULL, b, &pair, 1, y), GONIO_OK);
        worst = fmax(worst, fabs(x[channel] - y[other]) / x[channel]);
    }
    return worst;
}

static void test_table(void **state)
{
    (void)state;
    static const double wavelength[4] = {700.0, 450.0, 550.0, 1064.0};
    char *folder = support_folder();
    gonio_material *material = make_smooth((smooth){.channels = 4}, wavelength);
    gonio_material *again = rewrite(material, folder, "x.h5", NULL);
    const gonio_material_view *view = gonio_material_describe(again);
    assert_int_equal(view->channels, 4);
    for (size_t c = 0; c < 4; c++) {
        assert_true(view->wavelength[c] == wavelength[c]);
        for (int k = 0; k < 500; k++) { /* exact at the centres of bins */
            const gonio_bin bin = gonio_bin_from_index(2903 * k);
            const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
            double a[4];
            double b[4];
            assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, a), GONIO_OK);
            assert_int_equal(gonio_material_evaluate(NULL, again, &pair, 1, b), GONIO_OK);
            assert_true(gonio_bin_is_valid(bin) ? fabs(a[c] - b[c]) < 1e-6 * a[c] : isnan(b[c]));
        }
    }
    gonio_material_free(&again);
    gonio_material_free(&material);
    support_remove(folder);
}

/* Of a single channel and of colours; a table is reciprocal. */
static void test_table_of_colours(void **state)
{
    (void)state;
    char *folder = support_folder();
    for (size_t channels = 1; channels <= 3; channels += 2) {
        gonio_material *material = make_smooth((smooth){.channels = channels, .skew = 0.1}, NULL);
        gonio_material *again = rewrite(material, folder, "x.h5", NULL);
        assert_int_equal(gonio_material_describe(again)->channels, channels);
        assert_null(gonio_material_describe(again)->wavelength);
        gonio_material *even = make_smooth((smooth){.channels = channels}, NULL);
        assert_true(find_difference(even, channels - 1, again, channels - 1, 1.3) < 2e-3);
        gonio_material_free(&even);
        gonio_material_free(&again);
        gonio_material_free(&material);
    }
    support_remove(folder);
}

/* A table of many channels of which nothing is stored is refused before room is made for it. */
static void test_a_table_that_lies(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.h5", folder);
    const hsize_t extents[4] = {4000, 90, 90, 180};
    const hsize_t chunk[4] = {1, 1, 90, 180};
    gonio_i_hdf_session session;
    assert_int_equal(gonio_i_hdf_load(NULL), GONIO_OK);
    gonio_i_hdf_enter(&session);
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(gonio_i_hdf_write_string(file, "format", "gonio BRDF table"));
    assert_true(gonio_i_hdf_write_number(file, "version", 1));
    const hid_t space = H5Screate_simple(4, extents, NULL);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(properties, 4, chunk);
    const hid_t rho =
        H5Dcreate2(file, "rho", H5T_IEEE_F32LE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    assert_true(rho >= 0);
    H5Dclose(rho);
    H5Pclose(properties);
    H5Sclose(space);
    H5Fclose(file);
    gonio_i_hdf_leave(&session);
    gonio_context *context = support_context();
    gonio_material *material = NULL;
    assert_int_equal(gonio_material_open(context, path, &material), GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "not in the file"));
    gonio_context_free(&context);
    support_remove(folder);
}

/* Wavelengths ascend in the file, whatever their order in the material. */
static void test_rgl_spectra(void **state)
{
    (void)state;
    static const double wavelength[3] = {650.0, 450.0, 550.0};
    static const size_t sorted[3] = {1, 2, 0};
    char *folder = support_folder();
    gonio_material *material = make_smooth((smooth){.channels = 3, .skew = 0.05}, wavelength);
    gonio_material *again = rewrite(material, folder, "x.bsdf", NULL);
    const gonio_material_view *view = gonio_material_describe(again);
    for (size_t c = 0; c < 3; c++) {
        assert_true(view->wavelength[c] == wavelength[sorted[c]]);
        assert_true(find_difference(material, sorted[c], again, c, 1.2) < 5e-3);
    }
    gonio_material_free(&again);
    gonio_material_free(&material);
    support_remove(folder);
}

static bool is_steep(gonio_bin bin)
{
    const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
    return fmax(pair.incident.theta, pair.outgoing.theta) > 60.0 * degree;
}

/* Of a table that ends at 60 degrees, its own values are kept up to there, and the steepest go on:
 * nothing is black. */
static void test_a_table_that_ends(void **state)
{
    (void)state;
    char *folder = support_folder();
    gonio_material *material = made_material((made_constant){{0.1, 0.2, 0.3}, is_steep});
    gonio_material *again = rewrite(material, folder, "x.bsdf", NULL);
    for (int k = 0; k < 79; k++) {
        const gonio_pair pair = {{k * degree, 0.0}, {(78 - k) * degree, 2.0}};
        double values[3];
        assert_int_equal(gonio_material_evaluate(NULL, again, &pair, 1, values), GONIO_OK);
        assert_true(fabs(values[1] - 0.2) < 0.005);
    }
    gonio_material_free(&again);
    gonio_material_free(&material);
    support_remove(folder);
}

/* An anisotropic material becomes its mean over azimuths if that is asked for. */
static void test_an_anisotropic_material(void **state)
{
    (void)state;
    char *folder = support_folder();
    gonio_material *material = make_smooth((smooth){.channels = 3, .brush = 0.3}, NULL);
    gonio_material *mean = make_smooth((smooth){.channels = 3}, NULL);
    gonio_material *again = rewrite(material, folder, "x.bsdf", "rgl");
    assert_false(gonio_material_describe(again)->anisotropic);
    assert_true(find_difference(mean, 2, again, 2, 1.2) < 5e-3);
    gonio_material_free(&again);
    again = rewrite(material, folder, "x.h5", NULL);
    assert_true(find_difference(mean, 2, again, 2, 1.2) < 2e-3);
    gonio_material_free(&again);
    gonio_material_free(&mean);
    gonio_material_free(&material);
    support_remove(folder);
}

/* Patches hold means: of a smooth material about its value in the middle. */
static void test_klems(void **state)
{
    (void)state;
    char *folder = support_folder();
    for (size_t channels = 1; channels <= 3; channels += 2) {
        gonio_material *material =
            make_smooth((smooth){.channels = channels, .skew = 0.1, .brush = 0.2}, NULL);
        gonio_material *again = rewrite(material, folder, "x.xml", NULL);
        assert_int_equal(gonio_material_describe(again)->channels, channels);
        const gonio_pair middle = {{10.0 * degree, 225.0 * degree}, {50.0 * degree, 30.0 * degree}};
        double a[3];
        double b[3];
        assert_int_equal(gonio_material_evaluate(NULL, material, &middle, 1, a), GONIO_OK);
        assert_int_equal(gonio_material_evaluate(NULL, again, &middle, 1, b), GONIO_OK);
        for (size_t c = 0; c < channels; c++) {
            assert_true(fabs(a[c] - b[c]) < 0.02 * a[c]);
        }
        gonio_material *twice = rewrite(again, folder, "y.xml", NULL);
        assert_true(find_difference(again, channels - 1, twice, channels - 1, 1.4) < 1e-5);
        gonio_material_free(&twice);
        gonio_material_free(&again);
        gonio_material_free(&material);
    }
    support_remove(folder);
}

/* Readings on a grid: each holds the material's value, and poles come once. */
static void test_csv(void **state)
{
    (void)state;
    static const double wavelength[3] = {450.0, 550.5, 650.0};
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.csv", folder);
    const gonio_write_options options = {.size = sizeof options,
                                         .theta_i_step = 40.0 * degree,
                                         .theta_o_step = 30.0 * degree,
                                         .phi_step = 90.0 * degree};
    gonio_material *material = make_smooth((smooth){.channels = 3, .skew = 0.1}, wavelength);
    assert_int_equal(gonio_material_write(NULL, material, path, &options), GONIO_OK);
    gonio_readings *readings = NULL;
    gonio_readings_options how;
    gonio_readings_options_default(&how);
    assert_int_equal(gonio_readings_read(NULL, path, &how, &readings), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, 3 * (1 + 2 * 4));
    assert_int_equal(view->channels, 3);
    for (size_t k = 0; k < view->count; k++) {
        double values[3];
        assert_int_equal(gonio_material_evaluate(NULL, material, &view->pair[k], 1, values),
                         GONIO_OK);
        for (size_t c = 0; c < 3; c++) {
            assert_true(view->wavelength[c] == wavelength[c]);
            assert_true(fabs(view->value[k * 3 + c] - values[c]) < 1e-8 * values[c]);
        }
    }
    gonio_readings_free(&readings);
    gonio_material_free(&material);
    support_remove(folder);
}

/* ---- Zemax ---- */

/* The numbers after a keyword and their count. */
static const char *find_numbers(const char *text, const char *keyword, size_t *count)
{
    const char *at = strstr(text, keyword);
    assert_non_null(at);
    char *end = NULL;
    *count = strtoul(at + strlen(keyword), &end, 10);
    return end;
}

static double number_at(const char *numbers, size_t index)
{
    char *end = NULL;
    double number = 0.0;
    for (size_t k = 0; k <= index; k++) {
        number = strtod(numbers, &end);
        assert_true(end != numbers);
        numbers = end;
    }
    return number;
}

static char *read_text(const char *path)
{
    FILE *stream = fopen(path, "r");
    char *text = calloc(1, 8 << 20);
    assert_non_null(stream);
    assert_non_null(text);
    assert_true(fread(text, 1, (8 << 20) - 1, stream) > 0);
    fclose(stream);
    return text;
}

/* A row of an incidence and an azimuth, in the first block of data. */
static const char *find_row(const char *text, size_t incidence, size_t azimuth)
{
    const char *at = strstr(text, "DataBegin");
    for (size_t k = 0; k <= incidence; k++) {
        at = strstr(at + 1, "TIS");
        assert_non_null(at);
    }
    for (size_t k = 0; k <= azimuth; k++) {
        at = strchr(at, '\n') + 1;
    }
    return at;
}

/* By vectors, apart from the writer: the mirror direction turned by the radial angle towards the
 * normal (azimuth 0) or away from it. */
static void test_zemax(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.bsdf", folder);
    const gonio_write_options options = {.size = sizeof options,
                                         .format = "zemax",
                                         .theta_i_step = 20.0 * degree,
                                         .phi_step = 90.0 * degree};
    gonio_material *material = make_smooth((smooth){.channels = 1}, NULL);
    assert_int_equal(gonio_material_write(NULL, material, path, &options), GONIO_OK);
    char *text = read_text(path);
    size_t incidences = 0;
    size_t azimuths = 0;
    size_t radials = 0;
    const char *incidence = find_numbers(text, "AngleOfIncidence", &incidences);
    find_numbers(text, "ScatterAzimuth", &azimuths);
    const char *radial = find_numbers(text, "ScatterRadial", &radials);
    assert_int_equal(incidences, 5);
    assert_int_equal(azimuths, 3);
    assert_non_null(strstr(text, "PlaneSymmetrical"));
    assert_non_null(strstr(text, "SpectralContent Monochrome"));
    assert_true(number_at(incidence, 2) == 40.0);
    for (size_t r = 0; r < radials; r += 5) {
        const double angle = number_at(radial, r);
        for (size_t a = 0; a < 3; a += 2) { /* in the plane of incidence */
            const double theta_o = a == 0 ? 40.0 - angle : 40.0 + angle; /* mirror side above 0 */
            const double written = number_at(find_row(text, 2, a), r);
            const gonio_pair pair = {{40.0 * degree, 0.0},
                                     {fabs(theta_o) * degree, theta_o >= 0.0 ? M_PI : 0.0}};
            const smooth s = {.channels = 1};
            const double expected = fabs(theta_o) < 90.0 ? smooth_value(&s, pair, 0) : 0.0;
            assert_true(fabs(written - expected) < 1e-6);
        }
    }
    /* The scatter of an incidence along the normal: 2 pi integral of f cos sin. */
    const double tis = number_at(strstr(text, "TIS") + 3, 0);
    const double exact = 2.0 * M_PI * 0.2 * ((1.0 + 0.2) / 2.0 + 0.2 / 3.0);
    assert_true(fabs(tis - exact) < 0.02 * exact);
    free(text);
    gonio_material_free(&material);

    material = make_smooth((smooth){.channels = 3}, NULL);
    assert_int_equal(gonio_material_write(NULL, material, path, &options), GONIO_OK);
    text = read_text(path);
    assert_non_null(strstr(text, "SpectralContent XYZ"));
    assert_non_null(strstr(text, "TristimulusX\nDataBegin"));
    assert_non_null(strstr(text, "TristimulusZ\nDataBegin"));
    free(text);
    gonio_material_free(&material);
    support_remove(folder);
}

static void test_names(void **state)
{
    (void)state;
    assert_int_equal(gonio_material_writer_find("a.bsdf", NULL),
                     gonio_material_writer_find("", "rgl"));
    assert_int_equal(gonio_material_writer_find("a.d/b", NULL),
                     gonio_material_writer_find("", "merl"));
    assert_int_equal(gonio_material_writer_find("a.bsdf", "nothing"), -1);
    assert_string_equal(gonio_material_writer_extension(0), ".binary");
    assert_null(gonio_material_writer_extension(-1));
    assert_null(gonio_material_writer_name(1000));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_table_of_colours),
        cmocka_unit_test(test_a_table_that_lies),
        cmocka_unit_test(test_rgl_spectra),
        cmocka_unit_test(test_a_table_that_ends),
        cmocka_unit_test(test_an_anisotropic_material),
        cmocka_unit_test(test_klems),
        cmocka_unit_test(test_csv),
        cmocka_unit_test(test_zemax),
        cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests_name("material_writers", tests, NULL, NULL);
}
