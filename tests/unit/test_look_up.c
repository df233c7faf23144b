/* Readings taken out of others, errors between readings, spectra as colours. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "made_readings.h"
#include "material/colour.h"

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

/* 30 and 50 degrees apart, 40 of phi; a second one; one in the mirror direction. */
static const double known_rows[3][7] = {
    {30, 0, 50, 40, 0.1, 0.2, 0.3}, {20, 0, 70, 200, 0.4, 0.5, NAN}, {45, 0, 45, 180, 10, 20, 30}};

/* Which known reading a plan of one direction takes: its R; -1 if there is none. */
static double looked_up(const double row[4])
{
    gonio_context *context = support_context();
    gonio_readings *known = made_colours(known_rows, 3);
    gonio_readings *plan = made_directions((const double(*)[4])row, 1);
    const gonio_status status = gonio_readings_look_up(context, plan, known);
    const double value = status == GONIO_OK ? gonio_readings_value(plan, 0, 0) : -1.0;
    if (status != GONIO_OK) {
        assert_int_equal(status, GONIO_ERROR_DATA);
        assert_non_null(strstr(support_message(), "has no reading at these directions"));
    }
    bool same = false;
    assert_int_equal(gonio_readings_find(context, plan, known, &same), GONIO_OK);
    assert_int_equal(same, status == GONIO_OK);
    gonio_readings_free(&plan);
    gonio_readings_free(&known);
    gonio_context_free(&context);
    return value;
}

