/* The search for stretches and their weights: see stretches.h. */
#include "stretches.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "leave_one_out.h"
#include "parallel_for.h"

enum {
    MOST_COLUMNS = 8,
    MOST_READINGS = 192,
    NOTICING_COLUMNS = 3,
    NOTICING_READINGS = 96,
    GAIN_PLACES = 128,
    RATIOS = 5,
    ROTATIONS = 8,
    MOST_MODELS = 10,
    MOST_TRIALS = 64,
    NEIGHBOURS = 6, /* stretches beside the best that are weighed too */
    BEST_MIXED = 3, /* models that are tried as mixtures too */
    REFINEMENTS = 7,
    MOST_POOL = 256,
};

/* The grid of the search. */
static const double LOG_RATIOS[RATIOS] = {0.35, 0.7, 1.1, 1.6, 2.2};

/* Shares of the isotropic covariance that depend on the azimuth. */
static const double SHARES[] = {0.0, 0.03, 0.1, 0.3};
enum { ALL_SHARES = sizeof SHARES / sizeof *SHARES };
static const double SEARCHED_SHARE = 0.1;

/* Remainders, as in models.c. */
static const gonio_i_model MODELS[MOST_MODELS] = {
    {1.0, 0.0, 0.0},  {1.0, 0.03, 0.0}, {1.0, 0.06, 0.0}, {1.0, 0.12, 0.0}, {1.0, 0.25, 0.0},
    {1.0, 0.25, 8.0}, {1.0, 0.5, 0.0},  {1.0, 0.5, 8.0},  {1.0, 1.0, 0.0},  {1.0, 1.0, 8.0}};

/* The models of the search over the grid. */
static const gonio_i_model SEARCHED[] = {{1.0, 0.12, 0.0}, {1.0, 0.5, 0.0}};
enum { SEARCHED_MODELS = sizeof SEARCHED / sizeof *SEARCHED };

/* As in models.c: the share of a score that counts, and the log prior ratio of a plain Gaussian. */
static const double SHARE = 1.0 / 8.0;
static const double FOR_PLAIN = 2.0 / 3.0;
static const double LEAST_ALPHA = 0.03;
static const double NEGLIGIBLE = 0.02;

/* The log prior ratio of an isotropic material. Stretches that are chosen to suit the readings of
 * an isotropic material gain up to half of it. */
static const double FOR_ISOTROPIC = 2.0;

/* A stretch, and the scores of models under it. */
typedef struct trial {
    gonio_i_stretch stretch;
    size_t count;
    gonio_i_model model[MOST_MODELS];
    double score[MOST_MODELS];
} trial;

/* The columns that are scored, thinned. */
typedef struct search {
    gonio_context *context;
    const gonio_i_prior *prior;
    gonio_i_prior plain; /* the same without samples */
    const gonio_pair *pair;
    size_t columns;
    gonio_i_column column[MOST_COLUMNS];
    double h; /* of mixtures */
    int symmetry;
    gonio_i_steps steps;
    trial *trial; /* those of the present round */
    gonio_i_hypothesis *pool;
    size_t pooled;
} search;

/* ---- scores ---- */

static gonio_status score_column(gonio_context *context, const gonio_i_sites *sites,
                                 const gonio_i_column *column, trial *t)
{
    gonio_i_fit fit = {0};
    double *score = gonio_i_allocate(context, column->count, sizeof *score);
    bool plain = true;
    for (size_t m = 0; m < t->count; m++) {
        plain = plain && t->model[m].h >= 1.0;
    }
    gonio_status status =
        score == NULL ? GONIO_ERROR_MEMORY : gonio_i_fit_begin(context, sites, plain, column, &fit);
    for (size_t m = 0; m < t->count && status == GONIO_OK; m++) {
        status = gonio_i_leave_one_out_score(&fit, &t->model[m], score);
        for (size_t i = 0; i < column->count && status == GONIO_OK; i++) {
            t->score[m] += score[i];
        }
    }
    gonio_i_fit_end(&fit);
    free(score);
    return status;
}

static gonio_status score_trial(void *data, gonio_context *context, size_t k)
{
    const search *s = data;
    trial *t = &s->trial[k];
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
            status = score_column(context, sites, &s->column[c], t);
        }
    }
    gonio_i_sites_free(&sites);
    return status;
}

static gonio_status score_trials(search *s, trial *trials, size_t count)
{
    s->trial = trials;
    s->steps.all += count;
    return gonio_i_parallel_for(s->context, &s->steps, count, score_trial, s);
}

