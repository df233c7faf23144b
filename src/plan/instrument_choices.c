/* The readings that an instrument offers to a plan: see instrument_choices.h. */
#include "instrument_choices.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const gonio_freedom gonio_i_planned_freedom = GONIO_ALL_FREEDOM;

enum { RINGS = 1, MOST_SAMPLES = 7 * 7 };

/* Apertures are averaged over up to this distance from the mirror direction, in units of both half
 * angles together: elsewhere the prior is smooth. */
static const double SMOOTH_FROM = 12.0;

/* A theta_i that differs by less is the same incidence, rad (as in time.c of instruments). */
static const double SAME_INCIDENCE = 0.1 * M_PI / 180.0;

/* A reading that saturates more often than this is not planned. */
static const double MOST_SATURATED = 0.5;

void gonio_i_instrument_choices_free(gonio_i_instrument_choices *i)
{
    i->choices.prior = NULL; /* another's */
    gonio_i_choices_free(&i->choices);
    free(i->setting);
    free(i->variance);
    free(i->incidence);
}

/* ---- the mean over apertures ---- */

static double from_specular(const gonio_pair *pair)
{
    const double cosine = cos(pair->incident.theta) * cos(pair->outgoing.theta) -
                          sin(pair->incident.theta) * sin(pair->outgoing.theta) *
                              cos(pair->outgoing.phi - pair->incident.phi);
    return acos(fmin(fmax(cosine, -1.0), 1.0));
}

/* The directions whose mean a reading is: one, where the prior is smooth. */
static size_t directions_of(const gonio_instrument *instrument, const gonio_pair *pair,
                            gonio_pair *sample)
{
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    const double both = view->source_aperture + view->detector_aperture;
    if (both == 0.0 || from_specular(pair) > SMOOTH_FROM * both) {
        sample[0] = *pair;
        return 1;
    }
    return gonio_instrument_aperture(instrument, *pair, RINGS, sample);
}

/* m and f of a reading. In log space g = ln(mean of exp g_j), whose slope in g_j is exp g_j over
 * the sum: taken at the prior's mean. one[components] and the result f[components] are separate. */
static void average(const gonio_i_prior *prior, const gonio_pair *sample, size_t count, double *one,
                    double *mean, double *f)
{
    const size_t k = prior->components;
    double sum = 0.0;
    memset(f, 0, k * sizeof *f);
    for (size_t j = 0; j < count; j++) {
        double m = 0.0;
        gonio_i_prior_at(prior, gonio_half_difference_from_pair(sample[j]), 0, &m, one);
        const double weight = exp(m);
        sum += weight;
        for (size_t c = 0; c < k; c++) {
            f[c] += weight * one[c];
        }
    }
    for (size_t c = 0; c < k; c++) {
        f[c] /= sum;
    }
    *mean = log(sum / (double)count);
}

/* ---- noise ---- */

/* How often a reading saturates: g is normal with the prior's mean and deviation. */
static double saturated(double saturation, double scale, double mean, double deviation)
{
    if (!isfinite(saturation)) {
        return 0.0;
    }
    const double above = (log1p(saturation / scale) - mean) / fmax(deviation, 1e-9);
    return 0.5 * erfc(above / sqrt(2.0));
}

/* Variance of a reading in log units: that of the model, and the instrument's noise over rho + s.
 * A reading that may saturate tells less. */
static double variance_of(const gonio_instrument *instrument, double model, double mean,
                          double deviation, bool *allowed)
{
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    const double s = gonio_log_scale(0);
    const double rho = s * expm1(fmax(mean, 0.0));
    const double noise = gonio_instrument_deviation(instrument, rho) / (rho + s);
    const double lost = saturated(view->saturation, s, mean, deviation);
    *allowed = lost < MOST_SATURATED;
    return (model * model + noise * noise) / fmax(1.0 - lost, 1.0 - MOST_SATURATED);
}

/* ---- all ---- */