static void test_look_up(void **state)
{
    (void)state;
    static const struct {
        double row[4];
        double value;
    } cases[] = {
        {{30, 0, 50, 40}, 0.1},         {{30, 100, 50, 140}, 0.1}, /* turned: isotropic */
        {{50, 40, 30, 0}, 0.1},                                    /* reciprocal */
        {{30.003, 0, 50.003, 40}, 0.1},                            /* within 1e-4 radians */
        {{30.1, 0, 50, 40}, -1.0},      {{30, 0, 50, 41}, -1.0},   {{20, 0, 70, 200}, 0.4},
        {{70, 200, 20, 0}, 0.4},        {{45, 10, 45, 190}, 10.0}, {{0, 0, 45, 0}, -1.0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_close(looked_up(cases[k].row), cases[k].value, 0.0);
    }
}

/* What a file says at each of its own directions. */
static void assert_finds_itself(const double (*rows)[7], size_t count)
{
    gonio_readings *known = made_colours(rows, count);
    gonio_readings *plan = made_colours(rows, count);
    assert_int_equal(gonio_readings_look_up(NULL, plan, known), GONIO_OK);
    for (size_t k = 0; k < count; k++) {
        assert_close(gonio_readings_value(plan, k, 0), rows[k][4], 0.0);
    }
    gonio_readings_free(&plan);
    gonio_readings_free(&known);
}

/* A direction's own line comes before one that is turned or reciprocal, however near that is. */
static void test_own_lines_come_first(void **state)
{
    (void)state;
    static const double reciprocal[][7] = {{44.9999906, 0, 0, 0, 0.147, 1, 1},
                                           {0, 0, 44.9999906, 180.00002, 0.145, 1, 1},
                                           {30, 0, 20, 180, 0.2, 1, 1}};
    static const double turned[][7] = {{45, 0, 45, 180, 4.6, 1, 1},
                                       {45, 30, 45, 210, 5.1, 1, 1},
                                       {45, 180, 45, 0, 4.9, 1, 1},
                                       {45, 0, 45, 180.001, 4.8, 1, 1}};
    static const double pole[][7] = {
        {30, 0, 0, 0, 0.1, 1, 1}, {30, 0, 0, 10, 0.2, 1, 1}, {30, 0, 0, 20, 0.3, 1, 1}};
    static const double between[][7] = {{30, 0, 50, 40, 1, 1, 1}, {50, 40, 30, 0, 2, 1, 1}};
    assert_finds_itself(reciprocal, 3);
    assert_finds_itself(turned, 4);
    assert_finds_itself(between, 2);
    assert_finds_itself(pole, 3);
}

/* Rounded in the fifth decimal of a degree; phi_d is anything near the mirror direction. */
static void test_rounded_angles_are_found(void **state)
{
    (void)state;
    static const double rows[][7] = {{79.999977, 0, 79.0472055, 180.00002, 1.2, 1.1, 1},
                                     {45.000012, 0, 44.5, 180.00004, 0.9, 0.8, 0.7},
                                     {45.000012, 0, 20.00002, 180.00004, 0.2, 0.15, 0.1},
                                     {30, 10, 30.00001, 10.00001, 0.3, 1, 1},
                                     {0.00001, 250, 60, 3, 0.4, 1, 1}};
    static const double plan[][4] = {{79.99998, 0, 79.04721, 180},
                                     {45.00001, 0, 44.5, 180},
                                     {45.00001, 0, 20.00002, 180},
                                     {30.00001, 0, 30, 0},
                                     {0, 0, 60, 90}};
    gonio_readings *known = made_colours(rows, 5);
    gonio_readings *at = made_directions(plan, 5);
    assert_int_equal(gonio_readings_look_up(NULL, at, known), GONIO_OK);
    for (size_t k = 0; k < 5; k++) {
        assert_close(gonio_readings_value(at, k, 0), rows[k][4], 0.0);
    }
    gonio_readings_free(&at);
    gonio_readings_free(&known);
}

/* Repeats are averaged in each channel, where they were read. */
static void test_repeats_are_averaged(void **state)
{
    (void)state;
    static const double rows[][7] = {{45, 0, 30, 180, 0.151, 1, NAN},
                                     {5, 0, 5, 180, 0.251, 2, 3},
                                     {45, 0, 30, 180, 0.191, NAN, 4}};
    static const double deviations[9] = {3, 1, NAN, 1, 1, 1, 4, NAN, 5};
    gonio_readings *known = made_colours(rows, 3);
    gonio_readings *plan = made_colours(rows, 3);
    assert_int_equal(gonio_readings_set_deviations(NULL, known, deviations), GONIO_OK);
    assert_int_equal(gonio_readings_look_up(NULL, plan, known), GONIO_OK);
    for (size_t k = 0; k < 3; k += 2) {
        assert_close(gonio_readings_value(plan, k, 0), 0.171, 1e-15);
        assert_close(gonio_readings_value(plan, k, 1), 1.0, 0.0);
        assert_close(gonio_readings_value(plan, k, 2), 4.0, 0.0);
        assert_close(gonio_readings_describe(plan)->deviation[3 * k], 2.5, 1e-15);
        assert_close(gonio_readings_describe(plan)->deviation[3 * k + 2], 5.0, 0.0);
    }
    gonio_readings_free(&plan);
    gonio_readings_free(&known);
}

/* In place, and only where something was read; a copy does not follow. */
static void test_repeats_become_their_mean(void **state)
{
    (void)state;
    static const double rows[][7] = {
        {45, 0, 30, 180, 0.2, 1, NAN}, {5, 0, 5, 180, 0.251, 2, 3}, {45, 0, 30, 180, 0.4, NAN, 4}};
    static const double means[3][3] = {{0.3, 1, NAN}, {0.251, 2, 3}, {0.3, NAN, 4}};
    gonio_readings *readings = made_colours(rows, 3);
    gonio_readings *copy = NULL;
    assert_int_equal(gonio_readings_copy(NULL, readings, &copy), GONIO_OK);
    assert_int_equal(gonio_readings_average_repeats(NULL, readings), GONIO_OK);
    for (size_t k = 0; k < 9; k++) {
        const double value = gonio_readings_value(readings, k / 3, k % 3);
        const double mean = means[k / 3][k % 3];
        assert_true(isnan(mean) ? isnan(value) : fabs(value - mean) < 1e-15);
    }
    assert_close(gonio_readings_value(copy, 0, 0), 0.2, 0.0);
    assert_string_equal(gonio_readings_describe(copy)->path,
                        gonio_readings_describe(readings)->path);
    assert_int_equal(gonio_readings_describe(copy)->line[2], 3);
    gonio_readings_free(&copy);
    gonio_readings_free(&readings);
}

static void test_what_was_not_read_stays_so(void **state)
{
    (void)state;
    static const double rows[][4] = {{20, 0, 70, 200}, {30, 0, 50, 40}};
    gonio_readings *known = made_colours(known_rows, 3);
    gonio_readings *plan = made_directions(rows, 2);
    assert_int_equal(gonio_readings_look_up(NULL, plan, known), GONIO_OK);
    assert_close(gonio_readings_value(plan, 0, 1), 0.5, 0.0);
    assert_true(isnan(gonio_readings_value(plan, 0, 2)));
    assert_close(gonio_readings_value(plan, 1, 2), 0.3, 0.0);
    gonio_readings_free(&plan);
    gonio_readings_free(&known);
}

static void test_spectra_are_looked_up_too(void **state)
{
    (void)state;
    static const double waves[] = {400, 500};
    static const double spectra[][6] = {{30, 0, 50, 40, 0.1, 0.2}, {10, 0, 20, 0, 0.3, 0.4}};
    static const double deviations[] = {0.01, 0.02, 0.03, 0.04};
    static const double rows[][4] = {{10, 0, 20, 0}};
    gonio_readings *known = made_spectra(&spectra[0][0], 2, 2, waves, true);
    gonio_readings *plan = made_directions(rows, 1);
    assert_int_equal(gonio_readings_set_deviations(NULL, known, deviations), GONIO_OK);
    assert_int_equal(gonio_readings_look_up(NULL, plan, known), GONIO_OK);
    assert_int_equal(gonio_readings_describe(plan)->channels, 2);
    assert_close(gonio_readings_value(plan, 0, 0), 0.3, 0.0);
    assert_close(gonio_readings_value(plan, 0, 1), 0.4, 0.0);
    assert_close(gonio_readings_describe(plan)->wavelength[1], 500.0, 0.0);
    assert_close(gonio_readings_describe(plan)->deviation[1], 0.04, 0.0);
    gonio_readings_free(&plan);
    gonio_readings_free(&known);
}

/* ---- errors ---- */

static void test_errors_between_readings(void **state)
{
    (void)state;
    static const double rows[][7] = {
        {30, 0, 50, 40, 0.11, 0.2, 0.2}, {20, 0, 70, 200, 0.4, 0.6, 7}, {45, 0, 45, 180, 1, 2, 3}};
    gonio_readings *a = made_colours(known_rows, 3);
    gonio_readings *b = made_colours(rows, 3);
    const bool left_out[3] = {false, false, true};
    const double pairs[][3] = {/* value, other, channel */
                               {0.1, 0.11, 0},
                               {0.2, 0.2, 1},
                               {0.3, 0.2, 2},
                               {0.4, 0.4, 0},
                               {0.5, 0.6, 1}};
    double sums[6] = {0.0};
    for (size_t k = 0; k < 5; k++) {
        const double cosines = k < 3 ? cos(M_PI / 6.0) * cos(50.0 * M_PI / 180.0)
                                     : cos(M_PI / 9.0) * cos(70.0 * M_PI / 180.0);
        const double s = gonio_log_scale((int)pairs[k][2]);
        const double g = log(1.0 + pairs[k][0] / s);
        const double cube = cbrt(pairs[k][0] * cosines);
        sums[0] += pow(g - log(1.0 + pairs[k][1] / s), 2.0);
        sums[1] += g * g;
        sums[5] += log(1.0 + pairs[k][1] / s) - g;
        sums[2] += pow(cube - cbrt(pairs[k][1] * cosines), 2.0);
        sums[3] += cube * cube;
        sums[4] += pow(log((pairs[k][0] * cosines + 0.001) / (pairs[k][1] * cosines + 0.001)), 2.0);
    }
    gonio_error error;
    size_t compared = 0;
    assert_int_equal(gonio_compare_readings(NULL, a, b, left_out, &error, &compared), GONIO_OK);
    assert_int_equal(compared, 2);
    assert_close(error.value[GONIO_E6], 100.0 * sqrt(sums[0] / sums[1]), 1e-9);
    assert_close(error.value[GONIO_CUBE_ROOT], 100.0 * sqrt(sums[2] / sums[3]), 1e-9);
    assert_close(error.value[GONIO_LOG_RELATIVE_ERROR], sqrt(sums[4] / 5.0), 1e-12);
    assert_close(error.value[GONIO_BIAS], 100.0 * sums[5] / 5.0, 1e-9);
    assert_int_equal(gonio_compare_readings(NULL, a, a, NULL, &error, &compared), GONIO_OK);
    assert_int_equal(compared, 3);
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        assert_true(error.value[m] == 0.0);
    }
    gonio_readings_free(&a);
    gonio_readings_free(&b);
}

