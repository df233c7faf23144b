/* The principal components of the observation matrix, out of core: see principal_components.h.
 *
 * Given    H, read in tiles of rows
 * Returned m, the top K left singular vectors V of H - m, and all lambda_k = S_k^2/(columns - 1)
 * Method   G = (H - m)'(H - m) tile by tile, G = W S^2 W', V = (H - m) W S^-1 (Ali et al.,
 *          sec. 3.6)
 * Accuracy G squares the condition number, which costs V some orthogonality. V'V is summed while V
 *          is made; where it is not I to `ORTHOGONAL`, dividing V by the Cholesky factor of V'V
 *          restores it to rounding. */
#include "principal_components.h"

#include <math.h>
#include <stdlib.h>

#include "../linalg/linalg.h"
#include "centred_tiles.h"

static const double ORTHOGONAL = 1e-11; /* max |V'V - I| */

/* G of a tile. */
static gonio_status add_gram(const gonio_i_learner *l, gonio_i_row_range rows,
                             const gonio_i_tile_workspace *w, const double *p)
{
    (void)p;
    return gonio_i_add_gram_columns(l->context, w->h, rows.count, l->columns, w->part);
}

/* V of a tile is (H - m) P, P (columns x K) = W S^-1; and its V'V. */
static gonio_status project(const gonio_i_learner *l, gonio_i_row_range rows,
                            const gonio_i_tile_workspace *w, const double *p)
{
    const size_t k = l->basis->components;
    double *v = l->vectors + rows.first * k;
    const gonio_status status =
        gonio_i_product_columns(l->context, w->h, rows.count, l->columns, p, k, v);
    return status == GONIO_OK ? gonio_i_add_gram_rows(l->context, v, rows.count, k, w->part)
                              : status;
}

/* max |C - I| over the upper triangle. */
static double distance_from_identity(const double *c, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = i; j < n; j++) {
            most = fmax(most, fabs(c[i * n + j] - (i == j ? 1.0 : 0.0)));
        }
    }
    return most;
}

/* The number of rows of V that are processed together. */
enum { BLOCK_ROWS = 4096 };

static size_t block_rows(const gonio_basis *basis, size_t block)
{
    const size_t left = basis->rows - block * BLOCK_ROWS;
    return left < BLOCK_ROWS ? left : BLOCK_ROWS;
}

/* V becomes V L'^-1, V'V = L L' = c (upper triangle, overwritten), if it needs that. */
static gonio_status orthonormalise(const gonio_i_learner *l, double *c)
{
    gonio_basis *basis = l->basis;
    const size_t k = basis->components;
    if (distance_from_identity(c, k) <= ORTHOGONAL) {
        return GONIO_OK;
    }
    gonio_i_mirror(c, k);
    const gonio_status status = gonio_i_cholesky(l->context, c, k);
    if (status != GONIO_OK) {
        return status;
    }
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(l->context))
    for (size_t block = 0; block < (basis->rows + BLOCK_ROWS - 1) / BLOCK_ROWS; block++) {
        gonio_i_divide_triangle(l->vectors + block * BLOCK_ROWS * k, block_rows(basis, block), k,
                                c);
    }
    return GONIO_OK;
}

/* The entry of largest absolute value in each of the k columns of v, the first of equals. */
GONIO_I_VECTORISED static void find_largest(const double *v, size_t rows, size_t k, double *largest)
{
    for (size_t i = 0; i < rows; i++) {
        for (size_t j = 0; j < k; j++) {
            const double x = v[i * k + j];
            largest[j] = fabs(x) > fabs(largest[j]) ? x : largest[j];
        }
    }
}

GONIO_I_VECTORISED static void scale_columns(double *v, size_t rows, size_t k, const double *factor)
{
    for (size_t i = 0; i < rows; i++) {
        for (size_t j = 0; j < k; j++) {
            v[i * k + j] *= factor[j];
        }
    }
}

