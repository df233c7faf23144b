/* Readings as arrays: made, changed, written and read again. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made_readings.h"
#include "measurement/readings.h"

static gonio_context *context;

static int set_up(void **state)
{
    (void)state;
    context = support_context();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    gonio_context_free(&context);
    return 0;
}

/* ---- what arrays may hold ---- */

static const gonio_pair two_pairs[2] = {{{0.1, 0.0}, {0.2, 3.0}}, {{0.3, 6.0}, {0.4, -1.0}}};

static void test_azimuths_are_within_a_turn(void **state)
{
    (void)state;
    const gonio_pair pair = {{0.5, -0.5}, {0.25, 2.0 * M_PI}};
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = 1, .channels = 1, .pair = &pair};
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_create(context, &arrays, NULL, &readings), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_true(fabs(view->pair->incident.phi - (2.0 * M_PI - 0.5)) < 1e-15);
    assert_true(view->pair->outgoing.phi == 0.0);
    assert_true(view->pair->incident.theta == 0.5);
    assert_true(isnan(gonio_readings_value(readings, 0, 0)));
    assert_true(isnan(gonio_readings_value(readings, 0, 1))); /* there is no such channel */
    gonio_readings_free(&readings);
}

static void test_what_arrays_may_not_hold(void **state)
{
    (void)state;
    static const gonio_pair low[2] = {{{0.1, 0.0}, {0.2, 3.0}}, {{0.1, 0.0}, {M_PI / 2.0, 0.0}}};
    static const gonio_pair far[2] = {{{0.1, 0.0}, {0.2, 3.0}}, {{0.1, 7.0}, {0.2, 0.0}}};
    static const gonio_pair same[2] = {{{0.1, 0.0}, {0.2, 3.0}}, {{0.1, 0.0}, {0.2, 3.0}}};
    const gonio_pair lost[2] = {{{0.1, NAN}, {0.2, 3.0}}, {{0.1, 0.0}, {0.2, 3.0}}};
    enum { size = sizeof(gonio_readings_arrays) };
    static const double waves[2] = {400.0, 500.0};
    static const double twice[2] = {400.0, 400.0};
    static const double no_waves[2] = {400.0, -1.0};
    static const double good[4] = {1.0, NAN, 0.0, 2.0};
    static const double dark[4] = {1.0, 1.0, 1.0, -2.0};
    const double endless[4] = {1.0, INFINITY, 1.0, 1.0};
    static const int planned[2] = {0, 2};
    const struct {
        gonio_readings_arrays arrays;
        gonio_status status;
        const char *message;
    } cases[] = {
        {{size, 0, 2, two_pairs, NULL, NULL, good, NULL},
         GONIO_ERROR_ARGUMENT,
         "no readings given"},
        {{size, 2, 0, two_pairs, NULL, NULL, good, NULL}, GONIO_ERROR_ARGUMENT, "no channels"},
        {{size, 2, 2, low, NULL, waves, good, NULL},
         GONIO_ERROR_DATA,
         "readings:2: theta_o_deg '90' is"},
        {{size, 2, 2, far, NULL, waves, good, NULL}, GONIO_ERROR_DATA, "is outside -360 to 360"},
        {{size, 2, 2, lost, NULL, waves, good, NULL}, GONIO_ERROR_FORMAT, "readings:1: phi_i_deg"},
        {{size, 2, 2, same, NULL, waves, good, NULL},
         GONIO_ERROR_DATA,
         "readings:2: the same directions"},
        {{size, 2, 2, two_pairs, NULL, twice, good, NULL},
         GONIO_ERROR_ARGUMENT,
         "400 nm occurs twice"},
        {{size, 2, 2, two_pairs, NULL, no_waves, good, NULL},
         GONIO_ERROR_ARGUMENT,
         "-1 is not a wavelength"},
        {{size, 2, 2, two_pairs, planned, NULL, good, NULL},
         GONIO_ERROR_ARGUMENT,
         "channel 2 is outside 2"},
        {{size, 2, 2, two_pairs, NULL, waves, dark, NULL},
         GONIO_ERROR_DATA,
         "500nm_per_sr '-2' is negative"},
        {{size, 2, 2, two_pairs, NULL, NULL, endless, NULL},
         GONIO_ERROR_FORMAT,
         "value2_per_sr 'inf'"},
        {{size, 2, 2, two_pairs, NULL, waves, good, dark},
         GONIO_ERROR_DATA,
         "500nm_deviation_per_sr '-2'"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_readings *readings = NULL;
        const gonio_status status =
            gonio_readings_create(context, &cases[k].arrays, NULL, &readings);
        if (status != cases[k].status || strstr(support_message(), cases[k].message) == NULL) {
            fail_msg("case %zu: status %d, '%s'; expected %d, '%s'", k, (int)status,
                     support_message(), (int)cases[k].status, cases[k].message);
        }
        assert_null(readings);
    }
}

static void test_repeats_and_negative_values_where_they_may_be(void **state)
{
    (void)state;
    static const gonio_pair same[2] = {{{0.1, 0.0}, {0.2, 3.0}}, {{0.1, 0.0}, {0.2, 3.0}}};
    static const double value[2] = {0.5, -0.5};
    const gonio_readings_options any = {
        .size = sizeof any, .average_repeats = true, .negative_to_zero = true};
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = 2, .channels = 1, .pair = same, .value = value};
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_create(context, &arrays, &any, &readings), GONIO_OK);
    assert_true(gonio_readings_value(readings, 1, 0) == 0.0);
    gonio_readings_free(&readings);
}

