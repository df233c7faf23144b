/* The plan that leaves the least expected error: greedy choice with exchanges, nested.
 *
 * Given     F, rows f(x) of the prior (basis/prior.h), loss weights w(x) over them, and the noise
 *           variance sigma^2 of a reading
 * Returned  rows in the order in which to read them
 * Method    With P the posterior covariance of z, reading x leaves the expected loss
 *           trace(P W) - t(x)/(q(x) + sigma^2), W = F' diag(w) F, q = f P f', t = f P W P f'
 *           (the V- or I-optimal design of Chaloner and Verdinelli 1995; METHOD of greedy choice
 *           with exact updates: Fedorov 1972). Each reading is the best next one. After 5, 10, 20,
 *           40 ... readings those of the last block are exchanged for better ones, one after
 *           another, until none changes: so the first 5, 10, 20 ... of a plan are good plans too.
 * Accuracy  Rank-one updates of q and t in double precision, computed anew from P after each block.
 */
#include "expected_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

enum { FIRST_BLOCK = 5, MOST_TURNS = 4, BLOCK_ROWS = 1024 };

typedef struct design {
    const gonio_i_design_problem *problem;
    size_t rows;
    size_t k;
    double *p;      /* [k][k]: P */
    double *w;      /* [k][k]: W */
    double *q;      /* [rows] */
    double *t;      /* [rows] */
    double *vector; /* [3][k]: P f, W g, P W g */
    bool *taken;    /* [rows] */
} design;

static const double *row_of(const design *d, size_t row)
{
    return d->problem->f + row * d->k;
}

GONIO_I_VECTORISED static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static void multiply(const double *matrix, const double *x, size_t n, double *y)
{
    for (size_t i = 0; i < n; i++) {
        y[i] = dot(matrix + i * n, x, n);
    }
}

/* W = F' diag(w) F. */
static gonio_status find_loss(design *d)
{
    gonio_context *context = d->problem->context;
    double *block = gonio_i_allocate(context, BLOCK_ROWS * d->k, sizeof *block);
    gonio_status status = block == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t first = 0; first < d->rows && status == GONIO_OK; first += BLOCK_ROWS) {
        const size_t count = d->rows - first < BLOCK_ROWS ? d->rows - first : BLOCK_ROWS;
        for (size_t b = 0; b < count; b++) {
            const double root = sqrt(d->problem->loss[first + b]);
            for (size_t j = 0; j < d->k; j++) {
                block[b * d->k + j] = root * row_of(d, first + b)[j];
            }
        }
        status = gonio_i_add_gram_rows(context, block, count, d->k, d->w);
    }
    gonio_i_mirror(d->w, d->k);
    free(block);
    return status;
}

/* q and t from P. */
static gonio_status find_gains(design *d)
{
    gonio_context *context = d->problem->context;
    double *a = gonio_i_allocate(context, 2 * BLOCK_ROWS * d->k, sizeof *a);
    gonio_status status = a == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t first = 0; first < d->rows && status == GONIO_OK; first += BLOCK_ROWS) {
        const size_t count = d->rows - first < BLOCK_ROWS ? d->rows - first : BLOCK_ROWS;
        double *b = a + BLOCK_ROWS * d->k;
        status =
            gonio_i_product_transposed(context, row_of(d, first), count, d->k, d->p, d->k, a, d->k);
        if (status == GONIO_OK) {
            status = gonio_i_product_transposed(context, a, count, d->k, d->w, d->k, b, d->k);
        }
        for (size_t i = 0; i < count && status == GONIO_OK; i++) {
            d->q[first + i] = dot(a + i * d->k, row_of(d, first + i), d->k);
            d->t[first + i] = dot(b + i * d->k, a + i * d->k, d->k);
        }
    }
    free(a);
    return status;
}

/* P becomes P - sign g g', g = P f / (sign f P f' + sigma^2)^(1/2): sign 1 for a reading made, -1
 * for one taken back. q and t follow. */
static void update(design *d, const double *f, double variance, double sign)
{
    const size_t k = d->k;
    double *g = d->vector;
    double *wg = d->vector + k;
    double *pwg = d->vector + 2 * k;
    multiply(d->p, f, k, g);
    const double scale = 1.0 / sqrt(fmax(variance + sign * dot(f, g, k), 1e-12));
    for (size_t j = 0; j < k; j++) {
        g[j] *= scale;
    }
    multiply(d->w, g, k, wg);
    multiply(d->p, wg, k, pwg);
    const double gwg = dot(g, wg, k);
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(d->problem->context))
    for (size_t x = 0; x < d->rows; x++) {
        const double a = dot(row_of(d, x), g, k);
        const double b = dot(row_of(d, x), pwg, k);
        d->t[x] += -2.0 * sign * a * b + a * a * gwg;
        d->q[x] -= sign * a * a;
    }
    for (size_t i = 0; i < k; i++) {
        for (size_t j = 0; j < k; j++) {
            d->p[i * k + j] -= sign * g[i] * g[j];
        }
    }
}

