/* The search for stretches and their weights: see stretches.h. */
#include "stretches.h"

#include <math.h>
#include <stdlib.h>

#include "stretch_spread.h"

enum {
    BEST_MIXED = 3, /* models that are tried as mixtures too, mirrored ones and others each */
    REFINEMENTS = 7,
    STARTS = 2, /* of each kind, that are refined */
    SYMMETRIES = 3,
    KINDS = 5,
    MOST_POOL =
        (1 + KINDS * STARTS * GONIO_I_TRIAL_SHARES + SYMMETRIES * (GONIO_I_TRIAL_SHARES - 1)) *
            GONIO_I_TRIAL_MODELS + /* list_candidates */
        GONIO_I_MOST_TRIALS +      /* mix */
        2 * GONIO_I_SPREAD,
};

/* Azimuths of starts are farther apart, radians: more than a step of the grid. */
static const double APART = 1.5 * M_PI / GONIO_I_ROTATIONS;

/* Hypotheses of less weight are left out. */
static const double NEGLIGIBLE = 0.02;

/* ---- the pool of hypotheses ---- */

typedef struct pool {
    gonio_i_search search;
    gonio_i_hypothesis *hypothesis; /* [MOST_POOL] */
    size_t count;
} pool;

/* Whether it is the same mirrored or not, as nothing of it depends on the azimuth. */
static bool is_twin(const gonio_i_stretch *stretch, const gonio_i_model *model)
{
    return stretch->mirrored && stretch->share == 0.0 && model->alpha == 0.0;
}