/* The log prior of a model, in the unit of weights. */
static double log_prior(const gonio_i_model *model)
{
    const double alpha = fmax(model->alpha, LEAST_ALPHA);
    return -SHARE * GONIO_I_FOR_REMAINDERS * log(alpha / LEAST_ALPHA) -
           (model->h < 1.0 ? 0.0 : FOR_PLAIN);
}

static double log_weight(const trial *t, size_t m)
{
    return SHARE * t->score[m] + log_prior(&t->model[m]) +
           (gonio_i_stretch_is_isotropic(&t->stretch) ? FOR_ISOTROPIC : 0.0);
}

static size_t best_model(const trial *t)
{
    size_t best = 0;
    for (size_t m = 1; m < t->count; m++) {
        best = log_weight(t, m) > log_weight(t, best) ? m : best;
    }
    return best;
}

static double best_weight(const trial *t)
{
    return log_weight(t, best_model(t));
}

static trial trial_of(gonio_i_stretch stretch, const gonio_i_model *models, size_t count)
{
    trial t = {.stretch = stretch, .count = count};
    memcpy(t.model, models, count * sizeof *models);
    return t;
}

/* ---- the pool of hypotheses ---- */

static void add_to_pool(search *s, const trial *t)
{
    for (size_t m = 0; m < t->count && s->pooled < MOST_POOL; m++) {
        s->pool[s->pooled++] = (gonio_i_hypothesis){t->stretch, t->model[m], log_weight(t, m)};
    }
}

static int compare_hypotheses(const void *a, const void *b)
{
    const gonio_i_hypothesis *x = a;
    const gonio_i_hypothesis *y = b;
    return (x->weight < y->weight) - (x->weight > y->weight);
}

static void swap_if_better(gonio_i_hypothesis *a, size_t i)
{
    for (; i > 0 && compare_hypotheses(&a[i - 1], &a[i]) > 0; i--) {
        const gonio_i_hypothesis held = a[i];
        a[i] = a[i - 1];
        a[i - 1] = held;
    }
}

/* Stable, so that equal ones keep their order. */
static void sort_pool(search *s)
{
    for (size_t i = 1; i < s->pooled; i++) {
        swap_if_better(s->pool, i);
    }
}

/* ---- rounds of the search ---- */

/* The symmetry that kappa has beside an elliptical stretch. */
static int stretch_symmetry(const search *s)
{
    return s->symmetry > 0 && s->symmetry < 2 ? s->symmetry : 2;
}

/* trials[MOST_TRIALS]: the grid of ratios and azimuths. A quarter turn's symmetry has none. */
static size_t list_grid(const search *s, trial *trials)
{
    size_t count = 0;
    for (size_t r = 0; r < RATIOS && s->symmetry != 4; r++) {
        for (size_t p = 0; p < ROTATIONS; p++) {
            const gonio_i_stretch stretch = {LOG_RATIOS[r], M_PI * (double)p / ROTATIONS,
                                             SEARCHED_SHARE, stretch_symmetry(s)};
            trials[count++] = trial_of(stretch, SEARCHED, SEARCHED_MODELS);
        }
    }
    return count;
}

static double wrapped(double rotation)
{
    const double folded = fmod(rotation, M_PI);
    return folded < 0.0 ? folded + M_PI : folded;
}

/* A step in the ratio or in the azimuth; the ratio of the axes stays at least 1. */
static gonio_i_stretch moved(gonio_i_stretch from, double ratio, double rotation)
{
    gonio_i_stretch to = from;
    to.log_ratio = fabs(from.log_ratio + ratio);
    to.rotation = wrapped(from.rotation + rotation);
    return to;
}

/* Steps around the best trial, which become smaller where none is better. */
static gonio_status refine(search *s, trial *best)
{
    double ratio = 0.2;
    double rotation = 0.5 * M_PI / ROTATIONS;
    gonio_status status = GONIO_OK;
    for (int k = 0; k < REFINEMENTS && status == GONIO_OK; k++) {
        const gonio_i_model model = best->model[best_model(best)];
        trial around[] = {trial_of(moved(best->stretch, ratio, 0.0), &model, 1),
                          trial_of(moved(best->stretch, -ratio, 0.0), &model, 1),
                          trial_of(moved(best->stretch, 0.0, rotation), &model, 1),
                          trial_of(moved(best->stretch, 0.0, -rotation), &model, 1)};
        const size_t count = sizeof around / sizeof *around;
        const double before = best_weight(best);
        status = score_trials(s, around, count);
        for (size_t i = 0; i < count && status == GONIO_OK; i++) {
            *best = best_weight(&around[i]) > best_weight(best) ? around[i] : *best;
        }
        if (!(best_weight(best) > before)) {
            ratio *= 0.5;
            rotation *= 0.5;
        }
    }
    return status;
}

