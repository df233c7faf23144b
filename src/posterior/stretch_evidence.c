/* Questions about anisotropy that need no reconstruction: see stretches.h. */
#include "stretches.h"

#include <math.h>
#include <stdlib.h>

#include "../linalg/linalg.h"
#include "stretch_trials.h"

enum { NOTICING_COLUMNS = 3, NOTICING_READINGS = 96, GAIN_PLACES = 128 };

/* ---- sooner ---- */

gonio_status gonio_i_stretches_notice(gonio_context *context,
                                      const gonio_i_oriented_columns *columns, double *odds)
{
    gonio_i_search s;
    gonio_status status =
        gonio_i_search_begin(context, columns, NOTICING_COLUMNS, NOTICING_READINGS, &s);
    gonio_i_trial *trials = gonio_i_allocate(context, GONIO_I_MOST_TRIALS, sizeof *trials);
    status = trials == NULL ? GONIO_ERROR_MEMORY : status;
    if (status == GONIO_OK) {
        size_t count = gonio_i_trials_grid(&s, (gonio_i_stretch){0}, trials);
        for (size_t k = 1; k < GONIO_I_TRIAL_SHARES; k++) {
            const gonio_i_stretch stretch = {.share = gonio_i_trial_shares[k], .symmetry = 2};
            trials[count++] =
                gonio_i_trial_of(stretch, gonio_i_searched_models, GONIO_I_SEARCHED_MODELS);
        }
        trials[count++] =
            gonio_i_trial_of((gonio_i_stretch){0}, gonio_i_trial_models, GONIO_I_TRIAL_MODELS);
        status = gonio_i_trials_score(&s, trials, count);
        double best = -INFINITY;
        for (size_t k = 0; k + 1 < count; k++) {
            best = fmax(best, gonio_i_trial_weight(&trials[k]));
        }
        *odds = best - gonio_i_trial_weight(&trials[count - 1]);
    }
    free(trials);
    gonio_i_search_end(&s);
    return status;
}

/* ---- what more readings would tell ---- */

/* Variance of the difference between a reading and its prediction, and the most that a reading
 * counts. */
static const double PREDICTED_VARIANCE = 0.1 * 0.1;
static const double MOST_GAIN = 3.0;

/* Half the squared difference that a stretch makes at a place, in variances, the mean over azimuths
 * of the grain. c[K]: coefficients; f: scratch [2][K]. */
static double gain_at(const gonio_i_search *s, const double *c, gonio_i_oriented place,
                      double log_ratio, double *f)
{
    const size_t k = s->prior->components;
    double sum = 0.0;
    double mean[2];
    gonio_i_prior_at(s->prior, place.at, 0, &mean[0], f);
    for (size_t p = 0; p < GONIO_I_ROTATIONS; p++) {
        const gonio_i_stretch stretch = {.log_ratio = log_ratio,
                                         .rotation = M_PI * (double)p / GONIO_I_ROTATIONS};
        gonio_i_prior_at(s->prior, gonio_i_stretch_apply(&stretch, place), 0, &mean[1], f + k);
        const double apart = mean[1] + gonio_i_dot(f + k, c, k) - mean[0] - gonio_i_dot(f, c, k);
        sum += fmin(0.5 * apart * apart / PREDICTED_VARIANCE, MOST_GAIN) / GONIO_I_ROTATIONS;
    }
    return sum;
}

