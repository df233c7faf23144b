/* Condition-number plans (Ali et al., section 3.8): swap chosen rows for others until no single swap
 * lowers kappa = lambda_max/lambda_min of G = X'X.
 *
 * The positions of the choice take turns; each gets the row that lowers kappa most, if any does. (Always
 * making the best of all swaps was tried: it ends sooner, and at 6.5 instead of 4.7 for 80 rows of 35.)
 *
 * Taking a row out leaves a largest eigenvalue of at least d_{K-1}, the second largest of G, so a swap
 * that reaches kappa < tau must have lambda_min > mu = d_{K-1}/tau. The filter (filter.h) finds the rows
 * that do, all at once, and the few that pass are decided exactly (inertia.h). Where many pass, the
 * strongest is decided first, and its kappa as tau leaves few. Nothing is approximated: the same swaps
 * win as if kappa were computed for every one. A full turn without a swap proves a local optimum. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "filter.h"
#include "inertia.h"
#include "method.h"

/* A swap has to lower kappa by more than this share: less is rounding. */
static const double least_gain = 1e-10;

enum { MOST_UPDATES = 64 }; /* swaps before the filter is computed afresh */

typedef struct swap {
    double condition_number;
    size_t row;
} swap;

typedef struct search {
    const gonio_i_selection_problem *problem;
    size_t *chosen;
    unsigned char *taken; /* [rows] */
    double *x;            /* [count][K]: the chosen rows */
    double *y;            /* [count][K]: the same in the eigenbasis of G */
    double *z;            /* [K]: a candidate in the eigenbasis of G */
    double *gram;         /* [K][K]; holds the eigenvectors as rows once decomposed */
    double *d;            /* [K] eigenvalues, ascending */
    double condition_number;
    gonio_i_filter filter;
    size_t *survivors; /* [rows] */
} search;

static bool better(swap a, swap b)
{
    return a.condition_number < b.condition_number ||
           (a.condition_number == b.condition_number && a.row < b.row);
}

/* G, its eigenvectors and eigenvalues, and the chosen rows in that basis. */
static gonio_status decompose(search *s)
{
    const gonio_i_selection_problem *p = s->problem;
    const size_t k = p->components;
    gonio_status status = gonio_i_chosen_gram(p, s->chosen, s->x, s->gram);
    if (status == GONIO_OK) {
        status = gonio_i_eigen(p->context, s->gram, k, true, s->d);
    }
    if (status != GONIO_OK) {
        return status;
    }
    s->condition_number = gonio_i_condition(s->d, k);
    return gonio_i_product_transposed(p->context, s->x, p->count, k, s->gram, k, s->y, k);
}

/* The least lambda_min of a swap that reaches kappa < tau. */
static double bound(const search *s, double tau)
{
    return s->d[s->problem->components - 2] / tau;
}

/* z = Q'u */
static void rotate(search *s, size_t row)
{
    const size_t k = s->problem->components;
    const double *u = s->problem->vectors + row * k;
    for (size_t j = 0; j < k; j++) {
        const double *q = s->gram + j * k;
        double sum = 0.0;
#pragma omp simd reduction(+ : sum)
        for (size_t a = 0; a < k; a++) {
            sum += q[a] * u[a];
        }
        s->z[j] = sum;
    }
}

/* Decides one swap exactly against the best so far. */
static void decide(search *s, size_t position, size_t row, swap *best)
{
    if (s->taken[row]) {
        return;
    }
    const size_t k = s->problem->components;
    rotate(s, row);
    const gonio_i_exchange exchange = {s->d, s->y + position * k, s->z, k};
    const double limit = best->condition_number * (1.0 + 1e-12); /* a tie goes to the lower row */
    if (gonio_i_exchange_may_beat(&exchange, limit)) {
        const swap candidate = {gonio_i_exchange_condition(&exchange, limit), row};
        *best = better(candidate, *best) ? candidate : *best;
    }
}

static gonio_status refresh(search *s, double mu)
{
    return gonio_i_filter_refresh(&s->filter, s->gram, s->d, mu);
}

/* The rows that may do better than `best` at a position; raises mu until they are few, deciding the
 * strongest each time to know how far. */
