/* Learning: mean and principal components of the observation matrix, out of core.
 *
 * Given    H, read in blocks of rows
 * Returned m, the top K left singular vectors V of H - m, and all lambda_k = S_k^2/(columns - 1)
 * Method   G = (H - m)'(H - m) block by block, G = W S^2 W', V = (H - m) W S^-1 (Ali et al.,
 * sec. 3.6) Accuracy G squares the condition number, which costs V some orthogonality; dividing V
 * by the Cholesky factor of V'V restores it to rounding. The blocks and the order in which they are
 * added depend on the matrix only, never on the threads. */
#include "basis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

enum { BLOCK_VALUES = 1 << 18 }; /* 2 MiB of doubles a block and thread */

typedef struct learner {
    gonio_context *context;
    const gonio_database *database;
    gonio_database_view view;
    const size_t *subset; /* of its materials; NULL for all */
    size_t materials;
    size_t columns;
    gonio_basis *basis;
    size_t block; /* rows a block */
    size_t blocks;
} learner;

void gonio_basis_options_default(gonio_basis_options *options)
{
    *options = (gonio_basis_options){0};
}

static size_t block_rows(const learner *l, size_t block)
{
    const size_t first = block * l->block;
    return l->view.rows - first < l->block ? l->view.rows - first : l->block;
}

/* Reads a block of rows and takes the mean of each row out of it. */
static gonio_status read_centred(const learner *l, size_t block, double *h)
{
    const size_t count = block_rows(l, block);
    const size_t first = block * l->block;
    const gonio_status status =
        gonio_database_read_rows(l->database, l->context, first, count, l->subset, l->materials, h);
    if (status != GONIO_OK) {
        return status;
    }
    double *mean = l->basis->mean + first;
    memset(mean, 0, count * sizeof *mean);
    for (size_t j = 0; j < l->columns; j++) {
        for (size_t i = 0; i < count; i++) {
            mean[i] += h[j * count + i];
        }
    }
    for (size_t i = 0; i < count; i++) {
        mean[i] /= (double)l->columns;
    }
    for (size_t j = 0; j < l->columns; j++) {
        for (size_t i = 0; i < count; i++) {
            h[j * count + i] -= mean[i];
        }
    }
    return GONIO_OK;
}

/* G, summed over the blocks in order. */
static gonio_status accumulate_gram(const learner *l, double *gram)
{
    const size_t n = l->columns;
    gonio_status result = GONIO_OK;
#pragma omp parallel num_threads(gonio_context_threads(l->context))
    {
        double *h = gonio_i_allocate(l->context, l->block * n, sizeof *h);
        double *part = gonio_i_allocate(l->context, n * n, sizeof *part);
        gonio_status mine = h != NULL && part != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
#pragma omp for ordered schedule(static, 1)
        for (size_t block = 0; block < l->blocks; block++) {
            if (mine == GONIO_OK) {
                mine = read_centred(l, block, h);
            }
            if (mine == GONIO_OK) {
                mine = gonio_i_gram_columns(l->context, h, block_rows(l, block), n, part);
            }
#pragma omp ordered
            {
                for (size_t k = 0; k < n * n && mine == GONIO_OK; k++) {
                    gram[k] += part[k];
                }
                result = mine != GONIO_OK ? mine : result;
            }
        }
        free(h);
        free(part);
    }
    return result;
}

/* V = (H - m) P, block by block, P (columns x K) = W S^-1. */
static gonio_status project(const learner *l, const double *p)
{
    const size_t n = l->columns;
    const size_t k = l->basis->components;
    gonio_status result = GONIO_OK;
#pragma omp parallel num_threads(gonio_context_threads(l->context))
    {
        double *h = gonio_i_allocate(l->context, l->block * n, sizeof *h);
        gonio_status mine = h != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
#pragma omp for schedule(dynamic)
        for (size_t block = 0; block < l->blocks; block++) {
            if (mine == GONIO_OK) {
                mine = read_centred(l, block, h);
            }
            if (mine == GONIO_OK) {
                mine = gonio_i_product_columns(l->context, h, block_rows(l, block), n, p, k,
                                               l->basis->vectors + block * l->block * k);
            }
        }
        free(h);
#pragma omp critical(gonio_project)
        result = mine != GONIO_OK ? mine : result;
    }
    return result;
}