static void test_channels_without_values_go(void **state)
{
    (void)state;
    static const double wave[] = {400, 500, 600};
    static const double rows[][7] = {{30, 0, 50, 40, NAN, 0.2, NAN}, {5, 0, 5, 40, NAN, 0.4, NAN}};
    static const double spectra[][7] = {{30, 0, 50, 40, NAN, NAN, 0.3},
                                        {5, 0, 5, 40, 0.1, NAN, NAN}};
    static const double deviations[] = {NAN, 0.1, NAN, NAN, 0.2, NAN};
    gonio_readings *one = made_colours(rows, 2);
    gonio_readings *two = made_spectra(&spectra[0][0], 2, 3, wave, true);
    gonio_readings *none = made_directions((const double[][4]){{30, 0, 50, 40}}, 1);
    assert_int_equal(gonio_readings_set_deviations(NULL, one, deviations), GONIO_OK);
    assert_int_equal(gonio_readings_drop_empty_channels(NULL, one), GONIO_OK);
    assert_int_equal(gonio_readings_drop_empty_channels(NULL, two), GONIO_OK);
    assert_int_equal(gonio_readings_drop_empty_channels(NULL, none), GONIO_OK);
    assert_int_equal(gonio_readings_describe(one)->channels, 1);
    assert_close(gonio_readings_value(one, 1, 0), 0.4, 0.0);
    assert_close(gonio_readings_describe(one)->deviation[1], 0.2, 0.0);
    assert_int_equal(gonio_readings_describe(two)->channels, 2);
    assert_close(gonio_readings_describe(two)->wavelength[1], 600.0, 0.0);
    assert_close(gonio_readings_value(two, 1, 0), 0.1, 0.0);
    assert_true(isnan(gonio_readings_value(two, 1, 1)));
    assert_int_equal(gonio_readings_describe(none)->channels, 3);
    gonio_readings_free(&none);
    gonio_readings_free(&two);
    gonio_readings_free(&one);
}