/* An eigenvector's sign is arbitrary: make the largest entry positive. */
static gonio_status fix_signs(const gonio_i_learner *l)
{
    gonio_basis *basis = l->basis;
    const size_t k = basis->components;
    const size_t blocks = (basis->rows + BLOCK_ROWS - 1) / BLOCK_ROWS;
    double *largest = gonio_i_allocate(l->context, (blocks + 1) * k, sizeof *largest);
    if (largest == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    double *sign = largest + blocks * k;
#pragma omp parallel num_threads(gonio_context_threads(l->context))
    {
#pragma omp for schedule(static)
        for (size_t block = 0; block < blocks; block++) {
            find_largest(l->vectors + block * BLOCK_ROWS * k, block_rows(basis, block), k,
                         largest + block * k);
        }
#pragma omp single
        {
            find_largest(largest, blocks, k, sign);
            for (size_t j = 0; j < k; j++) {
                sign[j] = sign[j] < 0.0 ? -1.0 : 1.0;
            }
        }
#pragma omp for schedule(static)
        for (size_t block = 0; block < blocks; block++) {
            scale_columns(l->vectors + block * BLOCK_ROWS * k, block_rows(basis, block), k, sign);
        }
    }
    scale_columns(basis->loadings, l->columns, k, sign);
    free(largest);
    return GONIO_OK;
}

/* From the eigenvalues (ascending) and eigenvectors (rows) of G: the variances, W and P = W S^-1.
 */
static gonio_status split_gram(const gonio_i_learner *l, const double *w, const double *values,
                               double *p)
{
    const size_t n = l->columns;
    const double noise = values[n - 1] * 1e-13 * (double)n;
    size_t rank = 0;
    for (size_t j = 0; j < l->basis->variance_count; j++) {
        const double value = fmax(values[n - 1 - j], 0.0);
        l->basis->variances[j] = value / (double)(n - 1);
        rank += value > noise;
    }
    if (l->any_rank && rank < l->basis->components) {
        l->basis->components = rank;
    }
    const size_t k = l->basis->components;
    if (rank < k || k == 0) {
        return gonio_i_fail(l->context, GONIO_ERROR_DATA,
                            "the materials span only %zu dimensions%s, %zu components "
                            "were asked for; are some of them copies of others?",
                            rank, l->basis->without_mean ? "" : " around their mean", k);
    }
    for (size_t j = 0; j < k; j++) {
        for (size_t i = 0; i < n; i++) {
            l->basis->loadings[i * k + j] = w[(n - 1 - j) * n + i];
            p[i * k + j] = w[(n - 1 - j) * n + i] / sqrt(values[n - 1 - j]);
        }
    }
    return GONIO_OK;
}

static gonio_status decompose(const gonio_i_learner *l)
{
    const size_t n = l->columns;
    size_t k = l->basis->components;
    double *gram = gonio_i_allocate(l->context, n * n, sizeof *gram);
    double *values = gonio_i_allocate(l->context, n, sizeof *values);
    double *p = gonio_i_allocate(l->context, n * k, sizeof *p);
    double *c = gonio_i_allocate(l->context, k * k, sizeof *c);
    gonio_status status = gram == NULL || values == NULL || p == NULL || c == NULL
                              ? GONIO_ERROR_MEMORY
                              : gonio_i_for_each_centred_tile(l, add_gram, NULL, gram, n);
    if (status == GONIO_OK) {
        gonio_i_mirror(gram, n);
        status = gonio_i_eigen(l->context, gram, n, true, values);
    }
    if (status == GONIO_OK) {
        status = split_gram(l, gram, values, p);
    }
    if (status == GONIO_OK) {
        k = l->basis->components;
        status = gonio_i_for_each_centred_tile(l, project, p, c, k);
    }
    if (status == GONIO_OK) {
        status = orthonormalise(l, c);
    }
    free(gram);
    free(values);
    free(p);
    free(c);
    return status;
}

gonio_status gonio_i_find_components(const gonio_i_learner *l)
{
    const gonio_status status = decompose(l);
    return status == GONIO_OK ? fix_signs(l) : status;
}
