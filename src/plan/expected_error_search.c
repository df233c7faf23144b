/* The plan of least expected error: greedy, with exchanges, nested.
 *
 * Given     F, rows f(x) of the prior (basis/prior.h), loss weights w(x) over them, and the noise
 *           variance sigma^2 of a reading
 * Returned  rows in the order in which to read them
 * Method    With P the posterior covariance of z, reading x leaves the expected loss
 *           trace(P W) - t(x)/(q(x) + sigma^2), W = F' diag(w) F, q = f P f', t = f P W P f'
 *           (the V- or I-optimal design of Chaloner and Verdinelli 1995, chosen greedily with the
 *           exact updates of Fedorov 1972). Each reading is the best next one. After 5, 10, 20,
 *           40 ... readings those of the last block are exchanged for better ones, one after
 *           another, until none changes. So the first 5, 10, 20 ... of a plan are good plans too.
 * Accuracy  Rank-one updates of q and t in double precision, recomputed from P after each block of
 *           20 or more.
 * Speed     Rows are single precision. Updates of q and t are deferred until gains are needed: an
 *           exchange (one reading removed, one added) passes over the rows once. */
#include "expected_error_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

enum {
    LEAST_RENEWED = 20, /* readings after which q and t are computed anew */
    MOST_SWEEPS = 4,
    BLOCK_ROWS = 1024,
    LOSS_PARTS = 8,
    MOST_WAITING = 2 /* an exchange */
};

/* A pass over fewer values than this is made by one thread: sharing it gains less than is lost
 * where a processor is busy with something else, because every pass waits for the last thread. */
static const size_t FEW_VALUES = 4000000;

/* A reading that was added (sign 1) or removed (-1): P became P - sign g g'. */
typedef struct change {
    double *g;
    double *pwg; /* P W g with P before the change */
    double gwg;
    double sign;
} change;

typedef struct design {
    const gonio_i_expected_error_problem *problem;
    size_t rows;
    size_t k;
    double *p;      /* [k][k]: P */
    double *w;      /* [k][k]: W */
    double *half;   /* [k][k], above the diagonal not read: T of W = T + T', f W f' = 2 f T f' */
    double *q;      /* [rows] */
    double *t;      /* [rows] */
    double *vector; /* [2 + 2 MOST_WAITING][k]: f, W g, and the vectors of the changes */
    bool *taken;    /* [rows] */
    size_t *opened; /* [groups]: readings of each group */
    bool plain;     /* P is I: there is no reading yet */
    change waiting[MOST_WAITING];
    size_t waits;
} design;

static const float *row_of(const design *d, size_t row)
{
    return d->problem->f + row * d->k;
}

static double variance_of(const design *d, size_t row)
{
    return d->problem->row_variance != NULL ? d->problem->row_variance[row] : d->problem->variance;
}

/* What a reading costs: more if it is the first of its group. */
static double price_of(const design *d, size_t row)
{
    const gonio_i_expected_error_problem *problem = d->problem;
    const bool first = problem->price > 0.0 && d->opened[problem->group[row]] == 0;
    return first ? 1.0 + problem->price : 1.0;
}

static void copy_row(const design *d, size_t row, double *f)
{
    for (size_t j = 0; j < d->k; j++) {
        f[j] = (double)row_of(d, row)[j];
    }
}

static void multiply(const double *matrix, const double *x, size_t n, double *y)
{
    for (size_t i = 0; i < n; i++) {
        y[i] = gonio_i_dot(matrix + i * n, x, n);
    }
}

/* What W is the sum of. */
typedef struct weighted_rows {
    gonio_context *context;
    const float *f; /* [rows][k] */
    size_t rows;
    size_t k;
    const double *loss; /* [rows] */
} weighted_rows;

/* Adds the terms of W of every LOSS_PARTS-th block of rows, from block `part` on, to w. */
static gonio_status add_loss(const weighted_rows *r, size_t part, double *w)
{
    double *block = gonio_i_allocate(r->context, BLOCK_ROWS * r->k, sizeof *block);
    gonio_status status = block == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t first = part * BLOCK_ROWS; first < r->rows && status == GONIO_OK;
         first += (size_t)LOSS_PARTS * BLOCK_ROWS) {
        const size_t count = r->rows - first < BLOCK_ROWS ? r->rows - first : BLOCK_ROWS;
        for (size_t b = 0; b < count; b++) {
            const double root = sqrt(r->loss[first + b]);
            for (size_t j = 0; j < r->k; j++) {
                block[b * r->k + j] = root * (double)r->f[(first + b) * r->k + j];
            }
        }
        status = gonio_i_add_gram_rows(r->context, block, count, r->k, w);
    }
    free(block);
    return status;
}