/* Brings b into the channels of a, or both into colours, and frees both. */
static gonio_status share(gonio_readings *a, gonio_readings *b, double *first, double *second)
{
    const gonio_status status = gonio_readings_share_channels(NULL, a, b);
    for (size_t c = 0; c < 3 && status == GONIO_OK; c++) {
        first[c] = gonio_readings_value(a, 0, c);
        second[c] = gonio_readings_value(b, 0, c);
    }
    gonio_readings_free(&a);
    gonio_readings_free(&b);
    return status;
}

static void test_channels_in_common(void **state)
{
    (void)state;
    static const double colours[] = {30, 0, 50, 40, 0.1, 0.2, 0.3};
    static const double flat[] = {30, 0, 50, 40, 0.2, 0.2, 0.2};
    static const double spectrum[] = {30, 0, 50, 40, 0.3, 0.1};
    static const double grey[] = {30, 0, 50, 40, 0.4};
    static const double here[] = {450, 550, 700};
    static const double there[] = {600, 400};
    static const double far[] = {900, 1000};
    double a[3];
    double b[3];
    /* Linear between 0.1 at 400 nm and 0.3 at 600 nm, and nothing beyond. */
    assert_int_equal(share(made_spectra(flat, 1, 3, here, true),
                           made_spectra(spectrum, 1, 2, there, true), a, b),
                     GONIO_OK);
    assert_close(a[0], 0.2, 0.0);
    assert_close(b[0], 0.15, 1e-15);
    assert_close(b[1], 0.25, 1e-15);
    assert_true(isnan(b[2]));
    /* A flat spectrum is white, a single channel grey. */
    assert_int_equal(
        share(made_spectra(colours, 1, 3, NULL, true), made_spectra(flat, 1, 3, here, true), a, b),
        GONIO_OK);
    assert_int_equal(
        share(made_spectra(grey, 1, 1, NULL, true), made_spectra(colours, 1, 3, NULL, true), b, a),
        GONIO_OK);
    for (size_t c = 0; c < 3; c++) {
        assert_close(a[c], colours[4 + c], 0.0);
        assert_close(b[c], 0.4, 0.0);
    }
    assert_int_equal(
        share(made_spectra(flat, 1, 3, here, true), made_spectra(colours, 1, 3, NULL, true), b, a),
        GONIO_OK);
    for (size_t c = 0; c < 3; c++) {
        assert_close(b[c], 0.2, 1e-12);
    }
    assert_int_equal(
        share(made_spectra(flat, 1, 3, here, true), made_spectra(spectrum, 1, 2, far, true), a, b),
        GONIO_ERROR_MISMATCH);
    assert_int_equal(share(made_spectra(spectrum, 1, 2, NULL, true),
                           made_spectra(colours, 1, 3, NULL, true), a, b),
                     GONIO_ERROR_MISMATCH);
}