static void test_values_can_be_set(void **state)
{
    (void)state;
    static const double waves[3] = {500.0, 400.0, 600.0};
    static const double value[6] = {1.0, 2.0, 3.0, 4.0, NAN, 6.0};
    static const double dark[2] = {1.0, -1.0};
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = 2, .channels = 3, .pair = two_pairs};
    gonio_readings *r = NULL;
    assert_int_equal(gonio_readings_create(context, &arrays, NULL, &r), GONIO_OK);
    assert_true(gonio_readings_scale(r, 1) == gonio_log_scale(1));
    assert_int_equal(gonio_readings_set_values(context, r, 3, waves, value, NULL), GONIO_OK);
    assert_false(gonio_readings_are_colours(r));
    assert_true(gonio_readings_scale(r, 1) == 1.0 / 1500.0);
    assert_int_equal(gonio_readings_set_deviations(context, r, value), GONIO_OK);
    assert_int_equal(gonio_readings_set_value(context, r, 1, 1, 5.0), GONIO_OK);
    assert_true(gonio_readings_value(r, 1, 1) == 5.0);
    assert_true(isnan(gonio_readings_describe(r)->deviation[4]));
    /* What is refused changes nothing. */
    assert_int_equal(gonio_readings_set_values(context, r, 1, NULL, dark, NULL), GONIO_ERROR_DATA);
    assert_int_equal(gonio_readings_set_value(context, r, 2, 0, 1.0), GONIO_ERROR_ARGUMENT);
    assert_int_equal(gonio_readings_set_value(context, r, 0, 3, 1.0), GONIO_ERROR_ARGUMENT);
    assert_int_equal(gonio_readings_set_value(context, r, 0, 0, -1.0), GONIO_ERROR_DATA);
    const gonio_readings_view *view = gonio_readings_describe(r);
    assert_int_equal(view->channels, 3);
    assert_memory_equal(view->wavelength, waves, sizeof waves);
    assert_true(view->value[0] == 1.0 && view->value[4] == 5.0 && view->deviation[5] == 6.0);
    gonio_readings_free(&r);
}

/* ---- written and read again ---- */

static gonio_readings *write_and_read(const gonio_readings *readings, bool values_needed)
{
    const gonio_readings_options how = {.size = sizeof how, .values_needed = values_needed};
    char *folder = support_folder();
    char path[256];
    gonio_readings *again = NULL;
    snprintf(path, sizeof path, "%s/r.csv", folder);
    assert_int_equal(gonio_readings_write(context, readings, "a command", path), GONIO_OK);
    if (gonio_readings_read(context, path, &how, &again) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    support_remove(folder);
    return again;
}

static void assert_numbers(const double *a, const double *b, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        assert_true((isnan(a[k]) && isnan(b[k])) || fabs(a[k] - b[k]) <= 1e-9 * fabs(a[k]));
    }
}