/* Parts of W are added in the same order on any number of threads. */
gonio_status gonio_i_expected_error_weights(gonio_context *context, const float *f, size_t rows,
                                            size_t components, const double *loss, double *weights)
{
    const weighted_rows r = {context, f, rows, components, loss};
    const size_t size = components * components;
    gonio_status result = GONIO_OK;
    double *partial = gonio_i_allocate(context, LOSS_PARTS * size, sizeof *partial);
    if (partial == NULL) {
        return GONIO_ERROR_MEMORY;
    }
#pragma omp parallel for schedule(dynamic, 1) num_threads(gonio_context_threads(context))
    for (size_t part = 0; part < LOSS_PARTS; part++) {
        const gonio_status mine = add_loss(&r, part, partial + part * size);
        if (mine != GONIO_OK) {
#pragma omp atomic write
            result = mine;
        }
    }
    memset(weights, 0, size * sizeof *weights);
    for (size_t part = 0; part < LOSS_PARTS; part++) {
        for (size_t i = 0; i < size; i++) {
            weights[i] += partial[part * size + i];
        }
    }
    free(partial);
    gonio_i_mirror(weights, components);
    return result;
}

/* W and T. */
static gonio_status find_loss(design *d)
{
    const gonio_i_expected_error_problem *problem = d->problem;
    const size_t size = d->k * d->k;
    gonio_status status = GONIO_OK;
    if (problem->weights != NULL) {
        memcpy(d->w, problem->weights, size * sizeof *d->w);
    } else {
        status = gonio_i_expected_error_weights(problem->context, problem->f, problem->rows, d->k,
                                                problem->loss, d->w);
    }
    memcpy(d->half, d->w, size * sizeof *d->w);
    for (size_t i = 0; i < d->k; i++) {
        d->half[i * d->k + i] *= 0.5;
    }
    return status;
}

/* q and t of `count` rows, f[count][k]; fp, fpt: scratch of that size. */
static gonio_status find_block_gains(design *d, size_t first, size_t count, const double *f,
                                     double *fp, double *fpt)
{
    gonio_context *context = d->problem->context;
    const double *a = d->plain ? f : fp;
    gonio_status status = GONIO_OK;
    if (!d->plain) {
        status = gonio_i_product_transposed(context, f, count, d->k, d->p, d->k, fp, d->k);
    }
    if (status == GONIO_OK) {
        memcpy(fpt, a, count * d->k * sizeof *a);
        gonio_i_multiply_lower(fpt, count, d->k, d->half);
    }
    for (size_t i = 0; i < count && status == GONIO_OK; i++) {
        d->q[first + i] = gonio_i_dot(a + i * d->k, f + i * d->k, d->k);
        d->t[first + i] = 2.0 * gonio_i_dot(fpt + i * d->k, a + i * d->k, d->k);
    }
    return status;
}

/* q and t from P. */
static gonio_status find_gains(design *d)
{
    const size_t size = BLOCK_ROWS * d->k;
    gonio_status result = GONIO_OK;
#pragma omp parallel num_threads(gonio_context_threads(d->problem->context))
    {
        double *f = gonio_i_allocate(d->problem->context, 3 * size, sizeof *f);
        gonio_status mine = f == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
#pragma omp for schedule(dynamic, 1)
        for (size_t first = 0; first < d->rows; first += BLOCK_ROWS) {
            const size_t count = d->rows - first < BLOCK_ROWS ? d->rows - first : BLOCK_ROWS;
            for (size_t i = 0; i < count && mine == GONIO_OK; i++) {
                copy_row(d, first + i, f + i * d->k);
            }
            if (mine == GONIO_OK) {
                mine = find_block_gains(d, first, count, f, f + size, f + 2 * size);
            }
        }
        if (mine != GONIO_OK) {
#pragma omp atomic write
            result = mine;
        }
        free(f);
    }
    d->waits = 0;
    return result;
}

/* f g and f P W g of a row for the deferred changes. */
typedef struct seen_changes {
    double g[MOST_WAITING];
    double pwg[MOST_WAITING];
} seen_changes;

GONIO_I_VECTORISED static seen_changes see_one(const float *f, const change *c, size_t k)
{
    const double *g = c[0].g; /* in the loop the compiler would gather */
    const double *pwg = c[0].pwg;
    double a = 0.0;
    double b = 0.0;
#pragma omp simd reduction(+ : a, b)
    for (size_t j = 0; j < k; j++) {
        const double value = (double)f[j];
        a += value * g[j];
        b += value * pwg[j];
    }
    return (seen_changes){{a}, {b}};
}