static void test_readings_that_cannot_be_compared(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    static const double dark_row[][7] = {{30, 0, 50, 40, 0, 0, 0}};
    static const double spectra[][5] = {
        {30, 0, 50, 40, 1}, {20, 0, 70, 200, 1}, {45, 0, 45, 180, 1}};
    static const double wave = 400.0;
    gonio_readings *a = made_colours(known_rows, 3);
    gonio_readings *fewer = made_colours(known_rows, 1);
    gonio_readings *spectral = made_spectra(&spectra[0][0], 3, 1, &wave, true);
    gonio_readings *dark = made_colours(dark_row, 1);
    gonio_error error;
    size_t compared = 0;
    const bool all[3] = {true, true, true};
    assert_int_equal(gonio_compare_readings(context, a, fewer, NULL, &error, &compared),
                     GONIO_ERROR_MISMATCH);
    assert_int_equal(gonio_compare_readings(context, a, spectral, NULL, &error, &compared),
                     GONIO_ERROR_MISMATCH);
    assert_int_equal(gonio_compare_readings(context, dark, fewer, NULL, &error, &compared),
                     GONIO_ERROR_DATA);
    assert_int_equal(gonio_compare_readings(context, a, a, all, &error, &compared),
                     GONIO_ERROR_DATA);
    assert_non_null(strstr(support_message(), "no readings to compare"));
    gonio_readings_free(&dark);
    gonio_readings_free(&spectral);
    gonio_readings_free(&fewer);
    gonio_readings_free(&a);
    gonio_context_free(&context);
}

/* ---- spectra as colours ---- */

static void to_rgb(const double *wavelength, const double *value, size_t count,
                   double rgb[GONIO_CHANNELS])
{
    double weight[GONIO_CHANNELS * 31];
    assert_int_equal(gonio_i_colour_weights(NULL, wavelength, count, GONIO_ILLUMINANT_E, weight),
                     GONIO_OK);
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        rgb[c] = 0.0;
        for (size_t k = 0; k < count; k++) {
            rgb[c] += weight[c * count + k] * value[k];
        }
        rgb[c] = fmax(rgb[c], 0.0);
    }
}

