/* How good a completed BRDF is: see score.h. */
#include "score.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/core.h"
#include "metric/metric.h"

enum { WHOLE = GONIO_THETA_H_BINS * GONIO_SLAB_VALUES };
static const double BAND = 1.96; /* standard deviations of the 95 per cent band */

/* Sums over compared values. */
typedef struct sums {
    gonio_i_error_sums errors;
    size_t values, stated, inside;
    double variance; /* of those with a stated deviation, log units squared */
    double norm;     /* the sum of the squares of their predicted logarithms */
} sums;

/* One value: its logarithm, the predicted one and its stated deviation (NaN: none). */
static void add_band(double g, double predicted, double deviation, sums *s)
{
    if (!isnan(deviation)) {
        s->stated++;
        s->inside += fabs(g - predicted) <= BAND * deviation;
        s->variance += deviation * deviation;
        s->norm += predicted * predicted;
    }
}

static gonio_status finish(gonio_context *context, const benchmark_sample *sample, const sums *s,
                           benchmark_score *score)
{
    if (s->values == 0 || !(s->errors.metric[GONIO_E6].reference > 0.0)) {
        return gonio_i_fail(context, GONIO_ERROR_DATA, "%s: nothing to compare",
                            sample->subject->path);
    }
    const bool stated = s->stated > 0;
    score->values = s->values;
    score->error = gonio_i_error_of(&s->errors, (double)s->values);
    score->inside = stated ? (double)s->inside / (double)s->stated : NAN;
    score->expected_here = stated ? 100.0 * sqrt(s->variance / s->norm) : NAN;
    return GONIO_OK;
}

/* ---- the whole of a table ---- */

/* What a completed BRDF is at the centres of all bins: [slab][channel][theta_d][phi_d]. */
typedef struct whole {
    double *value;     /* 1/sr, -1 for no data */
    double *deviation; /* of the log; NULL: none stated */
} whole;

static gonio_status read_slabs(gonio_context *context, const gonio_material *material, double *rho)
{
    gonio_status status = GONIO_OK;
    for (int slab = 0; slab < GONIO_THETA_H_BINS && status == GONIO_OK; slab++) {
        status = gonio_material_read_slab(context, material, slab,
                                          rho + (size_t)slab * GONIO_SLAB_VALUES);
    }
    return status;
}

/* The deviation material holds them in place of rho/s. */
static void unscale(double *deviation)
{
    for (size_t k = 0; k < WHOLE; k++) {
        const int channel = (int)(k / GONIO_SLAB_BINS % GONIO_CHANNELS);
        deviation[k] = deviation[k] >= 0.0 ? deviation[k] / gonio_log_scale(channel) : NAN;
    }
}

static gonio_status take_materials(gonio_context *context, const benchmark_completion *completion,
                                   whole *w)
{
    gonio_material *values = NULL;
    gonio_material *deviations = NULL;
    gonio_status status = completion->materials(completion->self, context, &values, &deviations);
    if (status == GONIO_OK) {
        status = read_slabs(context, values, w->value);
    }
    if (status == GONIO_OK && deviations != NULL) {
        w->deviation = gonio_i_allocate(context, WHOLE, sizeof *w->deviation);
        status = w->deviation != NULL ? read_slabs(context, deviations, w->deviation)
                                      : GONIO_ERROR_MEMORY;
    }
    if (status == GONIO_OK && w->deviation != NULL) {
        unscale(w->deviation);
    }
    gonio_material_free(&values);
    gonio_material_free(&deviations);
    return status;
}

/* The centres of the valid bins, and where their first channel is in the whole. */
static size_t list_centres(gonio_pair *pair, size_t *place)
{
    size_t count = 0;
    for (int32_t k = 0; k < GONIO_BINS; k++) {
        const gonio_bin bin = gonio_bin_from_index(k);
        if (gonio_bin_is_valid(bin)) {
            pair[count] = gonio_pair_from_half_difference(gonio_bin_centre(bin));
            place[count++] = (size_t)bin.theta_h * GONIO_SLAB_VALUES +
                             (size_t)(bin.theta_d * GONIO_PHI_D_BINS + bin.phi_d);
        }
    }
    return count;
}