static gonio_status allocate(gonio_i_instrument_choices *i)
{
    gonio_i_choices *p = &i->choices;
    gonio_context *c = p->context;
    p->f = gonio_i_allocate(c, p->rows * p->components, sizeof *p->f);
    p->mean = gonio_i_allocate(c, p->rows, sizeof *p->mean);
    p->allowed = gonio_i_allocate(c, p->rows, sizeof *p->allowed);
    p->at = gonio_i_allocate(c, p->rows, sizeof *p->at);
    i->variance = gonio_i_allocate(c, p->rows, sizeof *i->variance);
    i->incidence = gonio_i_allocate(c, p->rows, sizeof *i->incidence);
    const bool done = p->f && p->mean && p->allowed && p->at && i->variance && i->incidence;
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* One choice; f: scratch, [2][components]. */
static void fill_choice(gonio_i_instrument_choices *i, const gonio_instrument *instrument,
                        size_t row, double *f)
{
    gonio_i_choices *p = &i->choices;
    const size_t k = p->components;
    const gonio_pair *pair = &i->setting[row].pair;
    gonio_pair sample[MOST_SAMPLES];
    const size_t count = directions_of(instrument, pair, sample);
    double square = 0.0;
    average(p->prior, sample, count, f + k, &p->mean[row], f);
    for (size_t c = 0; c < k; c++) {
        p->f[row * k + c] = (float)f[c];
        square += f[c] * f[c];
    }
    p->at[row] = gonio_half_difference_from_pair(*pair);
    i->variance[row] =
        variance_of(instrument, p->noise, p->mean[row], sqrt(square), &p->allowed[row]);
}

static gonio_status fill_choices(gonio_i_instrument_choices *i, const gonio_instrument *instrument)
{
    gonio_i_choices *p = &i->choices;
    bool failed = false;
#pragma omp parallel num_threads(gonio_context_threads(p->context))
    {
        double *f = gonio_i_allocate(p->context, 2 * p->components, sizeof *f);
        if (f == NULL) {
#pragma omp atomic write
            failed = true;
        }
#pragma omp for schedule(dynamic, 64)
        for (size_t row = 0; row < p->rows; row++) {
            if (f != NULL) {
                fill_choice(i, instrument, row, f);
            }
        }
        free(f);
    }
    return failed ? GONIO_ERROR_MEMORY : GONIO_OK;
}

/* Settings are sorted by theta_i. */
static void number_incidences(gonio_i_instrument_choices *i)
{
    double level = -INFINITY;
    i->incidences = 0;
    for (size_t row = 0; row < i->choices.rows; row++) {
        const double theta = i->setting[row].pair.incident.theta;
        if (theta > level + SAME_INCIDENCE) {
            level = theta;
            i->incidences++;
        }
        i->incidence[row] = i->incidences - 1;
    }
}

gonio_status gonio_i_choices_of_instrument(gonio_i_instrument_choices *i,
                                           const gonio_instrument *instrument, size_t most)
{
    gonio_i_choices *p = &i->choices;
    p->components = p->prior->components;
    p->noise = gonio_i_noise_of_readings;
    gonio_status status = gonio_instrument_candidates(
        p->context, instrument, gonio_i_planned_freedom, most, &i->setting, &p->rows);
    if (status == GONIO_OK) {
        status = allocate(i);
    }
    if (status == GONIO_OK) {
        status = fill_choices(i, instrument);
    }
    if (status == GONIO_OK) {
        number_incidences(i);
    }
    if (status == GONIO_OK && p->known != NULL) {
        status = gonio_i_choices_leave_out_read(p);
    }
    if (status == GONIO_OK && gonio_i_choices_count(p) == 0) {
        status = gonio_i_fail(p->context, GONIO_ERROR_DATA,
                              "%s: every reading that can be reached would saturate, or was made "
                              "already",
                              gonio_instrument_describe(instrument)->path);
    }
    return status;
}