static gonio_status orthonormalise(const learner *l)
{
    gonio_basis *basis = l->basis;
    const size_t k = basis->components;
    double *c = gonio_i_allocate(l->context, k * k, sizeof *c);
    if (c == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = gonio_i_gram_rows(l->context, basis->vectors, basis->rows, k, k, c);
    if (status == GONIO_OK) {
        status = gonio_i_divide_cholesky(l->context, basis->vectors, basis->rows, k, c);
    }
    free(c);
    return status;
}

/* An eigenvector's sign is arbitrary: make the largest entry positive. */
static void fix_signs(gonio_basis *basis)
{
    const size_t k = basis->components;
    for (size_t j = 0; j < k; j++) {
        double largest = 0.0;
        for (size_t i = 0; i < basis->rows; i++) {
            const double v = basis->vectors[i * k + j];
            largest = fabs(v) > fabs(largest) ? v : largest;
        }
        for (size_t i = 0; i < basis->rows && largest < 0.0; i++) {
            basis->vectors[i * k + j] = -basis->vectors[i * k + j];
        }
    }
}

/* From the eigenvalues (ascending) and eigenvectors (rows) of G: the variances and P = W S^-1. */
static gonio_status split_gram(const learner *l, const double *w, const double *values, double *p)
{
    const size_t n = l->columns;
    const size_t k = l->basis->components;
    const double noise = values[n - 1] * 1e-13 * (double)n;
    size_t rank = 0;
    for (size_t j = 0; j < n - 1; j++) {
        const double value = fmax(values[n - 1 - j], 0.0);
        l->basis->variances[j] = value / (double)(n - 1);
        rank += value > noise;
    }
    if (rank < k) {
        return gonio_i_fail(
            l->context, GONIO_ERROR_DATA,
            "the materials span only %zu dimensions around their mean, %zu components "
            "were asked for; are some of them copies of others?",
            rank, k);
    }
    for (size_t j = 0; j < k; j++) {
        for (size_t i = 0; i < n; i++) {
            p[i * k + j] = w[(n - 1 - j) * n + i] / sqrt(values[n - 1 - j]);
        }
    }
    return GONIO_OK;
}

static gonio_status decompose(const learner *l)
{
    const size_t n = l->columns;
    double *gram = gonio_i_allocate(l->context, n * n, sizeof *gram);
    double *values = gonio_i_allocate(l->context, n, sizeof *values);
    double *p = gonio_i_allocate(l->context, n * l->basis->components, sizeof *p);
    gonio_status status =
        gram == NULL || values == NULL || p == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = accumulate_gram(l, gram);
    }
    if (status == GONIO_OK) {
        status = gonio_i_eigen(l->context, gram, n, true, values);
    }
    if (status == GONIO_OK) {
        status = split_gram(l, gram, values, p);
    }
    if (status == GONIO_OK) {
        status = project(l, p);
    }
    free(gram);
    free(values);
    free(p);
    return status;
}

static gonio_status describe_origin(const learner *l)
{
    gonio_basis *basis = l->basis;
    basis->representation = l->view.representation;
    memcpy(basis->cell, l->view.cell, basis->cells * sizeof *basis->cell);
    basis->program = gonio_i_format("gonio %s", gonio_version());
    bool done = basis->program != NULL;
    for (size_t k = 0; k < basis->materials; k++) {
        const size_t material = l->subset != NULL ? l->subset[k] : k;
        basis->fingerprints[k] = l->view.fingerprints[material];
        basis->names[k] = strdup(l->view.names[material]);
        done = done && basis->names[k] != NULL;
    }
    return done ? GONIO_OK : gonio_i_fail(l->context, GONIO_ERROR_MEMORY, "out of memory");
}

static gonio_status learn(const learner *l)
{
    gonio_status status = describe_origin(l);
    if (status == GONIO_OK) {
        status = decompose(l);
    }
    if (status == GONIO_OK) {
        status = orthonormalise(l);
    }
    if (status == GONIO_OK) {
        fix_signs(l->basis);
        status = gonio_i_basis_finish(l->context, l->basis);
    }
    return status;
}

/* K: what was asked for, or as many as the default and the columns allow. */
static gonio_status choose_components(gonio_context *context, size_t columns, size_t asked,
                                      size_t *components)
{
    if (columns < 2) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a basis needs at least 2 materials, there is %zu", columns);
    }
    if (asked > columns - 1) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu components asked for, but %zu columns give at most %zu; add "
                            "materials or ask for fewer components",
                            asked, columns, columns - 1);
    }
    const size_t most =
        columns - 1 < GONIO_DEFAULT_COMPONENTS ? columns - 1 : GONIO_DEFAULT_COMPONENTS;
    *components = asked > 0 ? asked : most;
    return GONIO_OK;
}

gonio_status gonio_basis_learn(gonio_context *context, const gonio_database *database,
                               const gonio_basis_options *options, gonio_basis **basis)
{
    gonio_basis_options defaults;
    gonio_basis_options_default(&defaults);
    options = options != NULL ? options : &defaults;
    learner l = {.context = context, .database = database, .subset = options->subset};
    l.view = gonio_database_describe(database);
    l.materials = l.subset != NULL ? options->subset_count : l.view.materials;
    l.columns = l.view.columns / l.view.materials * l.materials;
    size_t components = 0;
    gonio_status status = choose_components(context, l.columns, options->components, &components);
    if (status != GONIO_OK) {
        return status;
    }
    l.block = BLOCK_VALUES / l.columns > 0 ? BLOCK_VALUES / l.columns : 1;
    l.blocks = (l.view.rows + l.block - 1) / l.block;
    l.basis = gonio_i_basis_allocate(context, l.materials, l.view.cells, l.view.channels,
                                     components, l.columns - 1);
    if (l.basis == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    l.context = gonio_i_team_begin(context);
    status = learn(&l);
    gonio_i_team_end(l.context, context);
    if (status != GONIO_OK) {
        gonio_basis_free(&l.basis);
        return status;
    }
    *basis = l.basis;
    return GONIO_OK;
}
