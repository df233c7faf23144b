/* The search for stretches and their weights: see stretches.h. */
#include "stretches.h"

#include <math.h>
#include <stdlib.h>

#include "stretch_trials.h"

enum {
    NEIGHBOURS = 6, /* stretches beside the best that are weighed too */
    BEST_MIXED = 3, /* models that are tried as mixtures too */
    REFINEMENTS = 7,
    MOST_POOL = 256,
};

/* Hypotheses of less weight are left out. */
static const double NEGLIGIBLE = 0.02;

/* ---- the pool of hypotheses ---- */

typedef struct pool {
    gonio_i_search search;
    gonio_i_hypothesis *hypothesis; /* [MOST_POOL] */
    size_t count;
} pool;

static void add_to_pool(pool *p, const gonio_i_trial *t)
{
    for (size_t m = 0; m < t->count && p->count < MOST_POOL; m++) {
        p->hypothesis[p->count++] =
            (gonio_i_hypothesis){t->stretch, t->model[m], gonio_i_trial_model_weight(t, m)};
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
static void sort_pool(pool *p)
{
    for (size_t i = 1; i < p->count; i++) {
        swap_if_better(p->hypothesis, i);
    }
}

/* ---- rounds of the search ---- */

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
static gonio_status refine(gonio_i_search *s, gonio_i_trial *best)
{
    double ratio = 0.2;
    double rotation = 0.5 * M_PI / GONIO_I_ROTATIONS;
    gonio_status status = GONIO_OK;
    for (int k = 0; k < REFINEMENTS && status == GONIO_OK; k++) {
        const gonio_i_model model = best->model[gonio_i_trial_best(best)];
        gonio_i_trial around[] = {
            gonio_i_trial_of(moved(best->stretch, ratio, 0.0), &model, 1),
            gonio_i_trial_of(moved(best->stretch, -ratio, 0.0), &model, 1),
            gonio_i_trial_of(moved(best->stretch, 0.0, rotation), &model, 1),
            gonio_i_trial_of(moved(best->stretch, 0.0, -rotation), &model, 1)};
        const size_t count = sizeof around / sizeof *around;
        const double before = gonio_i_trial_weight(best);
        status = gonio_i_trials_score(s, around, count);
        for (size_t i = 0; i < count && status == GONIO_OK; i++) {
            *best =
                gonio_i_trial_weight(&around[i]) > gonio_i_trial_weight(best) ? around[i] : *best;
        }
        if (!(gonio_i_trial_weight(best) > before)) {
            ratio *= 0.5;
            rotation *= 0.5;
        }
    }
    return status;
}

/* The stretches that are weighed with every model: the best of the grid with every share, none, and
 * none with a covariance of every symmetry. */
static size_t list_candidates(const gonio_i_search *s, const gonio_i_trial *best,
                              gonio_i_trial *trials)
{
    static const int symmetries[] = {2, 4, 1};
    size_t count = 0;
    trials[count++] =
        gonio_i_trial_of((gonio_i_stretch){0}, gonio_i_trial_models, GONIO_I_TRIAL_MODELS);
    for (size_t k = 0; k < GONIO_I_TRIAL_SHARES && best != NULL; k++) {
        gonio_i_stretch stretch = best->stretch;
        stretch.share = gonio_i_trial_shares[k];
        trials[count++] = gonio_i_trial_of(stretch, gonio_i_trial_models, GONIO_I_TRIAL_MODELS);
    }
    for (size_t n = 0; n < sizeof symmetries / sizeof *symmetries; n++) {
        for (size_t k = 1; k < GONIO_I_TRIAL_SHARES; k++) {
            const gonio_i_stretch stretch = {0.0, 0.0, gonio_i_trial_shares[k], symmetries[n]};
            if (s->symmetry == 0 || s->symmetry == symmetries[n]) {
                trials[count++] =
                    gonio_i_trial_of(stretch, gonio_i_trial_models, GONIO_I_TRIAL_MODELS);
            }
        }
    }
    return count;
}

/* Mixtures of the best hypotheses so far, and of every isotropic one. */
static gonio_status mix(pool *p)
{
    gonio_i_trial trials[GONIO_I_MOST_TRIALS];
    size_t count = 0;
    size_t anisotropic = 0;
    sort_pool(p);
    for (size_t k = 0; k < p->count; k++) {
        const gonio_i_hypothesis *h = &p->hypothesis[k];
        const bool isotropic = gonio_i_stretch_is_isotropic(&h->stretch);
        if (isotropic || anisotropic++ < BEST_MIXED) {
            const gonio_i_model model = {p->search.h, h->model.alpha, h->model.peak, 0.0};
            trials[count++] = gonio_i_trial_of(h->stretch, &model, 1);
        }
    }
    const gonio_status status = gonio_i_trials_score(&p->search, trials, count);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        add_to_pool(p, &trials[k]);
    }
    sort_pool(p);
    return status;
}

static int compare_trials(const void *a, const void *b)
{
    const double x = gonio_i_trial_weight(a);
    const double y = gonio_i_trial_weight(b);
    return (x < y) - (x > y);
}

/* Stretches of the grid beside the best, under its share and model, so that what a few readings
 * leave open of the ratio and the azimuth counts. */
static gonio_status add_neighbours(pool *p, gonio_i_trial *grid, size_t count)
{
    const gonio_i_hypothesis *best = p->hypothesis;
    if (count == 0 || best->stretch.log_ratio == 0.0) {
        return GONIO_OK;
    }
    gonio_i_trial trials[NEIGHBOURS];
    qsort(grid, count, sizeof *grid, compare_trials);
    for (size_t k = 0; k < NEIGHBOURS; k++) {
        gonio_i_stretch stretch = grid[k].stretch;
        stretch.share = best->stretch.share;
        trials[k] = gonio_i_trial_of(stretch, &best->model, 1);
    }
    const gonio_status status = gonio_i_trials_score(&p->search, trials, NEIGHBOURS);
    for (size_t k = 0; k < NEIGHBOURS && status == GONIO_OK; k++) {
        add_to_pool(p, &trials[k]);
    }
    sort_pool(p);
    return status;
}

static gonio_status fill_pool(pool *p)
{
    gonio_i_trial *grid =
        gonio_i_allocate(p->search.context, 2 * (size_t)GONIO_I_MOST_TRIALS, sizeof *grid);
    if (grid == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_i_trial *trials = grid + GONIO_I_MOST_TRIALS;
    const size_t count = gonio_i_trials_grid(&p->search, grid);
    gonio_i_trial best = {0};
    gonio_status status = gonio_i_trials_score(&p->search, grid, count);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        best =
            k == 0 || gonio_i_trial_weight(&grid[k]) > gonio_i_trial_weight(&best) ? grid[k] : best;
    }
    if (status == GONIO_OK && count > 0) {
        status = refine(&p->search, &best);
    }
    const size_t candidates = list_candidates(&p->search, count > 0 ? &best : NULL, trials);
    if (status == GONIO_OK) {
        status = gonio_i_trials_score(&p->search, trials, candidates);
    }
    for (size_t k = 0; k < candidates && status == GONIO_OK; k++) {
        add_to_pool(p, &trials[k]);
    }
    if (status == GONIO_OK) {
        status = mix(p);
    }
    if (status == GONIO_OK) {
        status = add_neighbours(p, grid, count);
    }
    free(grid);
    return status;
}

/* ---- results ---- */

static void find_odds(const pool *p, gonio_i_stretches *found)
{
    double best[2] = {-INFINITY, -INFINITY};
    for (size_t k = 0; k < p->count; k++) {
        const gonio_i_hypothesis *h = &p->hypothesis[k];
        const int isotropic = gonio_i_stretch_is_isotropic(&h->stretch);
        if (h->weight > best[isotropic]) {
            best[isotropic] = h->weight;
            found->likeliest = isotropic ? found->likeliest : h->stretch;
        }
    }
    found->odds = best[0] - best[1];
}

/* The pool is sorted. */
static void hand_out(const pool *p, gonio_i_stretches *found)
{
    double sum = 0.0;
    *found = (gonio_i_stretches){0};
    find_odds(p, found);
    for (size_t k = 0; k < p->count && k < GONIO_I_MOST_HYPOTHESES; k++) {
        const double weight = exp(p->hypothesis[k].weight - p->hypothesis[0].weight);
        if (weight > NEGLIGIBLE) {
            found->hypothesis[found->count] = p->hypothesis[k];
            found->hypothesis[found->count++].weight = weight;
            sum += weight;
        }
    }
    for (size_t k = 0; k < found->count; k++) {
        found->hypothesis[k].weight /= sum;
    }
}

gonio_status gonio_i_stretches_weigh(gonio_context *context,
                                     const gonio_i_oriented_columns *columns,
                                     gonio_i_stretches *stretches)
{
    pool p = {.hypothesis = gonio_i_allocate(context, MOST_POOL, sizeof *p.hypothesis)};
    gonio_status status = gonio_i_search_begin(context, columns, GONIO_I_SEARCH_COLUMNS,
                                               GONIO_I_SEARCH_READINGS, &p.search);
    if (status == GONIO_OK && p.hypothesis == NULL) {
        status = GONIO_ERROR_MEMORY;
    }
    if (status == GONIO_OK) {
        status = fill_pool(&p);
    }
    if (status == GONIO_OK) {
        hand_out(&p, stretches);
    }
    gonio_i_search_end(&p.search);
    free(p.hypothesis);
    return status;
}
