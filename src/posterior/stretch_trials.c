/* Trials of stretches: see stretch_trials.h. */
#include "stretch_trials.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "leave_one_out.h"

/* The grid of the search. */
enum { RATIOS = 5 };
static const double LOG_RATIOS[RATIOS] = {0.35, 0.7, 1.1, 1.6, 2.2};
static const double SEARCHED_SHARE = 0.1;

const double gonio_i_trial_shares[GONIO_I_TRIAL_SHARES] = {0.0, 0.03, 0.1, 0.3, 1.0};

const gonio_i_model gonio_i_trial_models[GONIO_I_TRIAL_MODELS] = {
    {1.0, 0.0, 0.0, 0.0},  {1.0, 0.03, 0.0, 0.0}, {1.0, 0.06, 0.0, 0.0}, {1.0, 0.12, 0.0, 0.0},
    {1.0, 0.25, 0.0, 0.0}, {1.0, 0.25, 8.0, 0.0}, {1.0, 0.5, 0.0, 0.0},  {1.0, 0.5, 8.0, 0.0},
    {1.0, 1.0, 0.0, 0.0},  {1.0, 1.0, 8.0, 0.0}};

const gonio_i_model gonio_i_searched_models[GONIO_I_SEARCHED_MODELS] = {{1.0, 0.12, 0.0, 0.0},
                                                                        {1.0, 0.5, 0.0, 0.0}};

/* Of fibres, with all that depends on azimuths in the remainder. */
static const gonio_i_model fibre_models[GONIO_I_SEARCHED_MODELS] = {{1.0, 0.5, 0.0, 0.0},
                                                                    {1.0, 1.0, 0.0, 0.0}};

const double gonio_i_score_share = 1.0 / 8.0;
const double gonio_i_for_isotropic = 2.0;

/* As in models.c: the log prior ratio of a plain Gaussian, and the alpha that is none. */
static const double FOR_PLAIN = 2.0 / 3.0;
static const double LEAST_ALPHA = 0.03;

/* ---- begin and end ---- */

gonio_status gonio_i_search_begin(gonio_context *context, const gonio_i_oriented_columns *columns,
                                  size_t most_columns, size_t most_readings, gonio_i_search *s)
{
    *s = (gonio_i_search){.context = context,
                          .prior = columns->prior,
                          .plain = *columns->prior,
                          .pair = columns->pair,
                          .symmetry = columns->symmetry,
                          .steps = {.task = NULL}};
    s->plain.samples = 0;
    gonio_status status = GONIO_OK;
    const size_t count = columns->count < most_columns ? columns->count : most_columns;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        const gonio_i_column *column = &columns->column[k * columns->count / count];
        s->h = k == 0 ? gonio_i_kernel_width(column->count) : s->h;
        status = gonio_i_thin_copy(context, column, most_readings, &s->column[k]);
        s->columns = k + 1;
    }
    return status;
}

void gonio_i_search_end(gonio_i_search *s)
{
    for (size_t k = 0; k < s->columns; k++) {
        free(s->column[k].observation);
    }
}

/* ---- scores ---- */

/* ln of what the density of readings is multiplied by where they are made those of an isotropic
 * material. */
static double log_slopes(const gonio_i_search *s, const gonio_i_column *column,
                         const gonio_i_stretch *stretch)
{
    double sum = 0.0;
    for (size_t i = 0; i < column->count && stretch->facets; i++) {
        const gonio_i_observation *o = &column->observation[i];
        sum += o->bound == 0 ? log(gonio_i_stretched_slope(o, s->pair, stretch)) : 0.0;
    }
    return sum;
}

static gonio_status score_column(const gonio_i_search *s, gonio_context *context,
                                 const gonio_i_sites *sites, const gonio_i_column *column,
                                 gonio_i_trial *t)
{
    gonio_i_fit fit = {0};
    gonio_i_column there = {0};
    const double slopes = log_slopes(s, column, &t->stretch);
    double *score = gonio_i_allocate(context, column->count, sizeof *score);
    bool plain = true;
    for (size_t m = 0; m < t->count; m++) {
        plain = plain && t->model[m].h >= 1.0;
    }
    gonio_status status =
        score == NULL ? GONIO_ERROR_MEMORY
                      : gonio_i_stretched_column(context, column, s->pair, &t->stretch, &there);
    if (status == GONIO_OK) {
        status = gonio_i_fit_begin(context, sites, plain, &there, &fit);
    }
    for (size_t m = 0; m < t->count && status == GONIO_OK; m++) {
        status = gonio_i_leave_one_out_score(&fit, &t->model[m], score);
        t->score[m] += slopes;
        for (size_t i = 0; i < column->count && status == GONIO_OK; i++) {
            t->score[m] += score[i];
        }
    }
    gonio_i_fit_end(&fit);
    free(there.observation);
    free(score);
    return status;
}

