/* Checks of a basis from a file, before it is used: see gonio_i_basis_check. */
#include "basis.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/random.h"
#include "../linalg/linalg.h"

/* Logarithms of numbers stay below 710; these limits keep products of them finite as well. */
static const double LARGEST_MEAN = 1e4;
static const double LARGEST_VARIANCE = 1e16;
static const double ORTHONORMAL_LOADINGS = 1e-6; /* max |W'W - I| */

/* Fuzzing has to reach the code after the hashes. */
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
enum { HASHES_MAY_DIFFER = true };
#else
enum { HASHES_MAY_DIFFER = false };
#endif

typedef struct check {
    gonio_context *context;
    const char *path;
    const gonio_basis *basis;
} check;

static gonio_status damaged(const check *c, const char *what, const char *problem)
{
    return gonio_i_fail(c->context, GONIO_ERROR_FORMAT,
                        "%s: '%s' %s; learn the basis again with gonio learn", c->path, what,
                        problem);
}

static bool cells_in_order(const gonio_basis *basis)
{
    const int32_t end = gonio_grid_cells(basis->representation);
    int32_t last = -1;
    for (size_t k = 0; k < basis->cells; k++) {
        if (basis->cell[k] <= last || basis->cell[k] >= end) {
            return false;
        }
        last = basis->cell[k];
    }
    return basis->cells > 0;
}

/* Whether all values are within the limits. NaN is not. */
static bool all_within(const double *values, size_t count, double least, double most)
{
    bool within = true;
    for (size_t k = 0; k < count; k++) {
        within = within && values[k] >= least && values[k] <= most;
    }
    return within;
}

/* Whether variances descend. Computed ones may differ in the last digits. */
static bool descending(const double *values, size_t count)
{
    for (size_t k = 1; k < count; k++) {
        if (values[k] > values[k - 1] * (1.0 + 1e-12)) {
            return false;
        }
    }
    return true;
}

static bool parents_are_measured(const gonio_basis *basis)
{
    const size_t measured = gonio_i_columns_per_material(basis->channels) * basis->materials;
    for (size_t k = 0; basis->parents != NULL && k < 2 * basis->mixtures; k++) {
        if (basis->parents[k] < 0 || (size_t)basis->parents[k] >= measured) {
            return false;
        }
    }
    return true;
}

/* Checks W'W = I. Numbers that are not finite fail. */
static gonio_status check_loadings(const check *c)
{
    const size_t k = c->basis->components;
    if (c->basis->loadings == NULL) {
        return GONIO_OK;
    }
    double *gram = gonio_i_allocate(c->context, k * k, sizeof *gram);
    gonio_status status = gram == NULL
                              ? GONIO_ERROR_MEMORY
                              : gonio_i_gram_rows(c->context, c->basis->loadings,
                                                  gonio_i_basis_columns(c->basis), k, k, gram);
    for (size_t j = 0; j < k * k && status == GONIO_OK; j++) {
        if (!(fabs(gram[j] - (j % (k + 1) == 0 ? 1.0 : 0.0)) <= ORTHONORMAL_LOADINGS)) {
            status = damaged(c, "loadings", "are not orthonormal");
        }
    }
    free(gram);
    return status;
}

/* ---- V'V = I ---- */

/* Checks V'V x = x for a few vectors x of random signs. If V'V is not I, V'V x differs from x by
 * the length of a row of V'V - I. This takes two products with a vector instead of V'V. Blocks of
 * rows are summed in order, so the sum is the same on any number of threads. */
enum { VECTORS = 4, BLOCKS = 16 };

typedef struct vector_test {
    const gonio_basis *basis;
    double *x;   /* [VECTORS][K]: the vectors */
    double *sum; /* [BLOCKS][VECTORS][K]: V'V x */
    double *row; /* [BLOCKS][K]: scratch */
} vector_test;

/* sum += v (v'x). */
GONIO_I_VECTORISED static void add_row(const double *v, const double *x, size_t n, double *sum)
{
    double along = 0.0;
#pragma omp simd reduction(+ : along)
    for (size_t k = 0; k < n; k++) {
        along += v[k] * x[k];
    }
    for (size_t k = 0; k < n; k++) {
        sum[k] += along * v[k];
    }
}