static gonio_status narrow(search *s, size_t position, swap *best, size_t *count)
{
    const size_t few = 32 + s->problem->rows / 256;
    for (;;) {
        const gonio_status status = gonio_i_filter_load(&s->filter, s->x, position);
        if (status != GONIO_OK) {
            return status;
        }
        *count = gonio_i_filter_survivors(&s->filter, s->x, position, s->survivors);
        if (*count <= few) {
            return GONIO_OK;
        }
        decide(s, position,
               gonio_i_filter_strongest(&s->filter, s->x, position, s->survivors, *count), best);
        /* Somewhat less than could be asked, so that the bound still holds after the swap. */
        const double mu = 0.98 * bound(s, best->condition_number);
        if (mu < 1.02 * s->filter.mu) {
            return GONIO_OK;
        }
        if (refresh(s, mu) != GONIO_OK) {
            return GONIO_ERROR_MEMORY;
        }
    }
}

/* The best swap at a position; best->row stays at `rows` if none lowers kappa. */
static gonio_status best_swap(search *s, size_t position, swap *best)
{
    const gonio_i_selection_problem *p = s->problem;
    *best = (swap){s->condition_number * (1.0 - least_gain), p->rows};
    const double mu = bound(s, s->condition_number);
    gonio_status status = GONIO_OK;
    if (s->filter.updates > MOST_UPDATES || s->filter.mu > mu || s->filter.mu < 0.9 * mu) {
        status = refresh(s, mu);
    }
    size_t count = 0;
    if (status == GONIO_OK) {
        status = narrow(s, position, best, &count);
    }
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        decide(s, position, s->survivors[k], best);
    }
    return status;
}

static void put(search *s, size_t position, size_t row)
{
    s->taken[s->chosen[position]] = 0;
    s->taken[row] = 1;
    s->chosen[position] = row;
}

/* Makes a swap. Next to singular, rounding may promise a gain that is none: that one is undone. */
static gonio_status make_swap(search *s, size_t position, size_t row, bool *gained)
{
    const double before = s->condition_number;
    const size_t old = s->chosen[position];
    gonio_status status = gonio_i_filter_swap(&s->filter, s->x, position, row);
    put(s, position, row);
    if (status == GONIO_OK) {
        status = decompose(s);
    }
    *gained = s->condition_number < before;
    if (status == GONIO_OK && !*gained) {
        put(s, position, old);
        status = decompose(s);
        if (status == GONIO_OK) {
            status = refresh(s, bound(s, s->condition_number));
        }
    }
    return status;
}

/* One turn through the positions. */
static gonio_status sweep(search *s, int restart, int *swaps, gonio_i_selection *selection)
{
    gonio_status status = GONIO_OK;
    for (size_t position = 0; position < s->problem->count && status == GONIO_OK; position++) {
        swap best;
        bool gained = false;
        status = best_swap(s, position, &best);
        if (status == GONIO_OK && best.row < s->problem->rows) {
            status = make_swap(s, position, best.row, &gained);
        }
        if (status == GONIO_OK && gained) {
            status = gonio_i_selection_record(s->problem->context, selection, restart, ++*swaps,
                                              s->condition_number);
        }
    }
    return status;
}

static gonio_status descend(search *s, int restart, gonio_i_selection *selection)
{
    gonio_context *context = s->problem->context;
    int swaps = 0;
    gonio_status status =
        gonio_i_selection_record(context, selection, restart, swaps, s->condition_number);
    bool proved = s->problem->components < 2; /* kappa of one component is 1 */
    for (int turn = 0; status == GONIO_OK && !proved; turn++) {
        const int before = swaps;
        status = refresh(s, bound(s, s->condition_number));
        if (status == GONIO_OK) {
            status = sweep(s, restart, &swaps, selection);
        }
        proved = swaps == before;
        if (status == GONIO_OK) {
            const double share = turn / (turn + 8.0); /* most searches end within 20 turns */
            status = gonio_i_progress(context, "planning",
                                      0.999 * (restart + share) / s->problem->restarts);
        }
    }
    return status;
}

/* ---- starts ---- */

/* Rows that span all K dimensions: each the one farthest from the span of those before it (QR with
 * pivoting). Replaces the first K of the choice, keeping it free of repeats. */
