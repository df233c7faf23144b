/* Readings as observations: values in log space, their variances, bounds and transforms. */
#include "../support.h"

#include <math.h>

#include "posterior/observations.h"

static const double OPEN = GONIO_I_MODEL_DEVIATION * GONIO_I_MODEL_DEVIATION;
static const gonio_i_noise NOISE = {.relative = 0.02, .floor = 1e-3, .saturation = 5.0};

enum { COUNT = 2, CHANNELS = 3 };

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g is not %.17g to %g", value, expected, tolerance);
    }
}

static const gonio_pair pair[COUNT] = {{{0.3, 0.0}, {0.5, 3.0}}, {{0.8, 0.0}, {0.2, 1.0}}};
static const double value[COUNT * CHANNELS] = {0.1, 0.2, 0.0, 6.0, NAN, 0.4};

static gonio_readings *make(gonio_context *context, const double *deviation)
{
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = COUNT,
                                          .channels = CHANNELS,
                                          .pair = pair,
                                          .value = value,
                                          .deviation = deviation};
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_create(context, &arrays, NULL, &readings), GONIO_OK);
    return readings;
}

static gonio_i_columns columns_of(gonio_context *context, const gonio_readings *readings,
                                  gonio_channel_model channels)
{
    const gonio_basis_view view = {.channels = channels};
    gonio_i_columns columns;
    assert_int_equal(gonio_i_columns_create(context, &view, readings, &NOISE, &columns), GONIO_OK);
    return columns;
}

/* (relative^2 v^2 + floor^2) / (v + s)^2, and what the model leaves open. */
static double variance_at(double v, double deviation, double s)
{
    return deviation * deviation / ((v + s) * (v + s)) + OPEN;
}

static double usual_deviation(double v)
{
    return hypot(NOISE.relative * v, NOISE.floor);
}

static void test_values_and_bounds(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_readings *readings = make(context, NULL);
    gonio_i_columns columns = columns_of(context, readings, GONIO_SEPARATE);
    assert_int_equal(columns.count, CHANNELS);
    for (size_t c = 0; c < CHANNELS; c++) {
        const gonio_i_column *column = &columns.column[c];
        const double s = gonio_log_scale((int)c);
        assert_int_equal(column->count, c == 1 ? 1 : 2); /* what was not read is not there */
        for (size_t i = 0; i < column->count; i++) {
            const gonio_i_observation *o = &column->observation[i];
            const double v = value[o->reading * CHANNELS + c];
            assert_int_equal(o->reading, i);
            assert_int_equal(o->channel, c);
            assert_int_equal(o->bound, v <= 0.0 ? -1 : v >= NOISE.saturation ? 1 : 0);
            assert_close(o->g, log1p(v / s), 1e-12);
            assert_close(o->variance, variance_at(v, usual_deviation(v), s), 1e-12);
        }
    }
    gonio_i_columns_free(&columns);
    columns = columns_of(context, readings, GONIO_JOINT);
    assert_int_equal(columns.count, 1);
    assert_int_equal(columns.column[0].count, COUNT * CHANNELS - 1);
    gonio_i_columns_free(&columns);
    gonio_readings_free(&readings);
    gonio_context_free(&context);
}

/* The standard deviation of a value comes before the noise of the instrument, where it is known. */
static void test_stated_deviations(void **state)
{
    (void)state;
    const double deviation[COUNT * CHANNELS] = {0.03, NAN, 0.002, 0.0, 0.1, 0.05};
    gonio_context *context = support_context();
    gonio_readings *readings = make(context, deviation);
    gonio_i_columns columns = columns_of(context, readings, GONIO_SEPARATE);
    for (size_t c = 0; c < CHANNELS; c++) {
        for (size_t i = 0; i < columns.column[c].count; i++) {
            const gonio_i_observation *o = &columns.column[c].observation[i];
            const double v = value[o->reading * CHANNELS + c];
            const double stated = deviation[o->reading * CHANNELS + c];
            const double s = gonio_log_scale((int)c);
            const double expected = isnan(stated) ? usual_deviation(v) : stated;
            assert_close(o->variance, variance_at(v, expected, s), 1e-12);
        }
    }
    gonio_i_columns_free(&columns);
    gonio_readings_free(&readings);
    gonio_context_free(&context);
}

static gonio_pair swap(gonio_pair p)
{
    return (gonio_pair){p.outgoing, p.incident};
}

