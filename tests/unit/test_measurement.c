/* Readings as files, and the statistics of the simulated instrument. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made_direct.h"
#include "made_material.h"
#include "made_readings.h"

enum { DIRECTIONS = 4000 };

static const double values[GONIO_CHANNELS] = {0.1, 1.0, 20.0};

typedef struct fixture {
    char *folder;
    char path[256];
    gonio_table *table;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    gonio_material *material =
        made_material((made_constant){{values[0], values[1], values[2]}, NULL});
    assert_non_null(f);
    f->folder = support_folder();
    snprintf(f->path, sizeof f->path, "%s/readings.csv", f->folder);
    f->table = made_table(material);
    gonio_material_free(&material);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_table_free(&f->table);
    support_remove(f->folder);
    free(f);
    return 0;
}

static gonio_readings *read_back(const fixture *f, bool values_needed)
{
    const gonio_readings_options options = {.size = sizeof options, .values_needed = values_needed};
    gonio_readings *readings = NULL;
    gonio_context *context = support_context();
    if (gonio_readings_read(context, f->path, &options, &readings) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    gonio_context_free(&context);
    return readings;
}

/* A plan of many directions, forwards or backwards. */
static gonio_readings *make_plan(bool backwards)
{
    static double row[DIRECTIONS][4];
    for (int k = 0; k < DIRECTIONS; k++) {
        const int n = backwards ? DIRECTIONS - 1 - k : k;
        const double angles[4] = {n % 80 + 0.25, n % 360, n / 50 + 0.5, n % 181};
        memcpy(row[k], angles, sizeof angles);
    }
    return made_directions((const double(*)[4])row, DIRECTIONS);
}

static void measure(gonio_readings *readings, const fixture *f, double noise, double floor,
                    uint64_t seed)
{
    const gonio_instrument_options options = {
        .size = sizeof options, .noise = noise, .floor = floor, .seed = seed};
    assert_int_equal(gonio_measure(NULL, readings, f->table, &options), GONIO_OK);
}

static void test_without_noise_the_value_itself(void **state)
{
    const fixture *f = *state;
    gonio_readings *readings = make_plan(false);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, DIRECTIONS);
    assert_true(isnan(view->value[0]));
    assert_int_equal(view->planned[0], GONIO_ALL_CHANNELS);
    assert_int_equal(view->line[5], 6);
    assert_int_equal(gonio_measure(NULL, readings, f->table, NULL), GONIO_OK);
    for (size_t k = 0; k < view->count; k++) {
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            const double value = gonio_readings_value(readings, k, (size_t)channel);
            assert_true(fabs(value / values[channel] - 1.0) < 1e-14);
        }
    }
    gonio_readings_free(&readings);
    assert_null(readings);
}

/* Mean and standard deviation of all readings of a channel, each within five standard errors. */
static void assert_statistics(const gonio_readings *readings, int channel, double mean,
                              double deviation)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    const double n = (double)view->count;
    double sum = 0.0;
    double squares = 0.0;
    for (size_t k = 0; k < view->count; k++) {
        const double difference = gonio_readings_value(readings, k, (size_t)channel) - mean;
        sum += difference;
        squares += difference * difference;
    }
    assert_true(fabs(sum / n) < 5.0 * deviation / sqrt(n));
    assert_true(fabs(sqrt(squares / n) / deviation - 1.0) < 5.0 / sqrt(2.0 * n));
}

static void test_noise_is_as_large_as_asked(void **state)
{
    const fixture *f = *state;
    gonio_readings *readings = make_plan(false);
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        const double v = values[channel];
        measure(readings, f, 0.02, 0.0, 1);
        assert_statistics(readings, channel, v, 0.02 * v);
        measure(readings, f, 0.0, 0.005, 2);
        assert_statistics(readings, channel, v, 0.005);
        measure(readings, f, 0.02, 0.005, 3);
        assert_statistics(readings, channel, v, hypot(0.02 * v, 0.005));
    }
    gonio_readings_free(&readings);
}