static void test_spectra_as_colours(void **state)
{
    (void)state;
    double wavelength[31];
    double value[31];
    double colour[GONIO_CHANNELS];
    double twice[GONIO_CHANNELS];
    for (size_t k = 0; k < 31; k++) {
        wavelength[k] = 400.0 + 10.0 * (double)k;
        value[k] = 0.7;
    }
    to_rgb(wavelength, value, 31, colour); /* flat: white */
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        assert_close(colour[c], 0.7, 1e-12);
    }
    /* Light of one end or the middle is mostly of that colour; never negative. */
    static const double middle[GONIO_CHANNELS] = {620.0, 540.0, 450.0};
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        for (size_t k = 0; k < 31; k++) {
            value[k] = exp(-0.5 * pow((wavelength[k] - middle[c]) / 15.0, 2.0));
        }
        to_rgb(wavelength, value, 31, colour);
        for (int other = 0; other < GONIO_CHANNELS; other++) {
            assert_true(colour[other] >= 0.0 && isfinite(colour[other]));
            assert_true(other == c || colour[other] < 0.7 * colour[c]);
        }
        for (size_t k = 0; k < 31; k++) {
            value[k] *= 2.0;
        }
        to_rgb(wavelength, value, 31, twice);
        assert_close(twice[c], 2.0 * colour[c], 1e-12);
    }
    /* Part of a flat spectrum, a line of any colour and infrared are white. */
    static const double line[4][2] = {
        {532.0, 560.0}, {633.0, 640.0}, {1064.0, 1550.0}, {380.0, 420.0}};
    static const double flat[2] = {0.3, 0.3};
    for (int k = 0; k < 8; k++) {
        to_rgb(line[k / 2], flat, (size_t)(1 + k % 2), colour);
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            assert_close(colour[c], 0.3, 1e-12);
        }
    }
    /* Its order does not matter. */
    double backwards[31];
    double reversed[31];
    for (size_t k = 0; k < 31; k++) {
        backwards[k] = wavelength[30 - k];
        reversed[k] = value[30 - k];
    }
    to_rgb(backwards, reversed, 31, colour);
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        assert_close(colour[c], twice[c], 1e-12);
    }
}

/* Readings that differ as the sample turns are not taken for those of another rotation. */
static void test_rotations_of_an_anisotropic_sample(void **state)
{
    (void)state;
    enum { ROTATIONS = 6 };
    double rows[ROTATIONS][7];
    gonio_context *context = support_context();
    for (int k = 0; k < ROTATIONS; k++) {
        const double row[7] = {30, 30.0 * k, 50, 30.0 * k + 40, 1 + k % 2, 1 + k % 2, 1 + k % 2};
        memcpy(rows[k], row, sizeof row);
    }
    gonio_readings *known = made_colours((const double(*)[7])rows, ROTATIONS);
    static const struct {
        double row[4];
        double value; /* -1: none */
    } cases[] = {
        {{30, 30, 50, 70}, 2.0},  {{50, 70, 30, 30}, 2.0},    {{30, 60, 50, 100}, 1.0},
        {{30, 45, 50, 85}, -1.0}, {{30, 210, 50, 250}, -1.0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_readings *plan = made_directions(&cases[k].row, 1);
        const gonio_status status = gonio_readings_look_up(context, plan, known);
        assert_int_equal(status, cases[k].value > 0.0 ? GONIO_OK : GONIO_ERROR_DATA);
        if (status == GONIO_OK) {
            assert_close(gonio_readings_value(plan, 0, 0), cases[k].value, 0.0);
        } else {
            assert_non_null(strstr(support_message(), "this rotation of the sample"));
        }
        gonio_readings_free(&plan);
    }
    gonio_readings_free(&known);
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_look_up),
        cmocka_unit_test(test_rotations_of_an_anisotropic_sample),
        cmocka_unit_test(test_own_lines_come_first),
        cmocka_unit_test(test_rounded_angles_are_found),
        cmocka_unit_test(test_repeats_are_averaged),
        cmocka_unit_test(test_repeats_become_their_mean),
        cmocka_unit_test(test_what_was_not_read_stays_so),
        cmocka_unit_test(test_spectra_are_looked_up_too),
        cmocka_unit_test(test_errors_between_readings),
        cmocka_unit_test(test_channels_without_values_go),
        cmocka_unit_test(test_channels_in_common),
        cmocka_unit_test(test_readings_that_cannot_be_compared),
        cmocka_unit_test(test_spectra_as_colours),
    };
    return cmocka_run_group_tests_name("readings looked up and compared", tests, NULL, NULL);
}