static gonio_status take_predictions(gonio_context *context, const benchmark_completion *completion,
                                     whole *w)
{
    gonio_pair *pair = gonio_i_allocate(context, GONIO_BINS, sizeof *pair);
    size_t *place = gonio_i_allocate(context, GONIO_BINS, sizeof *place);
    double *values = gonio_i_allocate(context, (size_t)GONIO_BINS * GONIO_CHANNELS, sizeof *values);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (pair != NULL && place != NULL && values != NULL) {
        const size_t count = list_centres(pair, place);
        status = completion->predict(completion->self, context, pair, count, values, NULL);
        for (size_t k = 0; k < WHOLE; k++) {
            w->value[k] = -1.0;
        }
        for (size_t k = 0; k < count * GONIO_CHANNELS && status == GONIO_OK; k++) {
            w->value[place[k / GONIO_CHANNELS] + k % GONIO_CHANNELS * GONIO_SLAB_BINS] =
                values[k] >= 0.0 ? values[k] : -1.0;
        }
    }
    free(pair);
    free(place);
    free(values);
    return status;
}

static gonio_status take_whole(gonio_context *context, const benchmark_completion *completion,
                               whole *w)
{
    *w = (whole){.value = gonio_i_allocate(context, WHOLE, sizeof *w->value)};
    if (w->value == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    return completion->materials != NULL ? take_materials(context, completion, w)
                                         : take_predictions(context, completion, w);
}

/* As a material, which frees the values. */
static gonio_status read_whole(void *self, gonio_context *context, int theta_h, double *rho)
{
    const double *value = self;
    (void)context;
    memcpy(rho, value + (size_t)theta_h * GONIO_SLAB_VALUES, GONIO_SLAB_VALUES * sizeof *rho);
    return GONIO_OK;
}

/* ---- comparing tables ---- */

/* Values of one slab and channel that are compared. */
typedef struct slab_values {
    double *reference, *other, *cosines, *terms; /* terms: [2][bins] */
} slab_values;

/* c_i c_o of each bin of a slab; -1 beyond the reach and below the horizon. */
static void find_cosines(int theta_h, double reach, double *cosines)
{
    const double least = cos(reach);
    for (int k = 0; k < GONIO_SLAB_BINS; k++) {
        const gonio_bin bin = {theta_h, k / GONIO_PHI_D_BINS, k % GONIO_PHI_D_BINS};
        double incident = 0.0;
        double outgoing = 0.0;
        gonio_cosines(gonio_bin_centre(bin), &incident, &outgoing);
        const bool within = gonio_bin_is_valid(bin) && incident > least && outgoing > least;
        cosines[k] = within ? incident * outgoing : -1.0;
    }
}

static void add_channel(const benchmark_sample *sample, const whole *w, const double *cosines,
                        size_t slab, int channel, slab_values *v, sums *s)
{
    const size_t plane = slab * GONIO_SLAB_VALUES + (size_t)channel * GONIO_SLAB_BINS;
    const double *known = gonio_table_values(sample->table);
    const unsigned char *measured = sample->measured + slab * GONIO_SLAB_BINS;
    size_t count = 0;
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        if (cosines[k] >= 0.0 && w->value[plane + k] >= 0.0 && known[plane + k] >= 0.0 &&
            (measured[k] >> channel & 1) != 0) {
            v->reference[count] = known[plane + k];
            v->other[count] = w->value[plane + k];
            v->cosines[count++] = cosines[k];
            add_band(gonio_log_from_brdf(known[plane + k], channel),
                     gonio_log_from_brdf(w->value[plane + k], channel),
                     w->deviation != NULL ? w->deviation[plane + k] : NAN, s);
        }
    }
    const gonio_i_compared values = {count, v->reference, v->other, v->cosines,
                                     gonio_log_scale(channel)};
    gonio_i_error_add_values(&values, v->terms, &s->errors);
    s->values += count;
}

static gonio_status compare_whole(gonio_context *context, const benchmark_sample *sample,
                                  double reach, const whole *w, benchmark_score *score)
{
    double *room = gonio_i_allocate(context, (size_t)6 * GONIO_SLAB_BINS, sizeof *room);
    if (room == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    double *cosines = room + (size_t)5 * GONIO_SLAB_BINS;
    slab_values v = {room, room + GONIO_SLAB_BINS, room + (size_t)2 * GONIO_SLAB_BINS,
                     room + (size_t)3 * GONIO_SLAB_BINS};
    sums s = {0};
    for (int slab = 0; slab < GONIO_THETA_H_BINS; slab++) {
        find_cosines(slab, reach, cosines);
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            add_channel(sample, w, cosines, (size_t)slab, channel, &v, &s);
        }
    }
    free(room);
    return finish(context, sample, &s, score);
}