/* The row whose reading leaves the least loss; the first of equals. */
static size_t find_best(const design *d)
{
    size_t best = d->rows;
    double most = -INFINITY;
    for (size_t x = 0; x < d->rows; x++) {
        const double gain = d->t[x] / (fmax(d->q[x], 0.0) + d->problem->variance);
        const bool free_row = !d->taken[x] && d->problem->allowed[x];
        if (free_row && gain > most) {
            most = gain;
            best = x;
        }
    }
    return best;
}

static void take(design *d, size_t row)
{
    d->taken[row] = true;
    update(d, row_of(d, row), d->problem->variance, 1.0);
}

static void take_back(design *d, size_t row)
{
    d->taken[row] = false;
    update(d, row_of(d, row), d->problem->variance, -1.0);
}

/* Exchanges the readings from `first` to `end` - 1 for better ones. */
static gonio_status exchange(design *d, size_t *chosen, size_t first, size_t end)
{
    bool changed = true;
    gonio_status status = GONIO_OK;
    for (int turn = 0; turn < MOST_TURNS && changed && status == GONIO_OK; turn++) {
        changed = false;
        for (size_t i = first; i < end && status == GONIO_OK; i++) {
            take_back(d, chosen[i]);
            const size_t best = find_best(d);
            changed = changed || best != chosen[i];
            chosen[i] = best;
            take(d, best);
            status = gonio_i_progress(d->problem->context, "planning",
                                      (double)i / (double)d->problem->count);
        }
    }
    return status;
}

static gonio_status choose_blocks(design *d, size_t *chosen)
{
    const gonio_i_design_problem *problem = d->problem;
    gonio_status status = find_gains(d);
    size_t done = 0;
    for (size_t end = FIRST_BLOCK; done < problem->count && status == GONIO_OK; end *= 2) {
        const size_t first = done;
        for (; done < end && done < problem->count; done++) {
            chosen[done] = find_best(d);
            take(d, chosen[done]);
        }
        status = exchange(d, chosen, first, done);
        if (status == GONIO_OK) {
            status = find_gains(d);
        }
    }
    return status;
}

/* trace(P W) before the first and after each reading, made again in order: an exchange changes what
 * was left before. */
static void find_remaining(design *d, const size_t *chosen, double *remaining)
{
    const size_t k = d->k;
    memcpy(d->p, d->problem->covariance, k * k * sizeof *d->p);
    remaining[0] = dot(d->p, d->w, k * k);
    for (size_t n = 0; n < d->problem->count; n++) {
        const double *f = row_of(d, chosen[n]);
        double *g = d->vector;
        multiply(d->p, f, k, g);
        const double s = d->problem->variance + dot(f, g, k);
        for (size_t i = 0; i < k; i++) {
            for (size_t j = 0; j < k; j++) {
                d->p[i * k + j] -= g[i] * g[j] / s;
            }
        }
        remaining[n + 1] = dot(d->p, d->w, k * k);
    }
}

gonio_status gonio_i_design_find(const gonio_i_design_problem *problem, size_t *chosen,
                                 double *remaining)
{
    gonio_context *context = problem->context;
    const size_t k = problem->components;
    design d = {.problem = problem,
                .rows = problem->rows,
                .k = k,
                .p = gonio_i_allocate(context, k * k, sizeof *d.p),
                .w = gonio_i_allocate(context, k * k, sizeof *d.w),
                .q = gonio_i_allocate(context, problem->rows, sizeof *d.q),
                .t = gonio_i_allocate(context, problem->rows, sizeof *d.t),
                .vector = gonio_i_allocate(context, 3 * k, sizeof *d.vector),
                .taken = gonio_i_allocate(context, problem->rows, sizeof *d.taken)};
    const bool done = d.p && d.w && d.q && d.t && d.vector && d.taken;
    gonio_status status = done ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        memcpy(d.p, problem->covariance, k * k * sizeof *d.p);
        status = find_loss(&d);
    }
    if (status == GONIO_OK) {
        status = choose_blocks(&d, chosen);
    }
    if (status == GONIO_OK && remaining != NULL) {
        find_remaining(&d, chosen, remaining);
    }
    free(d.p);
    free(d.w);
    free(d.q);
    free(d.t);
    free(d.vector);
    free(d.taken);
    return status;
}
