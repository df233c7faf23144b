/* Readings through apertures.
 *
 * A reading is the mean of the BRDF over both apertures, and what is looked for is g = ln(1 + f/s).
 * About a reconstruction g0 with f0 at directions k of the apertures, the logarithm of a mean is
 *
 *     ln(1 + mean f/s) = ln(1 + mean f0/s) + sum w_k (g_k - g0_k),   w_k ~ f0_k + s,
 *
 * so that a reading less an offset is a weighted mean of g: its row of the basis is that of rows. A
 * few rounds (Gauss-Newton) find the reconstruction about which this holds. */
#include <math.h>
#include <stdlib.h>

#include "../instrument/instrument.h"
#include "../measurement/readings.h"
#include "method.h"

enum { ROUNDS = 8 };

/* Offsets that change by less, in log units, are final. */
static const double FINAL = 0.01;

/* More readings get fewer directions each, so that memory and time stay within bounds. */
enum { MANY = 3000 };

/* An aperture that is smaller than this share of the other only widens it. */
static const double SMALL = 0.25;

/* What is known of the apertures, and of the readings through them. */
typedef struct deconvolution {
    gonio_context *context;
    const gonio_basis *basis;
    const gonio_readings *readings;
    gonio_i_aperture source, detector;
    size_t samples;            /* directions in both apertures, at most */
    gonio_pair *pair;          /* [samples]: scratch */
    double *value;             /* [samples][channels]: scratch */
    gonio_half_difference *at; /* [count][samples] */
    double *weight;            /* [count][samples] */
    gonio_i_spread *spread;    /* [count] */
    double *offset;            /* [count][channels] */
    double change;             /* largest, of an offset in a round */
} deconvolution;

bool gonio_i_has_apertures(const gonio_reconstruct_options *options)
{
    return options->source_aperture > 0.0 || options->detector_aperture > 0.0;
}

gonio_status gonio_i_check_half_angles(gonio_context *context,
                                       const gonio_reconstruct_options *options)
{
    const double half_angle[2] = {options->source_aperture, options->detector_aperture};
    for (int k = 0; k < 2; k++) {
        if (!(half_angle[k] >= 0.0 && half_angle[k] < 0.25 * M_PI)) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                "half angles of apertures must be from 0 to below 45 degrees");
        }
    }
    return GONIO_OK;
}

/* ---- about a reconstruction ---- */

/* Fills in the BRDF over the apertures of a reading, and the weights, of all channels together:
 * value and weight. */
static size_t look(deconvolution *d, const gonio_reconstruction *made, size_t reading)
{
    const size_t channels = d->readings->channels;
    gonio_half_difference *at = d->at + reading * d->samples;
    double *weight = d->weight + reading * d->samples;
    double sum = 0.0;
    const size_t count =
        gonio_i_through_apertures(d->source, d->detector, d->readings->pair[reading], d->pair);
    for (size_t k = 0; k < count; k++) {
        double *value = d->value + k * channels;
        at[k] = gonio_half_difference_from_pair(d->pair[k]);
        gonio_reconstruction_predict(d->basis, made, at[k], value, NULL);
        weight[k] = 0.0;
        for (size_t c = 0; c < channels; c++) {
            weight[k] += value[c] + gonio_readings_scale(d->readings, c);
        }
        sum += weight[k];
    }
    for (size_t k = 0; k < count; k++) {
        weight[k] /= sum;
    }
    d->spread[reading] = (gonio_i_spread){count, at, weight};
    return count;
}

/* ln(1 + mean f/s) less the weighted mean of ln(1 + f/s). */
static double offset_of(const deconvolution *d, size_t reading, size_t channel, size_t count)
{
    const size_t channels = d->readings->channels;
    const double s = gonio_readings_scale(d->readings, channel);
    const double *weight = d->weight + reading * d->samples;
    double mean = 0.0;
    double logs = 0.0;
    for (size_t k = 0; k < count; k++) {
        const double value = d->value[k * channels + channel];
        mean += value / (double)count;
        logs += weight[k] * log1p(value / s);
    }
    return log1p(mean / s) - logs;
}

static void look_at_all(deconvolution *d, const gonio_reconstruction *made)
{
    const size_t channels = d->readings->channels;
    d->change = 0.0;
    for (size_t k = 0; k < d->readings->count; k++) {
        const size_t count = look(d, made, k);
        for (size_t c = 0; c < channels; c++) {
            const double offset = offset_of(d, k, c, count);
            d->change = fmax(d->change, fabs(offset - d->offset[k * channels + c]));
            d->offset[k * channels + c] = offset;
        }
    }
}