/* A transform changes values with their stated deviations, adds what a dark level took, and turns
 * directions only if it says so; the transform that changes nothing gives back what was. */
static void test_transforms(void **state)
{
    (void)state;
    const double deviation[COUNT * CHANNELS] = {0.03, NAN, 0.002, 0.1, 0.1, 0.05};
    const double dark[CHANNELS] = {0.01, 0.02, 0.03};
    const gonio_i_transform nothing = {.factor = 1.0};
    const gonio_i_transform tenth = {
        .factor = 0.1, .by_cosine = true, .by_cosine_i = true, .dark = dark, .change = swap};
    gonio_context *context = support_context();
    gonio_readings *readings = make(context, deviation);
    gonio_i_columns columns = columns_of(context, readings, GONIO_SEPARATE);
    gonio_i_columns as_read = columns_of(context, readings, GONIO_SEPARATE);
    for (size_t c = 0; c < CHANNELS; c++) {
        gonio_i_column *column = &columns.column[c];
        gonio_i_column_transform(readings, &NOISE, &tenth, column);
        for (size_t i = 0; i < column->count; i++) {
            const gonio_i_observation *o = &column->observation[i];
            const gonio_pair at = pair[o->reading];
            const double factor = 0.1 / (cos(at.outgoing.theta) * cos(at.incident.theta));
            const double stated = deviation[o->reading * CHANNELS + c];
            const double v =
                value[o->reading * CHANNELS + c] * factor + dark[c] / cos(at.incident.theta);
            const double expected = isnan(stated) ? usual_deviation(v) : stated * factor;
            const double s = gonio_log_scale((int)c);
            const gonio_half_difference turned = gonio_half_difference_from_pair(swap(at));
            assert_close(o->g, log1p(v / s), 1e-12);
            assert_close(o->variance, variance_at(v, expected, s), 1e-12);
            assert_int_equal(o->bound, as_read.column[c].observation[i].bound);
            assert_memory_equal(&o->at, &turned, sizeof turned);
        }
        for (size_t i = 0; i < column->count; i++) {
            column->observation[i].at = as_read.column[c].observation[i].at;
        }
        gonio_i_column_transform(readings, &NOISE, &nothing, column);
        for (size_t i = 0; i < column->count; i++) {
            assert_memory_equal(&column->observation[i].g, &as_read.column[c].observation[i].g,
                                sizeof(double));
            assert_memory_equal(&column->observation[i].variance,
                                &as_read.column[c].observation[i].variance, sizeof(double));
            assert_memory_equal(&column->observation[i].at, &as_read.column[c].observation[i].at,
                                sizeof(gonio_half_difference));
        }
    }
    gonio_i_columns_free(&columns);
    gonio_i_columns_free(&as_read);
    gonio_readings_free(&readings);
    gonio_context_free(&context);
}

/* The slope of a transform is ln of the change of g for a small change of the value. */
static void test_slopes(void **state)
{
    (void)state;
    const double dark[CHANNELS] = {0.01, 0.02, 0.03};
    const gonio_i_transform transform = {
        .factor = 0.3, .by_cosine = true, .by_cosine_i = true, .merl = true, .dark = dark};
    const double step = 1e-6;
    gonio_context *context = support_context();
    gonio_readings *readings = make(context, NULL);
    for (size_t c = 0; c < CHANNELS; c++) {
        const double v = gonio_readings_value(readings, 0, c);
        double g[2];
        for (int k = 0; k < 2; k++) {
            assert_int_equal(
                gonio_readings_set_value(context, readings, 0, c, v + step * (double)k), GONIO_OK);
            gonio_i_columns columns = columns_of(context, readings, GONIO_SEPARATE);
            gonio_i_column_transform(readings, &NOISE, &transform, &columns.column[c]);
            g[k] = columns.column[c].observation[0].g;
            gonio_i_columns_free(&columns);
        }
        assert_int_equal(gonio_readings_set_value(context, readings, 0, c, v), GONIO_OK);
        assert_close(gonio_i_transform_slope(readings, 0, c, &transform), log((g[1] - g[0]) / step),
                     1e-3);
    }
    gonio_readings_free(&readings);
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values_and_bounds),
        cmocka_unit_test(test_stated_deviations),
        cmocka_unit_test(test_transforms),
        cmocka_unit_test(test_slopes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
