/* The simple method `interpolation`: the mean of the logarithms of all readings, weighted by a
 * power of the inverse distance (Shepard 1968). */
#include "methods.h"

#include <math.h>
#include <stdlib.h>

#include "core/core.h"
#include "logs.h"

/* Distances are Euclidean in (sqrt theta_h, theta_d, s cos 2 phi_d, s sin 2 phi_d), thetas in units
 * of 90 degrees. s = AZIMUTH sqrt theta_h theta_d, so that phi_d counts for nothing where it means
 * nothing; twice phi_d, so that a pair and its reciprocal are the same place. */
enum { PLACE = 4 };
static const double AZIMUTH = 0.25;

typedef struct made {
    size_t count, channels;
    double (*place)[PLACE]; /* [count] */
    double *logs;           /* [count][channels], NaN: not read */
    double *scale;          /* [channels] */
} made;

static void release(void *self)
{
    made *m = self;
    free(m->place);
    free(m->logs);
    free(m->scale);
    free(m);
}

static void place_of(gonio_pair pair, double place[PLACE])
{
    const gonio_half_difference at = gonio_half_difference_from_pair(pair);
    const double h = sqrt(at.theta_h / M_PI_2);
    const double d = at.theta_d / M_PI_2;
    const double s = AZIMUTH * h * d;
    place[0] = h;
    place[1] = d;
    place[2] = s * cos(2.0 * at.phi_d);
    place[3] = s * sin(2.0 * at.phi_d);
}

/* The inverse distance to the fourth power; large where the places are the same. */
static double weight_of(const double a[PLACE], const double b[PLACE])
{
    double square = 1e-10;
    for (int k = 0; k < PLACE; k++) {
        square += (a[k] - b[k]) * (a[k] - b[k]);
    }
    return 1.0 / (square * square);
}

/* sum[channels] and total[channels] are scratch. */
static void interpolate(const made *m, gonio_pair pair, double *sum, double *total, double *value)
{
    double place[PLACE];
    place_of(pair, place);
    for (size_t c = 0; c < m->channels; c++) {
        sum[c] = total[c] = 0.0;
    }
    for (size_t k = 0; k < m->count; k++) {
        const double w = weight_of(place, m->place[k]);
        for (size_t c = 0; c < m->channels; c++) {
            const double g = m->logs[k * m->channels + c];
            sum[c] += isnan(g) ? 0.0 : w * g;
            total[c] += isnan(g) ? 0.0 : w;
        }
    }
    for (size_t c = 0; c < m->channels; c++) {
        value[c] = total[c] > 0.0 ? m->scale[c] * expm1(sum[c] / total[c]) : NAN;
    }
}

static gonio_status predict(void *self, gonio_context *context, const gonio_pair *pair,
                            size_t count, double *values, double *deviations)
{
    const made *m = self;
    double *scratch = gonio_i_allocate(context, 2 * m->channels, sizeof *scratch);
    (void)deviations;
    if (scratch == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < count; k++) {
        interpolate(m, pair[k], scratch, scratch + m->channels, values + k * m->channels);
    }
    free(scratch);
    return GONIO_OK;
}

static gonio_status prepare(gonio_context *context, const gonio_readings *readings, made *m)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    m->count = view->count;
    m->channels = view->channels;
    m->place = gonio_i_allocate(context, m->count, sizeof *m->place);
    m->scale = gonio_i_allocate(context, m->channels, sizeof *m->scale);
    if (m->place == NULL || m->scale == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < m->count; k++) {
        place_of(view->pair[k], m->place[k]);
    }
    for (size_t c = 0; c < m->channels; c++) {
        m->scale[c] = gonio_readings_scale(readings, c);
    }
    return benchmark_logs(context, readings, &m->logs);
}

static gonio_status complete(gonio_context *context, const benchmark_task *task,
                             benchmark_completion *completion)
{
    made *m = gonio_i_allocate(context, 1, sizeof *m);
    const gonio_status status =
        m != NULL ? prepare(context, task->readings, m) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        *completion = (benchmark_completion){
            .self = m, .release = release, .predict = predict, .expected = NAN};
    } else if (m != NULL) {
        release(m);
    }
    return status;
}

const benchmark_method benchmark_interpolation = {
    .name = "interpolation",
    .summary = "inverse-distance interpolation of logarithms in half and difference angles",
    .simple = true,
    .complete = complete};