static void add_block(const vector_test *p, size_t block)
{
    const size_t k = p->basis->components;
    const size_t first = p->basis->rows * block / BLOCKS;
    const size_t end = p->basis->rows * (block + 1) / BLOCKS;
    double *row = p->row + block * k;
    for (size_t i = first; i < end; i++) {
        gonio_i_basis_rows(p->basis, i, 1, k, row);
        for (size_t j = 0; j < VECTORS; j++) {
            add_row(row, p->x + j * k, k, p->sum + (block * VECTORS + j) * k);
        }
    }
}

static void draw_signs(double *x, size_t count)
{
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, 0);
    for (size_t k = 0; k < count; k++) {
        x[k] = gonio_i_random_uniform(&random) < 0.5 ? -1.0 : 1.0;
    }
}

/* Rounding V to single precision moves V'V x by at most K 2^-23. */
static bool products_agree(const vector_test *p)
{
    const size_t k = p->basis->components;
    const double tolerance = 2.0 * FLT_EPSILON * (double)k;
    for (size_t j = 0; j < VECTORS * k; j++) {
        double sum = 0.0;
        for (size_t block = 0; block < BLOCKS; block++) {
            sum += p->sum[block * VECTORS * k + j];
        }
        if (!(fabs(sum - p->x[j]) <= tolerance)) {
            return false;
        }
    }
    return true;
}

/* Checks V and computes its hash in parallel: both read all of V. */
static gonio_status read_vectors(const check *c, const vector_test *p, uint64_t *hash)
{
    const size_t size = c->basis->rows * c->basis->components * sizeof *c->basis->vectors;
    gonio_status status = GONIO_OK;
#pragma omp parallel for schedule(dynamic, 1) num_threads(gonio_context_threads(c->context))
    for (size_t block = 0; block <= BLOCKS; block++) {
        if (block == 0) {
            status = gonio_i_basis_hash(c->context, c->basis->vectors, size, hash);
        } else {
            add_block(p, block - 1);
        }
    }
    return status;
}

static gonio_status check_vectors(const check *c)
{
    uint64_t hash = 0;
    const size_t k = c->basis->components;
    const vector_test p = {.basis = c->basis,
                           .x = gonio_i_allocate(c->context, VECTORS * k, sizeof *p.x),
                           .sum = gonio_i_allocate(c->context, BLOCKS * VECTORS * k, sizeof *p.sum),
                           .row = gonio_i_allocate(c->context, BLOCKS * k, sizeof *p.row)};
    gonio_status status =
        p.x == NULL || p.sum == NULL || p.row == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        draw_signs(p.x, VECTORS * k);
        status = read_vectors(c, &p, &hash);
    }
    if (status == GONIO_OK && !HASHES_MAY_DIFFER && hash != c->basis->vectors_checksum) {
        status = damaged(c, "components", "are not those of the checksum (the file was changed)");
    }
    if (status == GONIO_OK && !products_agree(&p)) {
        status = damaged(c, "components", "are not orthonormal");
    }
    free(p.x);
    free(p.sum);
    free(p.row);
    return status;
}

gonio_status gonio_i_basis_check(gonio_context *context, const char *path, const gonio_basis *basis)
{
    const check c = {context, path, basis};
    if (!cells_in_order(basis)) {
        return damaged(&c, "cell", "is not a rising list of cells of the grid");
    }
    if (!all_within(basis->mean, basis->rows, -LARGEST_MEAN, LARGEST_MEAN)) {
        return damaged(&c, "mean", "holds a number that is no logarithm of a BRDF");
    }
    if (!all_within(basis->variances, basis->variance_count, 0.0, LARGEST_VARIANCE) ||
        !descending(basis->variances, basis->variance_count)) {
        return damaged(&c, "variances", "are not descending numbers from 0 on");
    }
    if (!parents_are_measured(basis)) {
        return damaged(&c, "mixture_parents", "names a column that no material has");
    }
    const gonio_status status = check_loadings(&c);
    return status == GONIO_OK ? check_vectors(&c) : status;
}
