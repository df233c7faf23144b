/* FROST (Miandji et al. 2024): rows by simultaneous orthogonal matching pursuit (Tropp et al.
 * 2006).
 *
 * A position of the grid is a column of D = S^-1 V' (first n components), of length 1 after
 * normalisation; the target is the leading n x n block of W'. Each step takes the column with the
 * largest sum of correlations with the residual of the target, and projects the residual onto the
 * complement of the chosen columns. n steps give n rows. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

#include "../basis/basis.h"
#include "../linalg/linalg.h"
#include "method.h"

enum { BLOCK_ROWS = 1024 };

typedef struct pursuit {
    const gonio_i_selection_problem *problem;
    size_t n;
    double *inverse;  /* [n]: 1/S */
    double *length;   /* [rows]: of the columns of S^-1 V' */
    double *target;   /* [material][component], n x n: the residual */
    double *weights;  /* the same over S */
    double *found;    /* [step][component]: orthonormal directions of the chosen columns */
    double *products; /* [threads][BLOCK_ROWS][n] */
    bool *taken;      /* [rows] */
    int threads;
} pursuit;

/* ---- lengths ---- */

GONIO_I_VECTORISED static double length_of(const double *row, const double *inverse, size_t n)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t k = 0; k < n; k++) {
        sum += row[k] * inverse[k] * (row[k] * inverse[k]);
    }
    return sqrt(sum);
}

static void find_lengths(const pursuit *p)
{
#pragma omp parallel for schedule(static) num_threads(p->threads)
    for (size_t i = 0; i < p->problem->rows; i++) {
        p->length[i] = length_of(gonio_i_row(p->problem, i), p->inverse, p->n);
    }
}

/* ---- one step ---- */

typedef struct candidate {
    double score; /* -1: none */
    size_t row;
} candidate;

static candidate better(candidate a, candidate b)
{
    const bool second = b.score > a.score || (b.score == a.score && b.row < a.row);
    return second ? b : a;
}

GONIO_I_VECTORISED static double absolute_sum(const double *x, size_t n)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t k = 0; k < n; k++) {
        sum += fabs(x[k]);
    }
    return sum;
}

/* The best of a block of rows; products: scratch. */
static candidate best_of_block(const pursuit *p, size_t first, double *products,
                               gonio_status *status)
{
    const size_t left = p->problem->rows - first;
    const size_t count = left < BLOCK_ROWS ? left : BLOCK_ROWS;
    candidate best = {-1.0, first};
    *status = gonio_i_product_rows(p->problem->context, gonio_i_row(p->problem, first), count, p->n,
                                   p->problem->stride, p->weights, p->n, products);
    for (size_t i = 0; i < count && *status == GONIO_OK; i++) {
        const size_t row = first + i;
        if (!p->taken[row] && p->length[row] > 0.0) {
            const double score = absolute_sum(products + i * p->n, p->n) / p->length[row];
            best = better(best, (candidate){score, row});
        }
    }
    return best;
}

/* The column with the largest correlation with the residual, the first of equals. */
static gonio_status find_best(const pursuit *p, size_t *row)
{
    candidate best = {-1.0, SIZE_MAX};
    gonio_status result = GONIO_OK;
    const size_t blocks = (p->problem->rows + BLOCK_ROWS - 1) / BLOCK_ROWS;
    for (size_t j = 0; j < p->n * p->n; j++) {
        p->weights[j] = p->target[j] * p->inverse[j % p->n];
    }
#pragma omp parallel num_threads(p->threads)
    {
        candidate mine = {-1.0, SIZE_MAX};
        double *products = p->products + (size_t)omp_get_thread_num() * BLOCK_ROWS * p->n;
#pragma omp for schedule(static)
        for (size_t block = 0; block < blocks; block++) {
            gonio_status status = GONIO_OK;
            mine = better(mine, best_of_block(p, block * BLOCK_ROWS, products, &status));
            if (status != GONIO_OK) {
#pragma omp atomic write
                result = status;
            }
        }
#pragma omp critical(gonio_frost_best)
        best = better(best, mine);
    }
    if (result == GONIO_OK && !(best.score >= 0.0)) {
        result = gonio_i_fail(p->problem->context, GONIO_ERROR_DATA,
                              "the rows of the basis do not span %zu dimensions", p->n);
    }
    *row = best.row;
    return result;
}

static double dot(const double *x, const double *y, size_t n)
{
    double sum = 0.0;
    for (size_t k = 0; k < n; k++) {
        sum += x[k] * y[k];
    }
    return sum;
}

/* x becomes x - (x'q) q. */
static void take_out(const double *q, size_t n, double *x)
{
    const double along = dot(x, q, n);
    for (size_t k = 0; k < n; k++) {
        x[k] -= along * q[k];
    }
}