/* The stretches that are weighed with every model: the best of the grid with every share, none, and
 * none with a covariance of every symmetry. */
static size_t list_candidates(const search *s, const trial *best, trial *trials)
{
    static const int symmetries[] = {2, 4, 1};
    size_t count = 0;
    trials[count++] = trial_of((gonio_i_stretch){0}, MODELS, MOST_MODELS);
    for (size_t k = 0; k < ALL_SHARES && best != NULL; k++) {
        gonio_i_stretch stretch = best->stretch;
        stretch.share = SHARES[k];
        trials[count++] = trial_of(stretch, MODELS, MOST_MODELS);
    }
    for (size_t n = 0; n < sizeof symmetries / sizeof *symmetries; n++) {
        for (size_t k = 1; k < ALL_SHARES; k++) {
            const gonio_i_stretch stretch = {0.0, 0.0, SHARES[k], symmetries[n]};
            if (s->symmetry == 0 || s->symmetry == symmetries[n]) {
                trials[count++] = trial_of(stretch, MODELS, MOST_MODELS);
            }
        }
    }
    return count;
}

/* Mixtures of the best hypotheses so far, and of every isotropic one. */
static gonio_status mix(search *s)
{
    trial trials[MOST_TRIALS];
    size_t count = 0;
    size_t anisotropic = 0;
    sort_pool(s);
    for (size_t k = 0; k < s->pooled; k++) {
        const gonio_i_hypothesis *p = &s->pool[k];
        const bool isotropic = gonio_i_stretch_is_isotropic(&p->stretch);
        if (isotropic || anisotropic++ < BEST_MIXED) {
            const gonio_i_model model = {s->h, p->model.alpha, p->model.peak};
            trials[count++] = trial_of(p->stretch, &model, 1);
        }
    }
    const gonio_status status = score_trials(s, trials, count);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        add_to_pool(s, &trials[k]);
    }
    sort_pool(s);
    return status;
}

static int compare_trials(const void *a, const void *b)
{
    const double x = best_weight(a);
    const double y = best_weight(b);
    return (x < y) - (x > y);
}

/* Stretches of the grid beside the best, under its share and model, so that what a few readings
 * leave open of the ratio and the azimuth counts. */
static gonio_status add_neighbours(search *s, trial *grid, size_t count)
{
    const gonio_i_hypothesis *best = s->pool;
    if (count == 0 || best->stretch.log_ratio == 0.0) {
        return GONIO_OK;
    }
    trial trials[NEIGHBOURS];
    qsort(grid, count, sizeof *grid, compare_trials);
    for (size_t k = 0; k < NEIGHBOURS; k++) {
        gonio_i_stretch stretch = grid[k].stretch;
        stretch.share = best->stretch.share;
        trials[k] = trial_of(stretch, &best->model, 1);
    }
    const gonio_status status = score_trials(s, trials, NEIGHBOURS);
    for (size_t k = 0; k < NEIGHBOURS && status == GONIO_OK; k++) {
        add_to_pool(s, &trials[k]);
    }
    sort_pool(s);
    return status;
}

static gonio_status fill_pool(search *s)
{
    trial *grid = gonio_i_allocate(s->context, 2 * (size_t)MOST_TRIALS, sizeof *grid);
    if (grid == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    trial *trials = grid + MOST_TRIALS;
    const size_t count = list_grid(s, grid);
    trial best = {0};
    gonio_status status = score_trials(s, grid, count);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        best = k == 0 || best_weight(&grid[k]) > best_weight(&best) ? grid[k] : best;
    }
    if (status == GONIO_OK && count > 0) {
        status = refine(s, &best);
    }
    const size_t candidates = list_candidates(s, count > 0 ? &best : NULL, trials);
    if (status == GONIO_OK) {
        status = score_trials(s, trials, candidates);
    }
    for (size_t k = 0; k < candidates && status == GONIO_OK; k++) {
        add_to_pool(s, &trials[k]);
    }
    if (status == GONIO_OK) {
        status = mix(s);
    }
    if (status == GONIO_OK) {
        status = add_neighbours(s, grid, count);
    }
    free(grid);
    return status;
}