/* The coefficients of a column under the isotropic model. */
static gonio_status find_isotropic(gonio_i_search *s, size_t column, double *c)
{
    static const gonio_i_model usual = {1.0, 0.12, 0.0, 0.0};
    gonio_i_sites *sites = NULL;
    gonio_i_fit fit = {0};
    gonio_status status = gonio_i_sites_create(s->context, &s->plain, &s->column[column], &sites);
    if (status == GONIO_OK) {
        status = gonio_i_fit_begin(s->context, sites, true, &s->column[column], &fit);
    }
    if (status == GONIO_OK) {
        status = gonio_i_fit_solve(&fit, &usual);
    }
    if (status == GONIO_OK) {
        gonio_i_fit_coefficients(&fit, c);
    }
    gonio_i_fit_end(&fit);
    gonio_i_sites_free(&sites);
    return status;
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

gonio_status gonio_i_stretches_expect_gain(gonio_context *context,
                                           const gonio_i_oriented_columns *columns,
                                           double log_ratio, double *gain)
{
    gonio_i_search s;
    double at[GAIN_PLACES] = {0.0};
    gonio_i_oriented place[GAIN_PLACES];
    gonio_status status =
        gonio_i_search_begin(context, columns, NOTICING_COLUMNS, NOTICING_READINGS, &s);
    double *c = gonio_i_allocate(context, 3 * columns->prior->components, sizeof *c);
    status = c == NULL ? GONIO_ERROR_MEMORY : status;
    gonio_i_oriented_sample(1, GAIN_PLACES, place);
    for (size_t k = 0; k < s.columns && status == GONIO_OK; k++) {
        status = find_isotropic(&s, k, c);
        for (size_t i = 0; i < GAIN_PLACES && status == GONIO_OK; i++) {
            at[i] += gain_at(&s, c, place[i], log_ratio, c + columns->prior->components);
        }
    }
    qsort(at, GAIN_PLACES, sizeof *at, compare_numbers);
    const size_t half = GAIN_PLACES / 2;
    *gain = 0.0;
    for (size_t i = half; i < GAIN_PLACES; i++) { /* a plan takes the better half */
        *gain += gonio_i_score_share * at[i] / (double)(GAIN_PLACES - half);
    }
    free(c);
    gonio_i_search_end(&s);
    return status;
}

/* ---- readings that cannot tell ---- */

/* Differences of q that show anisotropy. */
static const double SEEN = 0.15;

bool gonio_i_azimuths_are_same(const gonio_i_oriented_columns *columns)
{
    const gonio_i_stretch round = {.symmetry = columns->symmetry > 0 ? columns->symmetry : 2};
    bool same = true;
    for (size_t c = 0; c < columns->count; c++) {
        const gonio_i_column *column = &columns->column[c];
        double phi_h = 0.0;
        double most = 0.0;
        for (size_t i = 0; i < column->count; i++) {
            const gonio_i_oriented here =
                gonio_i_oriented_of(columns->pair[column->observation[i].reading]);
            phi_h = here.at.theta_h > most ? here.phi_h : phi_h;
            most = fmax(most, here.at.theta_h);
        }
        for (size_t i = 0; i < column->count && same; i++) {
            const gonio_i_oriented here =
                gonio_i_oriented_of(columns->pair[column->observation[i].reading]);
            const gonio_i_azimuth_point a = gonio_i_azimuth_of(&round, here);
            const gonio_i_azimuth_point b =
                gonio_i_azimuth_of(&round, (gonio_i_oriented){here.at, phi_h});
            same = hypot(a.x - b.x, a.y - b.y) < SEEN;
        }
    }
    return same;
}

/* ---- ratios ---- */

/* The mean over the azimuths of the grain of the weights of each ratio, were ratios alike. */
static void average_rotations(const gonio_i_trial *trials, size_t count,
                              const gonio_i_trial *isotropic, double *odds)
{
    for (size_t r = 0; r < count; r++) {
        double most = -INFINITY;
        double sum = 0.0;
        for (size_t p = 0; p < GONIO_I_ROTATIONS; p++) {
            most = fmax(most, gonio_i_trial_weight(&trials[r * GONIO_I_ROTATIONS + p]));
        }
        const double prior =
            gonio_i_log_ratio_prior(trials[r * GONIO_I_ROTATIONS].stretch.log_ratio);
        for (size_t p = 0; p < GONIO_I_ROTATIONS; p++) {
            sum += exp(gonio_i_trial_weight(&trials[r * GONIO_I_ROTATIONS + p]) - most) /
                   GONIO_I_ROTATIONS;
        }
        odds[r] =
            most - prior + log(sum) - (gonio_i_trial_weight(isotropic) - gonio_i_for_isotropic);
    }
}

gonio_status gonio_i_stretches_compare_ratios(gonio_context *context,
                                              const gonio_i_oriented_columns *columns,
                                              const double *log_ratios, size_t count, double *odds)
{
    gonio_i_search s;
    gonio_status status =
        gonio_i_search_begin(context, columns, GONIO_I_SEARCH_COLUMNS, GONIO_I_SEARCH_READINGS, &s);
    gonio_i_trial *trials =
        gonio_i_allocate(context, count * GONIO_I_ROTATIONS + 1, sizeof *trials);
    status = trials == NULL ? GONIO_ERROR_MEMORY : status;
    for (size_t k = 0; k < count * GONIO_I_ROTATIONS && status == GONIO_OK; k++) {
        const gonio_i_stretch stretch = {.log_ratio = log_ratios[k / GONIO_I_ROTATIONS],
                                         .rotation = M_PI * (double)(k % GONIO_I_ROTATIONS) /
                                                     GONIO_I_ROTATIONS,
                                         .symmetry = gonio_i_search_symmetry(&s)};
        trials[k] = gonio_i_trial_of(stretch, gonio_i_trial_models, GONIO_I_TRIAL_MODELS);
    }
    if (status == GONIO_OK) {
        trials[count * GONIO_I_ROTATIONS] =
            gonio_i_trial_of((gonio_i_stretch){0}, gonio_i_trial_models, GONIO_I_TRIAL_MODELS);
        status = gonio_i_trials_score(&s, trials, count * GONIO_I_ROTATIONS + 1);
    }
    if (status == GONIO_OK) {
        average_rotations(trials, count, &trials[count * GONIO_I_ROTATIONS], odds);
    }
    free(trials);
    gonio_i_search_end(&s);
    return status;
}
