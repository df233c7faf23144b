/* Readings through apertures: see gonio_reconstruct_aperture.
 *
 * A reading is the mean of the BRDF over both apertures, and what is looked for is g = ln(1 + f/s).
 * About a reconstruction g0 with f0 at directions k of the apertures, the logarithm of a mean is
 *
 *     ln(1 + mean f/s) = ln(1 + mean f0/s) + sum w_k (g_k - g0_k),   w_k ~ f0_k,
 *
 * so that a reading less an offset is a weighted mean of g: its row of the basis is that of rows. A
 * few rounds (Gauss-Newton) find the reconstruction about which this holds. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/options.h"
#include "../instrument/instrument.h"
#include "../measurement/readings.h"
#include "method.h"

enum { ROUNDS = 8 };

/* Offsets that change by less, in log units, are final. */
static const double FINAL = 0.01;

/* What is known of the apertures, and of the readings through them. */
typedef struct deconvolution {
    gonio_context *context;
    const gonio_basis *basis;
    const gonio_readings *readings;
    gonio_reconstruct_options options;
    double source, detector;   /* half angles, radians */
    int rings;                 /* of directions in each aperture */
    size_t samples;            /* directions in both apertures, at most */
    gonio_pair *pair;          /* [samples]: scratch */
    double *value;             /* [samples][channels]: scratch */
    gonio_half_difference *at; /* [count][samples] */
    double *weight;            /* [count][samples] */
    gonio_i_spread *spread;    /* [count] */
    double *offset;            /* [count][channels] */
    double change;             /* largest, of an offset in a round */
} deconvolution;

/* Fills in the BRDF over the apertures of a reading, and the weights: value and weight. */
static size_t look(deconvolution *d, const gonio_reconstruction *made, size_t reading)
{
    const size_t channels = d->readings->channels;
    gonio_half_difference *at = d->at + reading * d->samples;
    double *weight = d->weight + reading * d->samples;
    double sum = 0.0;
    const size_t count =
        gonio_i_aperture(d->source, d->detector, d->readings->pair[reading], d->rings, d->pair);
    for (size_t k = 0; k < count; k++) {
        double *value = d->value + k * channels;
        at[k] = gonio_half_difference_from_pair(d->pair[k]);
        gonio_reconstruction_predict(d->basis, made, at[k], value, NULL);
        weight[k] = 1e-12;
        for (size_t c = 0; c < channels; c++) {
            weight[k] += value[c];
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

/* One round: a reconstruction without deviations, about which apertures are linear next. */
static gonio_status improve(deconvolution *d, bool first)
{
    const gonio_i_apertures apertures = {d->spread, d->offset};
    gonio_reconstruct_options how = d->options;
    gonio_reconstruction *made = NULL;
    how.deviation = false;
    how.no_checks = true;
    gonio_status status = gonio_i_reconstruct(d->context, d->basis, d->readings, &how,
                                              first ? NULL : &apertures, &made);
    if (status == GONIO_OK && made->field == NULL) {
        status = gonio_i_fail(d->context, GONIO_ERROR_ARGUMENT,
                              "apertures need a reconstruction by posterior");
    }
    if (status == GONIO_OK) {
        look_at_all(d, made);
    }
    gonio_reconstruction_free(&made);
    return status;
}

static gonio_status begin(deconvolution *d)
{
    const size_t count = d->readings->count;
    const size_t channels = d->readings->channels;
    const size_t each =
        1 + (size_t)(3 * GONIO_MOST_APERTURE_RINGS * (GONIO_MOST_APERTURE_RINGS + 1));
    d->rings = d->source > 0.0 && d->detector > 0.0 ? 2 : GONIO_MOST_APERTURE_RINGS;
    d->samples = d->rings == 2 ? (size_t)19 * 19 : each;
    d->pair = gonio_i_allocate(d->context, each * each, sizeof *d->pair);
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

static gonio_status solve(deconvolution *d, gonio_reconstruction **reconstruction)
{
    gonio_status status = begin(d);
    d->change = INFINITY;
    for (int round = 0; round < ROUNDS && d->change > FINAL && status == GONIO_OK; round++) {
        status = improve(d, round == 0);
    }
    const gonio_i_apertures last = {d->spread, d->offset};
    return status == GONIO_OK ? gonio_i_reconstruct(d->context, d->basis, d->readings, &d->options,
                                                    &last, reconstruction)
                              : status;
}

gonio_status gonio_reconstruct_aperture(gonio_context *context, const gonio_basis *basis,
                                        const gonio_readings *readings,
                                        const gonio_reconstruct_options *options, double source,
                                        double detector, gonio_reconstruction **reconstruction)
{
    deconvolution d = {.context = context,
                       .basis = basis,
                       .readings = readings,
                       .source = source,
                       .detector = detector};
    gonio_status status = GONIO_I_TAKE(context, gonio_reconstruct_options, options, &d.options);
    if (status == GONIO_OK &&
        !(source >= 0.0 && source < M_PI / 4.0 && detector >= 0.0 && detector < M_PI / 4.0)) {
        status = gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                              "half angles of apertures must be 0 to 45 degrees");
    }
    if (status == GONIO_OK) {
        status = solve(&d, reconstruction);
    }
    end(&d);
    return status;
}