/* One channel, two of them, colours, spectra; planned channels; deviations. */
static void test_arrays_are_written_and_read(void **state)
{
    (void)state;
    static const double waves[4] = {400.5, 550.0, 633.0, 1064.0};
    static const double value[8] = {0.125, NAN, 1e-7, 2.0, 12345.678901, 0.0, 0.3, 0.4};
    static const double deviation[8] = {0.01, NAN, 1e-9, 0.2, 10.0, 1e-5, 0.03, NAN};
    static const int planned[2] = {GONIO_ALL_CHANNELS, 0};
    for (size_t channels = 1; channels <= 4; channels++) {
        for (int spectral = 0; spectral < 2; spectral++) {
            const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                                  .count = 2,
                                                  .channels = channels,
                                                  .pair = two_pairs,
                                                  .planned = planned,
                                                  .wavelength = spectral ? waves : NULL,
                                                  .value = value,
                                                  .deviation = deviation};
            gonio_readings *readings = NULL;
            assert_int_equal(gonio_readings_create(context, &arrays, NULL, &readings), GONIO_OK);
            gonio_readings *again = write_and_read(readings, true);
            const gonio_readings_view *a = gonio_readings_describe(readings);
            const gonio_readings_view *b = gonio_readings_describe(again);
            assert_int_equal(b->channels, channels);
            assert_true((a->wavelength == NULL) == (b->wavelength == NULL));
            assert_true(!spectral || memcmp(b->wavelength, waves, channels * sizeof *waves) == 0);
            assert_numbers((const double *)a->pair, (const double *)b->pair, 8);
            assert_numbers(a->value, b->value, 2 * channels);
            assert_numbers(a->deviation, b->deviation, 2 * channels);
            assert_memory_equal(b->planned, planned, sizeof planned);
            gonio_readings_free(&again);
            gonio_readings_free(&readings);
        }
    }
}

static char *text_of(const gonio_readings *readings)
{
    char *folder = support_folder();
    char *text = calloc(1, 4096);
    char path[256];
    snprintf(path, sizeof path, "%s/r.csv", folder);
    assert_int_equal(gonio_readings_write(context, readings, NULL, path), GONIO_OK);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_true(fread(text, 1, 4095, file) > 0);
    fclose(file);
    support_remove(folder);
    return text;
}

