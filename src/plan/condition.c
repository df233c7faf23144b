/* Condition-number plans (Ali et al., section 3.8): swap chosen rows for others until no single
 * swap lowers kappa = lambda_max/lambda_min of G = X'X.
 *
 * The positions of the choice take turns; the rows outside are tried at each in cyclic order from a
 * random one on, and the first that lowers kappa is taken. (On ten bases of 35 components, 80 rows
 * and one start, this ends at kappa 4.1 on average; the best row of each position at 5.2, the best
 * of all swaps at over 6: greed gets stuck early.)
 *
 * Taking a row out leaves a largest eigenvalue of at least d_{K-1}, the second largest of G, so a
 * swap that lowers kappa must have lambda_min > mu = d_{K-1}/kappa. The filter (filter.h) finds the
 * rows that do, all at once, and those are decided exactly (inertia.h). Nothing is approximated:
 * the same swaps win as if kappa were computed for every one. A full turn without a swap proves a
 * local optimum. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/random.h"
#include "../linalg/linalg.h"
#include "filter.h"
#include "inertia.h"
#include "method.h"

/* A swap has to lower kappa by more than this share: less is rounding. */
static const double least_gain = 1e-10;

enum { MOST_UPDATES = 64 }; /* swaps before the filter is computed afresh */

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
    size_t *survivors; /* [rows + 1] */
    gonio_i_random random;
} search;

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

/* What lambda_min of a swap that lowers kappa must exceed. */
static double bound(const search *s)
{
    return s->d[s->problem->components - 2] / s->condition_number;
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

/* Whether a swap lowers kappa, exactly. */
static bool wins(search *s, size_t position, size_t row)
{
    if (s->taken[row]) {
        return false;
    }
    const size_t k = s->problem->components;
    rotate(s, row);
    const gonio_i_exchange exchange = {s->d, s->y + position * k, s->z, k};
    return gonio_i_exchange_beats(&exchange, s->condition_number * (1.0 - least_gain));
}

static gonio_status refresh(search *s)
{
    return gonio_i_filter_refresh(&s->filter, s->gram, s->d, bound(s));
}

/* The first row in the cyclic order from `from` on that lowers kappa at a position; `rows` if none.
 */
static gonio_status first_winner(search *s, size_t position, size_t from, size_t *winner)
{
    *winner = s->problem->rows;
    const double mu = bound(s);
    gonio_status status = GONIO_OK;
    if (s->filter.updates > MOST_UPDATES || s->filter.mu > mu || s->filter.mu < 0.97 * mu) {
        status = refresh(s);
    }
    if (status == GONIO_OK) {
        status = gonio_i_filter_load(&s->filter, s->x, position);
    }
    if (status != GONIO_OK) {
        return status;
    }
    const size_t count = gonio_i_filter_survivors(&s->filter, s->x, position, s->survivors);
    size_t first = 0;
    while (first < count && s->survivors[first] < from) {
        first++;
    }
    for (size_t k = 0; k < count; k++) {
        const size_t row = s->survivors[(first + k) % count];
        if (wins(s, position, row)) {
            *winner = row;
            return GONIO_OK;
        }
    }
    return GONIO_OK;
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
            status = refresh(s);
        }
    }
    return status;
}

/* One turn through the positions. */
static gonio_status sweep(search *s, int restart, int *swaps, gonio_i_selection *selection)
{
    gonio_status status = GONIO_OK;
    for (size_t position = 0; position < s->problem->count && status == GONIO_OK; position++) {
        size_t row = 0;
        bool gained = false;
        status =
            first_winner(s, position, gonio_i_random_below(&s->random, s->problem->rows), &row);
        if (status == GONIO_OK && row < s->problem->rows) {
            status = make_swap(s, position, row, &gained);
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
        status = refresh(s);
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
    gonio_status status = gonio_i_random_choice(p, 2 * (uint64_t)restart, s->chosen);
    gonio_i_random_seed(&s->random, p->seed, 2 * (uint64_t)restart + 1);
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