gonio_status benchmark_score_table(gonio_context *context, const benchmark_sample *sample,
                                   double reach, const benchmark_completion *completion,
                                   benchmark_score *score, gonio_material **made)
{
    whole w = {0};
    gonio_status status = take_whole(context, completion, &w);
    if (status == GONIO_OK) {
        status = compare_whole(context, sample, reach, &w, score);
    }
    if (status == GONIO_OK) {
        const gonio_material_source source = {
            .size = sizeof source, .read_slab = read_whole, .release = free, .self = w.value};
        status = gonio_material_create(context, "made", "completed", &source, made);
    }
    if (status != GONIO_OK) {
        free(w.value);
    }
    free(w.deviation);
    return status;
}

/* ---- comparing readings ---- */

typedef struct predicted {
    size_t count, channels;
    double *value;     /* [count][channels] */
    double *deviation; /* the same; NULL: none stated */
    bool *read;        /* [count]: not compared */
} predicted;

static void free_predicted(predicted *p)
{
    free(p->value);
    free(p->deviation);
    free(p->read);
}

static gonio_status predict(gonio_context *context, const benchmark_sample *sample,
                            const gonio_readings *read, const benchmark_completion *completion,
                            predicted *p)
{
    const gonio_readings_view *view = gonio_readings_describe(sample->known);
    const size_t values = view->count * view->channels;
    *p = (predicted){.count = view->count, .channels = view->channels};
    p->value = gonio_i_allocate(context, values, sizeof *p->value);
    p->read = gonio_i_allocate(context, view->count, sizeof *p->read);
    p->deviation =
        completion->has_deviations ? gonio_i_allocate(context, values, sizeof *p->deviation) : NULL;
    if (p->value == NULL || p->read == NULL || (completion->has_deviations && !p->deviation)) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status = gonio_readings_find(context, sample->known, read, p->read);
    return status == GONIO_OK ? completion->predict(completion->self, context, view->pair,
                                                    view->count, p->value, p->deviation)
                              : status;
}

static void add_readings(const benchmark_sample *sample, const predicted *p, size_t channel,
                         double *room, sums *s)
{
    const gonio_readings_view *view = gonio_readings_describe(sample->known);
    const double scale = gonio_readings_scale(sample->known, channel);
    double *reference = room;
    double *other = room + p->count;
    double *cosines = room + 2 * p->count;
    size_t count = 0;
    for (size_t k = 0; k < p->count; k++) {
        const size_t at = k * p->channels + channel;
        const double rho = view->value[at];
        if (!p->read[k] && !isnan(rho) && p->value[at] >= 0.0) {
            const gonio_pair *pair = &view->pair[k];
            reference[count] = rho;
            other[count] = p->value[at];
            cosines[count++] = fmax(cos(pair->incident.theta) * cos(pair->outgoing.theta), 0.0);
            add_band(log1p(rho / scale), log1p(p->value[at] / scale),
                     p->deviation != NULL ? p->deviation[at] : NAN, s);
        }
    }
    const gonio_i_compared values = {count, reference, other, cosines, scale};
    gonio_i_error_add_values(&values, room + 3 * p->count, &s->errors);
    s->values += count;
}

gonio_status benchmark_score_readings(gonio_context *context, const benchmark_sample *sample,
                                      const gonio_readings *read,
                                      const benchmark_completion *completion,
                                      benchmark_score *score)
{
    predicted p = {0};
    sums s = {0};
    gonio_status status = predict(context, sample, read, completion, &p);
    double *room = gonio_i_allocate(context, 5 * p.count, sizeof *room);
    if (status == GONIO_OK && room == NULL) {
        status = GONIO_ERROR_MEMORY;
    }
    for (size_t c = 0; c < p.channels && status == GONIO_OK; c++) {
        add_readings(sample, &p, c, room, &s);
    }
    free(room);
    free_predicted(&p);
    return status == GONIO_OK ? finish(context, sample, &s, score) : status;
}