static gonio_status score_trial(void *data, gonio_context *context, size_t k)
{
    const gonio_i_search *s = data;
    gonio_i_trial *t = &s->trial[k];
    bool plain = true;
    for (size_t m = 0; m < t->count; m++) {
        plain = plain && t->model[m].h >= 1.0;
        t->score[m] = 0.0;
    }
    const gonio_i_prior *prior = plain ? &s->plain : s->prior;
    gonio_i_sites *sites = NULL;
    gonio_status status = GONIO_OK;
    for (size_t c = 0; c < s->columns && status == GONIO_OK; c++) {
        if (c == 0 || !gonio_i_columns_are_same(&s->column[c - 1], &s->column[c])) {
            gonio_i_sites_free(&sites);
            status = gonio_i_stretched_sites_create(context, prior, &s->column[c], s->pair,
                                                    &t->stretch, &sites);
        }
        if (status == GONIO_OK) {
            status = score_column(s, context, sites, &s->column[c], t);
        }
    }
    gonio_i_sites_free(&sites);
    return status;
}

gonio_status gonio_i_trials_score(gonio_i_search *s, gonio_i_trial *trials, size_t count)
{
    s->trial = trials;
    s->steps.all += count;
    return gonio_i_parallel_for(s->context, &s->steps, count, score_trial, s);
}

/* The log prior of a model, in the unit of weights. */
static double log_prior(const gonio_i_model *model)
{
    const double alpha = fmax(model->alpha, LEAST_ALPHA);
    return -gonio_i_score_share * GONIO_I_FOR_REMAINDERS * log(alpha / LEAST_ALPHA) -
           (model->h < 1.0 ? 0.0 : FOR_PLAIN);
}

double gonio_i_log_ratio_prior(double log_ratio)
{
    return log_ratio > 0.0 ? log(log_ratio) + 0.5 * (1.0 - log_ratio * log_ratio) : 0.0;
}

double gonio_i_trial_model_weight(const gonio_i_trial *t, size_t m)
{
    return gonio_i_score_share * t->score[m] + log_prior(&t->model[m]) +
           gonio_i_log_ratio_prior(t->stretch.log_ratio) +
           (gonio_i_stretch_is_isotropic(&t->stretch) ? gonio_i_for_isotropic : 0.0);
}

size_t gonio_i_trial_best(const gonio_i_trial *t)
{
    size_t best = 0;
    for (size_t m = 1; m < t->count; m++) {
        best = gonio_i_trial_model_weight(t, m) > gonio_i_trial_model_weight(t, best) ? m : best;
    }
    return best;
}

double gonio_i_trial_weight(const gonio_i_trial *t)
{
    return gonio_i_trial_model_weight(t, gonio_i_trial_best(t));
}

gonio_i_trial gonio_i_trial_of(gonio_i_stretch stretch, const gonio_i_model *models, size_t count)
{
    gonio_i_trial t = {.stretch = stretch, .count = count};
    memcpy(t.model, models, count * sizeof *models);
    return t;
}

/* ---- the grid ---- */

int gonio_i_search_symmetry(const gonio_i_search *s)
{
    return s->symmetry > 0 && s->symmetry < 2 ? s->symmetry : 2;
}

/* A fibre's reflection is not the same after half a turn, unless that is stated: it may be tilted.
 */
static int symmetry_of(const gonio_i_search *s, const gonio_i_stretch *kind)
{
    return kind->fibres && s->symmetry == 0 ? 1 : gonio_i_search_symmetry(s);
}

size_t gonio_i_trials_grid(const gonio_i_search *s, gonio_i_stretch kind, gonio_i_trial *trials)
{
    const gonio_i_model *models = kind.fibres ? fibre_models : gonio_i_searched_models;
    const int symmetry = symmetry_of(s, &kind);
    const size_t ratios = s->symmetry == 4 || (kind.mirrored && symmetry != 2) ? 0 : RATIOS;
    size_t count = 0;
    for (size_t r = 0; r < ratios; r++) {
        for (size_t p = 0; p < GONIO_I_ROTATIONS; p++) {
            gonio_i_stretch stretch = kind;
            stretch.log_ratio = LOG_RATIOS[r];
            stretch.rotation = M_PI * (double)p / GONIO_I_ROTATIONS;
            stretch.share = kind.fibres ? 0.0 : SEARCHED_SHARE;
            stretch.symmetry = symmetry;
            trials[count++] = gonio_i_trial_of(stretch, models, GONIO_I_SEARCHED_MODELS);
        }
    }
    return count;
}