static void add_to_pool(pool *p, const gonio_i_trial *t)
{
    for (size_t m = 0; m < t->count && p->count < MOST_POOL; m++) {
        if (!is_twin(&t->stretch, &t->model[m])) {
            p->hypothesis[p->count++] =
                (gonio_i_hypothesis){t->stretch, t->model[m], gonio_i_trial_model_weight(t, m)};
        }
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

/* Steps around the best trial, which become smaller where none is better. */
static gonio_status refine(gonio_i_search *s, gonio_i_trial *best)
{
    double ratio = 0.2;
    double rotation = 0.5 * M_PI / GONIO_I_ROTATIONS;
    gonio_status status = GONIO_OK;
    for (int k = 0; k < REFINEMENTS && status == GONIO_OK; k++) {
        const gonio_i_model model = best->model[gonio_i_trial_best(best)];
        gonio_i_trial around[] = {
            gonio_i_trial_of(gonio_i_stretch_moved(best->stretch, ratio, 0.0), &model, 1),
            gonio_i_trial_of(gonio_i_stretch_moved(best->stretch, -ratio, 0.0), &model, 1),
            gonio_i_trial_of(gonio_i_stretch_moved(best->stretch, 0.0, rotation), &model, 1),
            gonio_i_trial_of(gonio_i_stretch_moved(best->stretch, 0.0, -rotation), &model, 1)};
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

static size_t list_shares(gonio_i_stretch stretch, size_t first, gonio_i_trial *trials)
{
    for (size_t k = first; k < GONIO_I_TRIAL_SHARES; k++) {
        stretch.share = gonio_i_trial_shares[k];
        *trials++ = gonio_i_trial_of(stretch, gonio_i_trial_models, GONIO_I_TRIAL_MODELS);
    }
    return GONIO_I_TRIAL_SHARES - first;
}

/* The stretches that are weighed with every model: those found with every share, none, and none
 * with a covariance of every symmetry. Fibres without a share are hardly to be told from none. */
static size_t list_candidates(const gonio_i_search *s, const gonio_i_trial *found, size_t count,
                              gonio_i_trial *trials)
{
    static const int symmetries[SYMMETRIES] = {2, 4, 1};
    size_t listed = 1;
    trials[0] = gonio_i_trial_of((gonio_i_stretch){0}, gonio_i_trial_models, GONIO_I_TRIAL_MODELS);
    for (size_t k = 0; k < count; k++) {
        listed += list_shares(found[k].stretch, found[k].stretch.fibres ? 1 : 0, trials + listed);
    }
    for (size_t n = 0; n < SYMMETRIES; n++) {
        if (s->symmetry == 0 || s->symmetry == symmetries[n]) {
            const gonio_i_stretch stretch = {.symmetry = symmetries[n]};
            listed += list_shares(stretch, 1, trials + listed);
        }
    }
    return listed;
}

/* Mixtures of the best hypotheses of either kind so far, and of every isotropic one. */
static gonio_status mix(pool *p)
{
    gonio_i_trial trials[GONIO_I_MOST_TRIALS];
    size_t count = 0;
    size_t anisotropic[2] = {0, 0}; /* others, mirrored */
    sort_pool(p);
    for (size_t k = 0; k < p->count; k++) {
        const gonio_i_hypothesis *h = &p->hypothesis[k];
        const bool isotropic = gonio_i_stretch_is_isotropic(&h->stretch);
        if (isotropic || anisotropic[h->stretch.mirrored]++ < BEST_MIXED) {
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

/* ---- odds ---- */

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

/* ---- what is left open of a stretch ---- */

static bool is_same_grain(const gonio_i_stretch *a, const gonio_i_stretch *b)
{
    return a->log_ratio == b->log_ratio && a->rotation == b->rotation &&
           a->mirrored == b->mirrored && a->facets == b->facets && a->fibres == b->fibres;
}

/* Takes a hypothesis and all others of its ratio and azimuth out; *taken is the likeliest of them
 * with the weight of all. */
static void take_out(pool *p, size_t first, gonio_i_hypothesis *taken)
{
    double sum = 0.0;
    size_t kept = 0;
    *taken = p->hypothesis[first];
    for (size_t k = 0; k < p->count; k++) {
        const gonio_i_hypothesis h = p->hypothesis[k];
        if (is_same_grain(&h.stretch, &taken->stretch)) {
            sum += exp(h.weight - taken->weight);
        } else {
            p->hypothesis[kept++] = h;
        }
    }
    p->count = kept;
    taken->weight += log(sum);
}

/* The likeliest hypothesis of a stretch, mirrored or not. */
static size_t find_grain(const pool *p, bool mirrored)
{
    size_t k = 0;
    while (k < p->count && (p->hypothesis[k].stretch.mirrored != mirrored ||
                            p->hypothesis[k].stretch.log_ratio == 0.0)) {
        k++;
    }
    return k;
}

static gonio_status spread(pool *p, bool mirrored)
{
    gonio_i_hypothesis taken;
    const size_t first = find_grain(p, mirrored);
    const double least = p->hypothesis[0].weight + log(NEGLIGIBLE);
    if (first == p->count || p->hypothesis[first].weight < least) {
        return GONIO_OK;
    }
    take_out(p, first, &taken);
    const gonio_status status =
        gonio_i_stretch_spread(&p->search, &taken, p->hypothesis + p->count);
    p->count += status == GONIO_OK ? GONIO_I_SPREAD : 0;
    sort_pool(p);
    return status;
}

/* ---- all of it ---- */

/* The best of a grid whose azimuth is far from those of found[count]; NULL: there is none. */
static const gonio_i_trial *best_apart(const gonio_i_trial *grid, size_t size,
                                       const gonio_i_trial *found, size_t count)
{
    const gonio_i_trial *best = NULL;
    for (size_t k = 0; k < size; k++) {
        const double rotation = grid[k].stretch.rotation;
        bool apart = true;
        for (size_t j = 0; j < count; j++) {
            apart = apart && fabs(remainder(rotation - found[j].stretch.rotation, M_PI)) > APART;
        }
        if (apart &&
            (best == NULL || gonio_i_trial_weight(&grid[k]) > gonio_i_trial_weight(best))) {
            best = &grid[k];
        }
    }
    return best;
}

/* The best of the grid at azimuths apart, refined, to found[STARTS]. grid[GONIO_I_MOST_TRIALS]:
 * scratch. Adds to *count. */
static gonio_status search_grid(gonio_i_search *s, gonio_i_stretch kind, gonio_i_trial *grid,
                                gonio_i_trial *found, size_t *count)
{
    const size_t size = gonio_i_trials_grid(s, kind, grid);
    gonio_status status = gonio_i_trials_score(s, grid, size);
    size_t starts = 0;
    while (starts < STARTS && status == GONIO_OK) {
        const gonio_i_trial *best = best_apart(grid, size, found, starts);
        if (best == NULL) {
            break;
        }
        found[starts++] = *best;
    }
    for (size_t k = 0; k < starts && status == GONIO_OK; k++) {
        status = refine(s, &found[k]);
    }
    *count += starts;
    return status;
}

/* Searches the grid for every kind of stretch, and weighs what is best.
 * trials[GONIO_I_MOST_TRIALS]: scratch. */
static gonio_status fill_from(pool *p, gonio_i_trial *trials)
{
    static const gonio_i_stretch kinds[KINDS] = {{.mirrored = false},
                                                 {.mirrored = true},
                                                 {.mirrored = false, .facets = true},
                                                 {.mirrored = true, .facets = true},
                                                 {.fibres = true}};
    gonio_i_search *s = &p->search;
    gonio_i_trial found[KINDS * STARTS];
    size_t count = 0;
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < KINDS && status == GONIO_OK; k++) {
        status = search_grid(s, kinds[k], trials, found + count, &count);
    }
    const size_t listed = list_candidates(s, found, count, trials);
    if (status == GONIO_OK) {
        status = gonio_i_trials_score(s, trials, listed);
    }
    for (size_t k = 0; k < listed && status == GONIO_OK; k++) {
        add_to_pool(p, &trials[k]);
    }
    return status == GONIO_OK ? mix(p) : status;
}

static gonio_status fill_pool(pool *p)
{
    gonio_i_trial *trials =
        gonio_i_allocate(p->search.context, GONIO_I_MOST_TRIALS, sizeof *trials);
    const gonio_status status = trials == NULL ? GONIO_ERROR_MEMORY : fill_from(p, trials);
    free(trials);
    return status;
}

static gonio_status spread_all(pool *p)
{
    const gonio_status status = spread(p, false);
    return status == GONIO_OK ? spread(p, true) : status;
}

/* ---- results ---- */

/* The pool is sorted. */
static void hand_out(const pool *p, gonio_i_stretches *found)
{
    double sum = 0.0;
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
        *stretches = (gonio_i_stretches){0};
        find_odds(&p, stretches);
        status = spread_all(&p);
    }
    if (status == GONIO_OK) {
        hand_out(&p, stretches);
    }
    gonio_i_search_end(&p.search);
    free(p.hypothesis);
    return status;
}