static gonio_readings *read_text(const char *text, bool values_needed)
{
    const gonio_readings_options how = {.size = sizeof how, .values_needed = values_needed};
    char *folder = support_folder();
    gonio_readings *readings = NULL;
    if (made_readings(context, folder, "r.csv", text, &how, &readings) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    support_remove(folder);
    return readings;
}

/* Other columns, their order, quotes and spelling of angles stay; values are replaced, and those of
 * channels that there are no more go. */
static void test_what_is_kept_of_a_file(void **state)
{
    (void)state;
    static const double colours[3] = {0.25, 0.5, NAN};
    static const double waves[2] = {600.0, 400.0};
    gonio_readings *r =
        read_text("# gonio plan\n# kept: yes\n# program: other\n"
                  "note;400.0nm_per_sr;theta_i_deg;phi_i_deg;theta_o_deg;phi_o_deg\n"
                  "\"a;b\";0,7;10,50;-20;30;040\n",
                  true);
    assert_int_equal(gonio_readings_describe(r)->channels, 1);
    assert_int_equal(gonio_readings_set_values(context, r, 2, waves, colours, NULL), GONIO_OK);
    char *spectral = text_of(r);
    assert_non_null(strstr(spectral, "# gonio readings\n# kept: yes\n# program: gonio "));
    assert_null(strstr(spectral, "other"));
    assert_non_null(strstr(spectral,
                           "\nnote;400nm_per_sr;theta_i_deg;phi_i_deg;theta_o_deg;"
                           "phi_o_deg;600nm_per_sr\n\"a;b\";0.5;10,50;-20;30;040;0.25\n"));
    assert_int_equal(gonio_readings_set_values(context, r, 3, NULL, colours, NULL), GONIO_OK);
    char *coloured = text_of(r);
    assert_non_null(strstr(coloured, "\nnote;theta_i_deg;phi_i_deg;theta_o_deg;phi_o_deg;R_per_sr;"
                                     "G_per_sr;B_per_sr\n\"a;b\";10,50;-20;30;040;0.25;0.5;\n"));
    free(spectral);
    free(coloured);
    gonio_readings_free(&r);
}

/* A channel that was planned may be none of the channels that were read in the end. */
static void test_a_planned_channel_that_there_is_no_more(void **state)
{
    (void)state;
    static const int planned[2] = {GONIO_ALL_CHANNELS, 30};
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = 2, .channels = 31, .pair = two_pairs, .planned = planned};
    gonio_readings *r = NULL;
    assert_int_equal(gonio_readings_create(context, &arrays, NULL, &r), GONIO_OK);
    assert_int_equal(gonio_readings_set_values(context, r, 3, NULL, NULL, NULL), GONIO_OK);
    char *text = text_of(r);
    assert_non_null(strstr(text, ",all,"));
    assert_non_null(strstr(text, ",31,"));
    free(text);
    gonio_readings_free(&r);
}

static void test_columns_that_are_not_understood(void **state)
{
    (void)state;
    char *folder = support_folder();
    gonio_readings *r = NULL;
    assert_int_equal(made_readings(context, folder, "r.csv",
                                   "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,400nm_per_sr,"
                                   "400.0nm_per_sr\n10,0,20,0,1,2\n",
                                   NULL, &r),
                     GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "two columns of 400 nm"));
    assert_int_equal(made_readings(context, folder, "r.csv",
                                   "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R_per_sr,"
                                   "R_deviation_per_sr\n10,0,20,0,1,-2\n",
                                   NULL, &r),
                     GONIO_ERROR_DATA);
    assert_non_null(strstr(support_message(), ":2: R_deviation_per_sr '-2' is not a standard"));
    support_remove(folder);
    /* A column named like a value of its own is another column beside colours. */
    r = read_text("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value_per_sr,G_per_sr,"
                  "B_deviation_per_sr\n10,0,20,0,x,1,y\n",
                  true);
    assert_true(gonio_readings_are_colours(r));
    assert_true(gonio_readings_value(r, 0, 1) == 1.0);
    assert_null(gonio_readings_describe(r)->deviation);
    gonio_readings_free(&r);
}

/* What a reader says is told, kept and written. */
static void test_notes(void **state)
{
    (void)state;
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = 2, .channels = 1, .pair = two_pairs};
    gonio_readings *r = NULL;
    assert_int_equal(gonio_readings_create(context, &arrays, NULL, &r), GONIO_OK);
    assert_int_equal(gonio_i_readings_note(context, r, "%d below the horizon left out", 12),
                     GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(r);
    assert_int_equal(view->notes, 1);
    assert_string_equal(view->note[0], "12 below the horizon left out");
    char *text = text_of(r);
    assert_non_null(strstr(text, "# note: 12 below the horizon left out\n"));
    free(text);
    gonio_readings_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_azimuths_are_within_a_turn),
        cmocka_unit_test(test_what_arrays_may_not_hold),
        cmocka_unit_test(test_repeats_and_negative_values_where_they_may_be),
        cmocka_unit_test(test_values_can_be_set),
        cmocka_unit_test(test_arrays_are_written_and_read),
        cmocka_unit_test(test_what_is_kept_of_a_file),
        cmocka_unit_test(test_a_planned_channel_that_there_is_no_more),
        cmocka_unit_test(test_columns_that_are_not_understood),
        cmocka_unit_test(test_notes),
    };
    return cmocka_run_group_tests_name("readings", tests, set_up, tear_down);
}