/* Removes the component along a chosen column from the residual. The column is orthogonalised
 * twice: once loses digits if the column is nearly in the span of the earlier ones. */
static void take_column(const pursuit *p, size_t step, size_t row)
{
    const size_t n = p->n;
    double *q = p->found + step * n;
    for (size_t k = 0; k < n; k++) {
        q[k] = gonio_i_row(p->problem, row)[k] * p->inverse[k] / p->length[row];
    }
    for (size_t j = 0; j < 2 * step; j++) {
        take_out(p->found + j % step * n, n, q);
    }
    const double length = sqrt(dot(q, q, n));
    for (size_t k = 0; k < n; k++) {
        q[k] = length > 1e-14 ? q[k] / length : 0.0;
    }
    for (size_t material = 0; material < n; material++) {
        take_out(q, n, p->target + material * n);
    }
}

static gonio_status pursue(const pursuit *p, size_t *chosen)
{
    gonio_status status = GONIO_OK;
    for (size_t step = 0; step < p->n && status == GONIO_OK; step++) {
        status = find_best(p, &chosen[step]);
        if (status == GONIO_OK) {
            p->taken[chosen[step]] = true;
            take_column(p, step, chosen[step]);
            status = gonio_i_progress(p->problem->context, "planning",
                                      (double)(step + 1) / (double)p->n);
        }
    }
    return status;
}

/* ---- all of it ---- */

static bool allocate_pursuit(const gonio_i_selection_problem *problem, pursuit *p)
{
    gonio_context *context = problem->context;
    const size_t n = problem->count;
    p->problem = problem;
    p->n = n;
    p->threads = gonio_context_threads(context);
    p->inverse = gonio_i_allocate(context, n, sizeof *p->inverse);
    p->length = gonio_i_allocate(context, problem->rows, sizeof *p->length);
    p->target = gonio_i_allocate(context, n * n, sizeof *p->target);
    p->weights = gonio_i_allocate(context, n * n, sizeof *p->weights);
    p->found = gonio_i_allocate(context, n * n, sizeof *p->found);
    p->products =
        gonio_i_allocate(context, (size_t)p->threads * BLOCK_ROWS * n, sizeof *p->products);
    p->taken = gonio_i_allocate(context, problem->rows, sizeof *p->taken);
    return p->inverse != NULL && p->length != NULL && p->target != NULL && p->weights != NULL &&
           p->found != NULL && p->products != NULL && p->taken != NULL;
}

static void free_pursuit(pursuit *p)
{
    free(p->inverse);
    free(p->length);
    free(p->target);
    free(p->weights);
    free(p->found);
    free(p->products);
    free(p->taken);
}

/* The leading n x n of W', 1/S, and the lengths. */
static void begin(const pursuit *p)
{
    const gonio_basis_view *basis = p->problem->basis;
    for (size_t k = 0; k < p->n; k++) {
        p->inverse[k] = 1.0 / gonio_i_singular_value(basis, k);
        for (size_t material = 0; material < p->n; material++) {
            p->target[material * p->n + k] = basis->loadings[material * basis->components + k];
        }
    }
    find_lengths(p);
}

static gonio_status check(const gonio_i_selection_problem *problem)
{
    if (problem->count > problem->components) {
        return gonio_i_fail(problem->context, GONIO_ERROR_ARGUMENT,
                            "frost plans a reading for each component: %zu readings need a basis "
                            "with as many (gonio learn --components %zu), this one has %zu",
                            problem->count, problem->count, problem->components);
    }
    return GONIO_OK;
}

static gonio_status select_frost(const gonio_i_selection_problem *problem,
                                 gonio_i_selection *selection)
{
    gonio_status status = check(problem);
    if (status != GONIO_OK) {
        return status;
    }
    pursuit p = {0};
    status = allocate_pursuit(problem, &p) ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        begin(&p);
        status = pursue(&p, selection->chosen);
    }
    if (status == GONIO_OK) {
        gonio_i_sort_rows(selection->chosen, problem->count);
        status = gonio_i_scaled_condition(problem, selection->chosen, &selection->condition_number);
    }
    if (status == GONIO_OK) {
        status = gonio_i_selection_record(problem, selection, 0, 0, selection->condition_number);
    }
    free_pursuit(&p);
    return status;
}

const gonio_i_method gonio_i_frost_method = {
    .name = "frost",
    .summary = "matching pursuit of the materials (FROST, Miandji et al. 2024)",
    .reconstruction = "ridge",
    .basis = GONIO_I_RELATIVE_BASIS,
    .needs = GONIO_I_NEEDS_LOADINGS,
    .where_it_lacks = "frost needs the loadings of the materials, which this basis lacks: it is "
                      "from before gonio kept them; learn it again with gonio learn",
    .few_components = true,
    .select = select_frost,
};