/* ---- results ---- */

static void find_odds(const search *s, gonio_i_stretches *found)
{
    double best[2] = {-INFINITY, -INFINITY};
    for (size_t k = 0; k < s->pooled; k++) {
        const gonio_i_hypothesis *p = &s->pool[k];
        const int isotropic = gonio_i_stretch_is_isotropic(&p->stretch);
        if (p->weight > best[isotropic]) {
            best[isotropic] = p->weight;
            found->likeliest = isotropic ? found->likeliest : p->stretch;
        }
    }
    found->odds = best[0] - best[1];
}

/* The pool is sorted. */
static void hand_out(const search *s, gonio_i_stretches *found)
{
    double sum = 0.0;
    *found = (gonio_i_stretches){0};
    find_odds(s, found);
    for (size_t k = 0; k < s->pooled && k < GONIO_I_MOST_HYPOTHESES; k++) {
        const double weight = exp(s->pool[k].weight - s->pool[0].weight);
        if (weight > NEGLIGIBLE) {
            found->hypothesis[found->count] = s->pool[k];
            found->hypothesis[found->count++].weight = weight;
            sum += weight;
        }
    }
    for (size_t k = 0; k < found->count; k++) {
        found->hypothesis[k].weight /= sum;
    }
}

/* ---- begin and end ---- */

static gonio_status begin(gonio_context *context, const gonio_i_oriented_columns *columns,
                          size_t most_columns, size_t most_readings, search *s)
{
    *s = (search){.context = context,
                  .prior = columns->prior,
                  .plain = *columns->prior,
                  .pair = columns->pair,
                  .symmetry = columns->symmetry,
                  .steps = {.task = NULL}};
    s->plain.samples = 0;
    s->pool = gonio_i_allocate(context, MOST_POOL, sizeof *s->pool);
    gonio_status status = s->pool == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    const size_t count = columns->count < most_columns ? columns->count : most_columns;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        const gonio_i_column *column = &columns->column[k * columns->count / count];
        s->h = k == 0 ? gonio_i_kernel_width(column->count) : s->h;
        status = gonio_i_thin_copy(context, column, most_readings, &s->column[k]);
        s->columns = k + 1;
    }
    return status;
}

static void end(search *s)
{
    for (size_t k = 0; k < s->columns; k++) {
        free(s->column[k].observation);
    }
    free(s->pool);
}

gonio_status gonio_i_stretches_weigh(gonio_context *context,
                                     const gonio_i_oriented_columns *columns,
                                     gonio_i_stretches *stretches)
{
    search s;
    gonio_status status = begin(context, columns, MOST_COLUMNS, MOST_READINGS, &s);
    if (status == GONIO_OK) {
        status = fill_pool(&s);
    }
    if (status == GONIO_OK) {
        hand_out(&s, stretches);
    }
    end(&s);
    return status;
}

/* ---- sooner ---- */

gonio_status gonio_i_stretches_notice(gonio_context *context,
                                      const gonio_i_oriented_columns *columns, double *odds)
{
    search s;
    gonio_status status = begin(context, columns, NOTICING_COLUMNS, NOTICING_READINGS, &s);
    trial *trials = gonio_i_allocate(context, MOST_TRIALS, sizeof *trials);
    status = trials == NULL ? GONIO_ERROR_MEMORY : status;
    if (status == GONIO_OK) {
        size_t count = list_grid(&s, trials);
        for (size_t k = 1; k < ALL_SHARES; k++) {
            const gonio_i_stretch stretch = {.share = SHARES[k], .symmetry = 2};
            trials[count++] = trial_of(stretch, SEARCHED, SEARCHED_MODELS);
        }
        trials[count++] = trial_of((gonio_i_stretch){0}, MODELS, MOST_MODELS);
        status = score_trials(&s, trials, count);
        double best = -INFINITY;
        for (size_t k = 0; k + 1 < count; k++) {
            best = fmax(best, best_weight(&trials[k]));
        }
        *odds = best - best_weight(&trials[count - 1]);
    }
    free(trials);
    end(&s);
    return status;
}

/* ---- what more readings would tell ---- */

/* Variance of the difference between a reading and its prediction, and the most that a reading
 * counts. */