/* ---- rounds ---- */

/* One round: a reconstruction without deviations, about which apertures are linear next. */
static gonio_status improve(deconvolution *d, const gonio_i_reconstruct_task *rough)
{
    gonio_reconstruction *made = NULL;
    const gonio_status status = rough->method->from_readings(rough, d->readings, &made);
    if (status == GONIO_OK) {
        look_at_all(d, made);
    }
    gonio_reconstruction_free(&made);
    return status;
}

static gonio_status solve(deconvolution *d, const gonio_i_reconstruct_task *task)
{
    const gonio_i_apertures apertures = {d->spread, d->offset};
    gonio_reconstruct_options plain = *task->options;
    plain.no_checks = true;
    plain.deviation = false;
    gonio_i_reconstruct_task rough = *task;
    rough.options = &plain;
    gonio_status status = GONIO_OK;
    d->change = INFINITY;
    for (int round = 0; round < ROUNDS && d->change > FINAL && status == GONIO_OK; round++) {
        status = improve(d, &rough);
        rough.apertures = &apertures;
    }
    return status;
}

/* ---- the apertures ---- */

/* Two apertures of about the same size are both covered; of others, the larger one that is wider by
 * the smaller. */
static void cover(deconvolution *d, double source, double detector)
{
    const bool many = d->readings->count > MANY;
    const bool by_source = source > detector;
    gonio_i_aperture large = {by_source ? source : detector, many ? 2 : 4};
    gonio_i_aperture small = {by_source ? detector : source, many ? 1 : 2};
    if (small.half_angle > SMALL * large.half_angle) {
        large.rings = many ? 1 : 2;
    } else {
        large.half_angle = hypot(large.half_angle, small.half_angle);
        small.half_angle = 0.0;
    }
    d->source = by_source ? large : small;
    d->detector = by_source ? small : large;
    d->samples = gonio_i_aperture_directions(large) * gonio_i_aperture_directions(small);
}

static gonio_status begin(deconvolution *d)
{
    const size_t count = d->readings->count;
    const size_t channels = d->readings->channels;
    d->pair = gonio_i_allocate(d->context, d->samples, sizeof *d->pair);
    d->value = gonio_i_allocate(d->context, d->samples * channels, sizeof *d->value);
    d->at = gonio_i_allocate(d->context, count * d->samples, sizeof *d->at);
    d->weight = gonio_i_allocate(d->context, count * d->samples, sizeof *d->weight);
    d->spread = gonio_i_allocate(d->context, count, sizeof *d->spread);
    d->offset = gonio_i_allocate(d->context, count * channels, sizeof *d->offset);
    const bool done = d->pair && d->value && d->at && d->weight && d->spread && d->offset;
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static void end(deconvolution *d)
{
    free(d->pair);
    free(d->value);
    free(d->at);
    free(d->weight);
    free(d->spread);
    free(d->offset);
}

gonio_status gonio_i_find_apertures(const gonio_i_reconstruct_task *task,
                                    const gonio_readings *readings, gonio_i_apertures_use *use,
                                    void *data)
{
    deconvolution d = {.context = task->context, .basis = task->basis, .readings = readings};
    cover(&d, task->options->source_aperture, task->options->detector_aperture);
    gonio_status status = begin(&d);
    if (status == GONIO_OK) {
        status = solve(&d, task);
    }
    if (status == GONIO_OK) {
        const gonio_i_apertures apertures = {d.spread, d.offset};
        status = use(data, &apertures);
    }
    end(&d);
    return status;
}

/* ---- a reconstruction ---- */

typedef struct final_task {
    const gonio_i_reconstruct_task *task;
    const gonio_readings *readings;
    gonio_reconstruction **reconstruction;
} final_task;

static gonio_status reconstruct_with(void *data, const gonio_i_apertures *apertures)
{
    const final_task *f = data;
    gonio_reconstruct_options unchecked = *f->task->options;
    unchecked.no_checks = true;
    gonio_i_reconstruct_task last = *f->task;
    last.options = &unchecked;
    last.apertures = apertures;
    return last.method->from_readings(&last, f->readings, f->reconstruction);
}

gonio_status gonio_i_reconstruct_apertures(const gonio_i_reconstruct_task *task,
                                           const gonio_readings *readings,
                                           gonio_reconstruction **reconstruction)
{
    final_task last = {task, readings, reconstruction};
    return gonio_i_find_apertures(task, readings, reconstruct_with, &last);
}