static gonio_status span_start(search *s)
{
    const gonio_i_selection_problem *p = s->problem;
    const size_t k = p->components;
    double *rest = gonio_i_allocate(p->context, p->rows * k, sizeof *rest);
    if (rest == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(rest, p->vectors, p->rows * k * sizeof *rest);
    memset(s->taken, 0, p->rows);
    gonio_status status = GONIO_OK;
    for (size_t j = 0; j < k && status == GONIO_OK; j++) {
        status = gonio_i_take_farthest(p->context, rest, p->rows, k, j, &s->chosen[j]);
        s->taken[s->chosen[j]] = 1;
    }
    for (size_t j = k, row = 0; j < p->count && status == GONIO_OK; row++) {
        if (!s->taken[row]) {
            s->taken[row] = 1;
            s->chosen[j++] = row;
        }
    }
    free(rest);
    return status;
}

/* A random start (step 1), or where the rows drawn do not span K dimensions one that does. */
static gonio_status start(search *s, int restart)
{
    const gonio_i_selection_problem *p = s->problem;
    gonio_status status = gonio_i_random_choice(p, (uint64_t)restart, s->chosen);
    memset(s->taken, 0, p->rows);
    for (size_t j = 0; j < p->count; j++) {
        s->taken[s->chosen[j]] = 1;
    }
    if (status == GONIO_OK) {
        status = decompose(s);
    }
    return status == GONIO_OK && isinf(s->condition_number) ? span_start(s) : status;
}

static int compare_rows(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a;
    const size_t y = *(const size_t *)b;
    return (x > y) - (x < y);
}

static gonio_status run(search *s, gonio_i_selection *selection)
{
    const gonio_i_selection_problem *p = s->problem;
    gonio_status status = GONIO_OK;
    selection->condition_number = INFINITY;
    for (int restart = 0; restart < p->restarts && status == GONIO_OK; restart++) {
        status = start(s, restart);
        if (status == GONIO_OK) {
            status = descend(s, restart, selection);
        }
        if (status == GONIO_OK &&
            (restart == 0 || s->condition_number < selection->condition_number)) {
            selection->condition_number = s->condition_number;
            memcpy(selection->chosen, s->chosen, p->count * sizeof *s->chosen);
        }
    }
    if (status == GONIO_OK) {
        qsort(selection->chosen, p->count, sizeof *selection->chosen, compare_rows);
        status = gonio_i_progress(p->context, "planning", 1.0);
    }
    return status;
}

static gonio_status select_by_condition(const gonio_i_selection_problem *problem,
                                        gonio_i_selection *selection)
{
    const size_t k = problem->components;
    const size_t n = problem->count;
    gonio_context *context = problem->context;
    search s = {
        .problem = problem,
        .chosen = gonio_i_allocate(context, n, sizeof *s.chosen),
        .taken = gonio_i_allocate(context, problem->rows, sizeof *s.taken),
        .x = gonio_i_allocate(context, n * k, sizeof *s.x),
        .y = gonio_i_allocate(context, n * k, sizeof *s.y),
        .gram = gonio_i_allocate(context, k * k, sizeof *s.gram),
        .d = gonio_i_allocate(context, k, sizeof *s.d),
        .z = gonio_i_allocate(context, k, sizeof *s.z),
        .survivors = gonio_i_allocate(context, problem->rows + 1, sizeof *s.survivors),
    };
    const bool ready = gonio_i_filter_allocate(problem, &s.filter) && s.chosen != NULL &&
                       s.taken != NULL && s.x != NULL && s.y != NULL && s.z != NULL &&
                       s.gram != NULL && s.d != NULL && s.survivors != NULL;
    const gonio_status status = ready ? run(&s, selection) : GONIO_ERROR_MEMORY;
    free(s.chosen);
    free(s.taken);
    free(s.x);
    free(s.y);
    free(s.gram);
    free(s.d);
    free(s.z);
    free(s.survivors);
    gonio_i_filter_free(&s.filter);
    return status;
}

const gonio_i_method gonio_i_condition_method = {
    "condition", "lowest condition number by swaps (Ali et al.)", true, select_by_condition};