static void test_readings_are_not_negative(void **state)
{
    const fixture *f = *state;
    gonio_readings *readings = make_plan(false);
    measure(readings, f, 0.0, 1.0, 4);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    int zeros = 0;
    for (size_t k = 0; k < view->count; k++) {
        assert_true(gonio_readings_value(readings, k, 0) >= 0.0);
        zeros += gonio_readings_value(readings, k, 0) == 0.0;
    }
    assert_in_range(zeros, DIRECTIONS / 3, DIRECTIONS / 2); /* 46 per cent are expected */
    gonio_readings_free(&readings);
}

static void test_noise_belongs_to_the_direction_and_the_seed(void **state)
{
    const fixture *f = *state;
    gonio_readings *forwards = make_plan(false);
    gonio_readings *backwards = make_plan(true);
    gonio_readings *other = make_plan(false);
    measure(forwards, f, 0.1, 0.01, 5);
    measure(backwards, f, 0.1, 0.01, 5);
    measure(other, f, 0.1, 0.01, 6);
    const double *a = gonio_readings_describe(forwards)->value;
    const double *b = gonio_readings_describe(backwards)->value;
    const double *c = gonio_readings_describe(other)->value;
    for (size_t k = 0; k < DIRECTIONS; k++) {
        assert_memory_equal(a + GONIO_CHANNELS * k, b + GONIO_CHANNELS * (DIRECTIONS - 1 - k),
                            GONIO_CHANNELS * sizeof *a);
        assert_true(a[GONIO_CHANNELS * k + 1] != c[GONIO_CHANNELS * k + 1]);
    }
    gonio_readings_free(&forwards);
    gonio_readings_free(&backwards);
    gonio_readings_free(&other);
}

/* The same plan as a file. */
static gonio_readings *read_plan(const fixture *f)
{
    FILE *file = fopen(f->path, "wb");
    assert_non_null(file);
    fputs("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n", file);
    for (int n = 0; n < DIRECTIONS; n++) {
        fprintf(file, "%.3f,%d,%.3f,%d\n", n % 80 + 0.25, n % 360, n / 50 + 0.5, n % 181);
    }
    assert_int_equal(fclose(file), 0);
    return read_back(f, false);
}

static void test_readings_are_written_and_read(void **state)
{
    const fixture *f = *state;
    gonio_readings *readings = read_plan(f);
    assert_int_equal(gonio_readings_describe(readings)->count, DIRECTIONS);
    assert_int_equal(gonio_readings_describe(readings)->line[5], 7);
    measure(readings, f, 0.1, 0.01, 7);
    assert_int_equal(gonio_readings_write(NULL, readings, "a command", f->path), GONIO_OK);
    gonio_readings *again = read_back(f, true);
    const gonio_readings_view *a = gonio_readings_describe(readings);
    const gonio_readings_view *b = gonio_readings_describe(again);
    assert_memory_equal(a->pair, b->pair, DIRECTIONS * sizeof *a->pair);
    for (size_t k = 0; k < DIRECTIONS * GONIO_CHANNELS; k++) {
        assert_true(fabs(a->value[k] - b->value[k]) <= 1e-9 * a->value[k]);
    }
    gonio_readings_free(&readings);
    gonio_readings_free(&again);
}

static void test_negative_noise_is_refused(void **state)
{
    const fixture *f = *state;
    enum { size = sizeof(gonio_instrument_options) };
    static const gonio_instrument_options bad[] = {{size, -0.1, 0.0, 0, 0.0},
                                                   {size, 0.0, -0.1, 0, 0.0},
                                                   {size, NAN, 0.0, 0, 0.0},
                                                   {size, 0.0, INFINITY, 0, 0.0},
                                                   {size, 0.0, 0.0, 0, -0.1}};
    gonio_readings *readings = make_plan(false);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        assert_int_equal(gonio_measure(NULL, readings, f->table, &bad[k]), GONIO_ERROR_ARGUMENT);
    }
    gonio_readings_free(&readings);
}