GONIO_I_VECTORISED static seen_changes see_two(const float *f, const change *c, size_t k)
{
    const double *g = c[0].g;
    const double *pwg = c[0].pwg;
    const double *other_g = c[1].g;
    const double *other_pwg = c[1].pwg;
    double a = 0.0;
    double b = 0.0;
    double other_a = 0.0;
    double other_b = 0.0;
#pragma omp simd reduction(+ : a, b, other_a, other_b)
    for (size_t j = 0; j < k; j++) {
        const double value = (double)f[j];
        a += value * g[j];
        b += value * pwg[j];
        other_a += value * other_g[j];
        other_b += value * other_pwg[j];
    }
    return (seen_changes){{a, other_a}, {b, other_b}};
}

static int threads_of_a_pass(const design *d)
{
    return d->rows * d->k < FEW_VALUES ? 1 : gonio_context_threads(d->problem->context);
}

/* Applies the deferred changes to q and t. */
static void catch_up(design *d)
{
    const change *c = d->waiting;
    const size_t count = d->waits;
    if (count == 0) {
        return;
    }
#pragma omp parallel for schedule(static) num_threads(threads_of_a_pass(d))
    for (size_t x = 0; x < d->rows; x++) {
        const seen_changes seen =
            count == 1 ? see_one(row_of(d, x), c, d->k) : see_two(row_of(d, x), c, d->k);
        for (size_t i = 0; i < count; i++) {
            const double a = seen.g[i];
            d->t[x] += -2.0 * c[i].sign * a * seen.pwg[i] + a * a * c[i].gwg;
            d->q[x] -= c[i].sign * a * a;
        }
    }
    d->waits = 0;
}

/* P becomes P - sign g g', g = P f / (sign f P f' + sigma^2)^(1/2). The change of q and t is
 * deferred. */
static void update(design *d, size_t row, double sign)
{
    const size_t k = d->k;
    if (d->waits == MOST_WAITING) {
        catch_up(d);
    }
    change *c = &d->waiting[d->waits];
    double *f = d->vector;
    double *wg = d->vector + k;
    c->g = d->vector + (2 + 2 * d->waits) * k;
    c->pwg = c->g + k;
    c->sign = sign;
    copy_row(d, row, f);
    multiply(d->p, f, k, c->g);
    const double scale =
        1.0 / sqrt(fmax(variance_of(d, row) + sign * gonio_i_dot(f, c->g, k), 1e-12));
    for (size_t j = 0; j < k; j++) {
        c->g[j] *= scale;
    }
    multiply(d->w, c->g, k, wg);
    multiply(d->p, wg, k, c->pwg);
    c->gwg = gonio_i_dot(c->g, wg, k);
    for (size_t i = 0; i < k; i++) {
        for (size_t j = 0; j < k; j++) {
            d->p[i * k + j] -= sign * c->g[i] * c->g[j];
        }
    }
    d->plain = false;
    d->waits++;
}

/* The row whose reading gives the least loss, the first of equals. */
static size_t find_best(design *d)
{
    catch_up(d);
    size_t best = d->rows;
    double most = -INFINITY;
    for (size_t x = 0; x < d->rows; x++) {
        const double gain = d->t[x] / (fmax(d->q[x], 0.0) + variance_of(d, x)) / price_of(d, x);
        const bool free_row = !d->taken[x] && d->problem->allowed[x];
        if (free_row && gain > most) {
            most = gain;
            best = x;
        }
    }
    return best;
}

static void begin(design *d)
{
    const size_t k = d->k;
    const double *given = d->problem->covariance;
    for (size_t i = 0; i < k * k; i++) {
        d->p[i] = given != NULL ? given[i] : (double)(i % (k + 1) == 0);
    }
    d->plain = given == NULL;
}

static void take(design *d, size_t row)
{
    d->taken[row] = true;
    if (d->opened != NULL) {
        d->opened[d->problem->group[row]]++;
    }
    update(d, row, 1.0);
}

static void take_back(design *d, size_t row)
{
    d->taken[row] = false;
    if (d->opened != NULL) {
        d->opened[d->problem->group[row]]--;
    }
    update(d, row, -1.0);
}