static const double PREDICTED_VARIANCE = 0.1 * 0.1;
static const double MOST_GAIN = 3.0;

/* Half the squared difference that a stretch makes at a place, in variances, the mean over azimuths
 * of the grain. c[K]: coefficients; f: scratch [2][K]. */
static double gain_at(const search *s, const double *c, gonio_i_oriented place, double log_ratio,
                      double *f)
{
    const size_t k = s->prior->components;
    double sum = 0.0;
    double mean[2];
    gonio_i_prior_at(s->prior, place.at, 0, &mean[0], f);
    for (size_t p = 0; p < ROTATIONS; p++) {
        const gonio_i_stretch stretch = {.log_ratio = log_ratio,
                                         .rotation = M_PI * (double)p / ROTATIONS};
        gonio_i_prior_at(s->prior, gonio_i_stretch_apply(&stretch, place), 0, &mean[1], f + k);
        const double apart = mean[1] + gonio_i_dot(f + k, c, k) - mean[0] - gonio_i_dot(f, c, k);
        sum += fmin(0.5 * apart * apart / PREDICTED_VARIANCE, MOST_GAIN) / ROTATIONS;
    }
    return sum;
}

/* The coefficients of a column under the isotropic model. */
static gonio_status find_isotropic(search *s, size_t column, double *c)
{
    static const gonio_i_model usual = {1.0, 0.12, 0.0};
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
    search s;
    double at[GAIN_PLACES] = {0.0};
    gonio_i_oriented place[GAIN_PLACES];
    gonio_status status = begin(context, columns, NOTICING_COLUMNS, NOTICING_READINGS, &s);
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
        *gain += SHARE * at[i] / (double)(GAIN_PLACES - half);
    }
    free(c);
    end(&s);
    return status;
}

/* ---- readings that cannot tell ---- */

/* Differences of q that show anisotropy. */
static const double SEEN = 0.15;

bool gonio_i_azimuths_are_same(const gonio_i_oriented_columns *columns)
{
    const int symmetry = columns->symmetry > 0 ? columns->symmetry : 2;
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
            const gonio_i_azimuth_point a = gonio_i_azimuth_of(symmetry, here);
            const gonio_i_azimuth_point b =
                gonio_i_azimuth_of(symmetry, (gonio_i_oriented){here.at, phi_h});
            same = hypot(a.x - b.x, a.y - b.y) < SEEN;
        }
    }
    return same;
}

/* ---- ratios ---- */

/* The mean over the azimuths of the grain of the weights of each ratio. */
static void average_rotations(const trial *trials, size_t count, const trial *isotropic,
                              double *odds)
{
    for (size_t r = 0; r < count; r++) {
        double most = -INFINITY;
        double sum = 0.0;
        for (size_t p = 0; p < ROTATIONS; p++) {
            most = fmax(most, best_weight(&trials[r * ROTATIONS + p]));
        }
        for (size_t p = 0; p < ROTATIONS; p++) {
            sum += exp(best_weight(&trials[r * ROTATIONS + p]) - most) / ROTATIONS;
        }
        odds[r] = most + log(sum) - (best_weight(isotropic) - FOR_ISOTROPIC);
    }
}

gonio_status gonio_i_stretches_compare_ratios(gonio_context *context,
                                              const gonio_i_oriented_columns *columns,
                                              const double *log_ratios, size_t count, double *odds)
{
    search s;
    gonio_status status = begin(context, columns, MOST_COLUMNS, MOST_READINGS, &s);
    trial *trials = gonio_i_allocate(context, count * ROTATIONS + 1, sizeof *trials);
    status = trials == NULL ? GONIO_ERROR_MEMORY : status;
    for (size_t k = 0; k < count * ROTATIONS && status == GONIO_OK; k++) {
        const gonio_i_stretch stretch = {log_ratios[k / ROTATIONS],
                                         M_PI * (double)(k % ROTATIONS) / ROTATIONS, 0.0,
                                         stretch_symmetry(&s)};
        trials[k] = trial_of(stretch, MODELS, MOST_MODELS);
    }
    if (status == GONIO_OK) {
        trials[count * ROTATIONS] = trial_of((gonio_i_stretch){0}, MODELS, MOST_MODELS);
        status = score_trials(&s, trials, count * ROTATIONS + 1);
    }
    if (status == GONIO_OK) {
        average_rotations(trials, count, &trials[count * ROTATIONS], odds);
    }
    free(trials);
    end(&s);
    return status;
}