static void test_angles(void **state)
{
    const fixture *f = *state;
    FILE *file = fopen(f->path, "wb");
    assert_non_null(file);
    fputs("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel,R_per_sr\n"
          "30,-90,45,360,g,0.5\n",
          file);
    assert_int_equal(fclose(file), 0);
    gonio_readings *readings = read_back(f, true);
    const gonio_readings_view *r = gonio_readings_describe(readings);
    assert_true(fabs(r->pair->incident.theta - M_PI / 6.0) < 1e-15);
    assert_true(fabs(r->pair->incident.phi - 1.5 * M_PI) < 1e-15);
    assert_true(fabs(r->pair->outgoing.theta - M_PI / 4.0) < 1e-15);
    assert_true(r->pair->outgoing.phi == 0.0);
    assert_int_equal(r->planned[0], 1);
    assert_true(r->value[0] == 0.5 && isnan(r->value[1]) && isnan(r->value[2]));
    gonio_readings_free(&readings);
}

/* A material that can be evaluated is read by its own evaluation, in its own channels. */
static void test_a_material_in_its_own_channels(void **state)
{
    (void)state;
    static const double wavelength[2] = {532.0, 1064.0};
    static const double angles[2][4] = {{20.0, 70.0, 30.0, 200.0}, {70.0, 0.0, 10.0, 90.0}};
    gonio_material *material = made_direct(2, wavelength, 1.3);
    gonio_readings *readings = made_directions(angles, 2);
    assert_int_equal(gonio_measure_material(NULL, readings, material, NULL), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->channels, 2);
    for (size_t k = 0; k < 4; k++) {
        assert_true(view->wavelength[k % 2] == wavelength[k % 2]);
        assert_true(fabs(view->value[k] - made_direct_value(view->pair[k / 2], k % 2)) < 1e-12);
    }
    gonio_material_free(&material);
    material = made_direct(2, wavelength, 1.0); /* 70 degrees are beyond */
    gonio_context *context = support_context();
    assert_int_equal(gonio_measure_material(context, readings, material, NULL), GONIO_OK);
    assert_true(gonio_readings_value(readings, 0, 0) > 0.0);
    assert_true(isnan(gonio_readings_value(readings, 1, 0)));
    gonio_material_free(&material);
    material = made_direct(2, wavelength, 0.2); /* all are */
    assert_int_equal(gonio_measure_material(context, readings, material, NULL), GONIO_ERROR_DATA);
    assert_non_null(strstr(support_message(), "no data"));
    gonio_context_free(&context);
    gonio_material_free(&material);
    gonio_readings_free(&readings);
}

/* A plan that names a colour is read in colours. */
static void test_a_plan_of_colours(void **state)
{
    (void)state;
    static const double wavelength[2] = {450.0, 650.0};
    const gonio_pair pair = {{0.3, 0.0}, {0.4, 1.0}};
    const int planned = 2;
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = 1, .channels = 3, .pair = &pair, .planned = &planned};
    const gonio_readings_options options = {.size = sizeof options};
    gonio_readings *readings = NULL;
    gonio_material *material = made_direct(2, wavelength, 0.0);
    assert_int_equal(gonio_readings_create(NULL, &arrays, &options, &readings), GONIO_OK);
    assert_int_equal(gonio_measure_material(NULL, readings, material, NULL), GONIO_OK);
    assert_true(gonio_readings_are_colours(readings));
    assert_true(gonio_readings_value(readings, 0, 2) > 0.0);
    gonio_material_free(&material);
    gonio_readings_free(&readings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_without_noise_the_value_itself),
        cmocka_unit_test(test_noise_is_as_large_as_asked),
        cmocka_unit_test(test_readings_are_not_negative),
        cmocka_unit_test(test_noise_belongs_to_the_direction_and_the_seed),
        cmocka_unit_test(test_readings_are_written_and_read),
        cmocka_unit_test(test_negative_noise_is_refused),
        cmocka_unit_test(test_angles),
        cmocka_unit_test(test_a_material_in_its_own_channels),
        cmocka_unit_test(test_a_plan_of_colours),
    };
    return cmocka_run_group_tests_name("measurement", tests, set_up, tear_down);
}