/* Exchanges the readings from `first` to `end` - 1 for better ones. */
static gonio_status exchange(design *d, size_t *chosen, size_t first, size_t end)
{
    const int most = d->problem->sweeps == 0 ? MOST_SWEEPS : d->problem->sweeps;
    bool changed = true;
    gonio_status status = GONIO_OK;
    for (int sweeps = 0; sweeps < most && changed && status == GONIO_OK; sweeps++) {
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

/* Whether so little loss is left that rounding does not matter. */
static bool is_enough(const design *d)
{
    return gonio_i_dot(d->p, d->w, d->k * d->k) < (1.0 - 1e-6) * d->problem->enough;
}

/* Blocks do not change earlier ones, so that the search may end after any. */
static gonio_status choose_blocks(design *d, size_t *chosen, size_t *found)
{
    const gonio_i_expected_error_problem *problem = d->problem;
    gonio_status status = find_gains(d);
    size_t done = 0;
    size_t most = problem->count;
    for (size_t end = GONIO_I_FIRST_BLOCK; done < most && status == GONIO_OK; end *= 2) {
        const size_t first = done;
        for (; done < end && done < most; done++) {
            chosen[done] = find_best(d);
            take(d, chosen[done]);
        }
        status = exchange(d, chosen, first, done);
        most = is_enough(d) ? done : most;
        if (status == GONIO_OK && done >= LEAST_RENEWED && done < most) {
            status = find_gains(d);
        }
    }
    *found = done;
    return status;
}

/* trace(P W) before the first and after each reading, recomputed in order, because exchanges change
 * earlier values. */
static void find_remaining(design *d, const size_t *chosen, size_t count, double *remaining)
{
    const size_t k = d->k;
    begin(d);
    remaining[0] = gonio_i_dot(d->p, d->w, k * k);
    for (size_t n = 0; n < count; n++) {
        double *f = d->vector;
        double *g = d->vector + k;
        copy_row(d, chosen[n], f);
        multiply(d->p, f, k, g);
        const double s = variance_of(d, chosen[n]) + gonio_i_dot(f, g, k);
        for (size_t i = 0; i < k; i++) {
            for (size_t j = 0; j < k; j++) {
                d->p[i * k + j] -= g[i] * g[j] / s;
            }
        }
        remaining[n + 1] = gonio_i_dot(d->p, d->w, k * k);
    }
}

static void release(design *d)
{
    free(d->p);
    free(d->w);
    free(d->half);
    free(d->q);
    free(d->t);
    free(d->vector);
    free(d->taken);
    free(d->opened);
}

/* Matrices and, for a search, what it keeps of rows. To be released in any case. */
static gonio_status allocate(const gonio_i_expected_error_problem *problem, bool search, design *d)
{
    gonio_context *context = problem->context;
    const size_t k = problem->components;
    const size_t rows = problem->rows;
    *d = (design){.problem = problem,
                  .rows = problem->rows,
                  .k = k,
                  .p = gonio_i_allocate(context, k * k, sizeof *d->p),
                  .w = gonio_i_allocate(context, k * k, sizeof *d->w),
                  .half = gonio_i_allocate(context, k * k, sizeof *d->half),
                  .vector =
                      gonio_i_allocate(context, (2 + 2 * MOST_WAITING) * k, sizeof *d->vector)};
    bool done = d->p && d->w && d->half && d->vector;
    if (search) {
        d->q = gonio_i_allocate(context, rows, sizeof *d->q);
        d->t = gonio_i_allocate(context, rows, sizeof *d->t);
        d->taken = gonio_i_allocate(context, rows, sizeof *d->taken);
        done = done && d->q && d->t && d->taken;
    }
    if (search && problem->group != NULL) {
        d->opened = gonio_i_allocate(context, problem->groups, sizeof *d->opened);
        done = done && d->opened;
    }
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

gonio_status gonio_i_expected_error_search(const gonio_i_expected_error_problem *problem,
                                           size_t *chosen, double *remaining, size_t *found)
{
    size_t count = 0;
    design d;
    gonio_status status = allocate(problem, true, &d);
    if (status == GONIO_OK) {
        begin(&d);
        status = find_loss(&d);
    }
    if (status == GONIO_OK) {
        status = choose_blocks(&d, chosen, &count);
    }
    if (status == GONIO_OK && remaining != NULL) {
        find_remaining(&d, chosen, count, remaining);
    }
    if (status == GONIO_OK && found != NULL) {
        *found = count;
    }
    release(&d);
    return status;
}

gonio_status gonio_i_expected_error_remaining(const gonio_i_expected_error_problem *problem,
                                              const size_t *chosen, size_t count, double *remaining,
                                              double *covariance)
{
    design d;
    gonio_status status = allocate(problem, false, &d);
    if (status == GONIO_OK) {
        status = find_loss(&d);
    }
    if (status == GONIO_OK) {
        find_remaining(&d, chosen, count, remaining);
    }
    if (status == GONIO_OK && covariance != NULL) {
        memcpy(covariance, d.p, d.k * d.k * sizeof *covariance);
    }
    release(&d);
    return status;
}
