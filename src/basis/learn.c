/* Learning: mean and principal components of the observation matrix, out of core.
 *
 * Given    H, read in tiles of rows
 * Returned m, the top K left singular vectors V of H - m, and all lambda_k = S_k^2/(columns - 1)
 * Method   G = (H - m)'(H - m) tile by tile, G = W S^2 W', V = (H - m) W S^-1 (Ali et al.,
 *          sec. 3.6)
 * Accuracy G squares the condition number, which costs V some orthogonality. V'V is summed while V
 *          is made; where it is not I to `ORTHOGONAL`, dividing V by the Cholesky factor of V'V
 *          restores it to rounding.
 * The tiles and the order of their sums depend on the matrix only, not on the threads.
 */
#include "basis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/options.h"
#include "../database/tiles.h"
#include "../linalg/linalg.h"
#include "mixtures.h"

/* Tiles that one thread sums before it waits to add its sum to the total. Batches are added in
 * order. */
enum { TILES_A_BATCH = 8 };

static const double ORTHOGONAL = 1e-11; /* max |V'V - I| */

typedef struct learner {
    gonio_context *context;
    const gonio_database *database;
    const gonio_database_view *view;
    const size_t *subset; /* of its materials; NULL for all */
    size_t materials;
    size_t columns;                   /* with mixtures */
    size_t measured;                  /* columns of the materials, which come first */
    const gonio_i_mixtures *mixtures; /* NULL without */
    double weight[2];                 /* of a measured column and of a mixture; on average 1 */
    bool any_rank;                    /* fewer components than asked for are accepted */
    gonio_basis *basis;
    double *vectors; /* V before it is rounded */
    size_t tiles;
    size_t batches;
    size_t *finished; /* batches, over all passes */
} learner;

void gonio_basis_options_default_of(gonio_basis_options *options, size_t size)
{
    const gonio_basis_options usual = {.mixtures = GONIO_USUAL_MIXTURES};
    gonio_i_give(&usual, sizeof usual, options, size);
}

/* Buffers of a thread. */
typedef struct workspace {
    float *values; /* a tile, [column][row] */
    double *h;     /* the same, less m */
    double *part;  /* of a sum over tiles, [columns][columns] */
} workspace;

static bool make_workspace(const learner *l, workspace *w)
{
    const size_t values = gonio_i_database_tile_room(l->database) * l->columns;
    w->values = gonio_i_allocate(l->context, values, sizeof *w->values);
    w->h = gonio_i_allocate(l->context, values, sizeof *w->h);
    w->part = gonio_i_allocate(l->context, l->columns * l->columns, sizeof *w->part);
    return w->values != NULL && w->h != NULL && w->part != NULL;
}

static void free_workspace(workspace *w)
{
    free(w->values);
    free(w->h);
    free(w->part);
}

/* Adds columns times a weight. */
GONIO_I_VECTORISED static void add_columns(const float *values, size_t rows, size_t columns,
                                           double weight, double *sum)
{
    for (size_t j = 0; j < columns; j++) {
        for (size_t i = 0; i < rows; i++) {
            sum[i] += weight * (double)values[j * rows + i];
        }
    }
}

static void find_means(const learner *l, const float *values, size_t rows, double *mean)
{
    memset(mean, 0, rows * sizeof *mean);
    add_columns(values, rows, l->measured, l->weight[0], mean);
    add_columns(values + l->measured * rows, rows, l->columns - l->measured, l->weight[1], mean);
    for (size_t i = 0; i < rows; i++) {
        mean[i] /= (double)l->columns;
    }
}

GONIO_I_VECTORISED static void subtract_means(const float *values, size_t rows, size_t columns,
                                              const double *mean, double factor, double *h)
{
    for (size_t j = 0; j < columns; j++) {
        for (size_t i = 0; i < rows; i++) {
            h[j * rows + i] = factor * ((double)values[j * rows + i] - mean[i]);
        }
    }
}

/* H - m, each column times the root of its weight. */
static void centre(const learner *l, const workspace *w, size_t rows, const double *mean)
{
    const size_t after = l->measured * rows;
    subtract_means(w->values, rows, l->measured, mean, sqrt(l->weight[0]), w->h);
    subtract_means(w->values + after, rows, l->columns - l->measured, mean, sqrt(l->weight[1]),
                   w->h + after);
}

static int compare_values(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median of sorted g = ln(1 + x). Between two middle values it is the g of the mean of their x.
 */
static double median_of(const double *sorted, size_t count)
{
    const double upper = sorted[count / 2];
    if (count % 2 == 1) {
        return upper;
    }
    return log1p(0.5 * (expm1(sorted[count / 2 - 1]) + expm1(upper)));
}

/* The median of each row; `row` is scratch of `columns` values. */
static void find_medians(const float *values, size_t rows, size_t columns, double *row,
                         double *median)
{
    for (size_t i = 0; i < rows; i++) {
        for (size_t j = 0; j < columns; j++) {
            row[j] = (double)values[j * rows + i];
        }
        qsort(row, columns, sizeof *row, compare_values);
        median[i] = median_of(row, columns);
    }
}

/* m of a tile's rows; without mean and relation it is 0, as allocated. */
static void find_origin(const learner *l, gonio_i_row_range rows, const workspace *w)
{
    double *mean = l->basis->mean + rows.first;
    if (!l->basis->without_mean) {
        find_means(l, w->values, rows.count, mean);
    } else if (l->basis->mapping == GONIO_LOG_RELATIVE) {
        find_medians(w->values, rows.count, l->columns, w->h, mean);
    }
}

/* Reads a tile and subtracts m. The first pass computes m. */
static gonio_status read_centred(const learner *l, size_t tile, gonio_i_row_range rows,
                                 const workspace *w, bool first_pass)
{
    const gonio_status status = gonio_i_database_read_tile(l->context, l->database, tile, l->subset,
                                                           l->materials, w->values);
    if (status != GONIO_OK) {
        return status;
    }
    if (l->mixtures != NULL) {
        gonio_i_mixtures_fill(l->mixtures, rows.first, rows.count,
                              w->values + l->measured * rows.count);
    }
    if (first_pass) {
        find_origin(l, rows, w);
    }
    centre(l, w, rows.count, l->basis->mean + rows.first);
    return GONIO_OK;
}

/* Work on one tile of a batch: adds to w->part. p is NULL in the first pass. */
typedef gonio_status tile_work(const learner *l, gonio_i_row_range rows, const workspace *w,
                               const double *p);

static gonio_status work_on_batch(const learner *l, tile_work *work, size_t batch,
                                  const workspace *w, const double *p, size_t n)
{
    const size_t first = batch * TILES_A_BATCH;
    const size_t end = first + TILES_A_BATCH < l->tiles ? first + TILES_A_BATCH : l->tiles;
    gonio_status status = GONIO_OK;
    memset(w->part, 0, n * n * sizeof *w->part);
    for (size_t tile = first; tile < end && status == GONIO_OK; tile++) {
        const gonio_i_row_range rows = gonio_i_database_tile_rows(l->database, tile);
        if (rows.count > 0) {
            status = read_centred(l, tile, rows, w, p == NULL);
            status = status == GONIO_OK ? work(l, rows, w, p) : status;
        }
    }
    return status;
}

static gonio_status report_batch(const learner *l)
{
    size_t done;
#pragma omp atomic capture
    done = ++*l->finished;
    /* Two passes over the tiles. */
    return gonio_i_progress(l->context, "learning", (double)done / (double)(2 * l->batches));
}

/* Runs the work on all tiles. sum (n x n): the sum of w->part, in order. */
static gonio_status for_each_tile(const learner *l, tile_work *work, const double *p, double *sum,
                                  size_t n)
{
    gonio_status result = GONIO_OK;
#pragma omp parallel num_threads(gonio_context_threads(l->context))
    {
        workspace w = {0};
        gonio_status mine = make_workspace(l, &w) ? GONIO_OK : GONIO_ERROR_MEMORY;
#pragma omp for ordered schedule(dynamic, 1)
        for (size_t batch = 0; batch < l->batches; batch++) {
            gonio_status so_far;
#pragma omp atomic read
            so_far = result;
            if (mine == GONIO_OK && so_far == GONIO_OK) {
                mine = work_on_batch(l, work, batch, &w, p, n);
            }
            if (mine == GONIO_OK) {
                mine = report_batch(l);
            }
#pragma omp ordered
            {
                for (size_t k = 0; k < n * n && mine == GONIO_OK; k++) {
                    sum[k] += w.part[k];
                }
                if (mine != GONIO_OK) {
#pragma omp atomic write
                    result = mine;
                }
            }
        }
        free_workspace(&w);
    }
    return result;
}

/* G of a tile. */
static gonio_status add_gram(const learner *l, gonio_i_row_range rows, const workspace *w,
                             const double *p)
{
    (void)p;
    return gonio_i_add_gram_columns(l->context, w->h, rows.count, l->columns, w->part);
}

/* V of a tile is (H - m) P, P (columns x K) = W S^-1; and its V'V. */
static gonio_status project(const learner *l, gonio_i_row_range rows, const workspace *w,
                            const double *p)
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
static gonio_status orthonormalise(const learner *l, double *c)
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
static gonio_status fix_signs(const learner *l)
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
static gonio_status split_gram(const learner *l, const double *w, const double *values, double *p)
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

static gonio_status decompose(const learner *l)
{
    const size_t n = l->columns;
    size_t k = l->basis->components;
    double *gram = gonio_i_allocate(l->context, n * n, sizeof *gram);
    double *values = gonio_i_allocate(l->context, n, sizeof *values);
    double *p = gonio_i_allocate(l->context, n * k, sizeof *p);
    double *c = gonio_i_allocate(l->context, k * k, sizeof *c);
    gonio_status status = gram == NULL || values == NULL || p == NULL || c == NULL
                              ? GONIO_ERROR_MEMORY
                              : for_each_tile(l, add_gram, NULL, gram, n);
    if (status == GONIO_OK) {
        gonio_i_mirror(gram, n);
        status = gonio_i_eigen(l->context, gram, n, true, values);
    }
    if (status == GONIO_OK) {
        status = split_gram(l, gram, values, p);
    }
    if (status == GONIO_OK) {
        k = l->basis->components;
        status = for_each_tile(l, project, p, c, k);
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

static gonio_status describe_origin(const learner *l)
{
    gonio_basis *basis = l->basis;
    basis->representation = l->view->representation;
    basis->mapping = l->view->mapping;
    memcpy(basis->cell, l->view->cell, basis->cells * sizeof *basis->cell);
    basis->program = gonio_i_format("gonio %s", gonio_version());
    bool done = basis->program != NULL;
    for (size_t k = 0; k < basis->materials; k++) {
        const size_t material = l->subset != NULL ? l->subset[k] : k;
        basis->fingerprints[k] = l->view->fingerprints[material];
        basis->names[k] = strdup(l->view->names[material]);
        done = done && basis->names[k] != NULL;
    }
    return done ? GONIO_OK : gonio_i_fail(l->context, GONIO_ERROR_MEMORY, "out of memory");
}

/* Mixtures use rows of other cells, which the map of cells finds. */
static gonio_status prepare_mixtures(learner *l, const gonio_basis_options *options,
                                     gonio_i_mixtures **mixtures)
{
    l->weight[0] = 1.0;
    l->weight[1] = 0.0;
    if (options->mixtures == 0) {
        return GONIO_OK;
    }
    const double half = 0.5 * (double)l->columns;
    l->weight[0] = half / (double)l->measured;
    l->weight[1] = half / (double)options->mixtures;
    gonio_status status = gonio_i_basis_map_cells(l->context, l->basis);
    if (status == GONIO_OK) {
        status = gonio_i_mixtures_create(l->context, l->basis, l->database, options, mixtures);
        l->mixtures = *mixtures;
    }
    if (status == GONIO_OK) {
        gonio_i_mixtures_parents(*mixtures, l->basis->parents);
    }
    return status;
}

static gonio_status learn(learner *l, const gonio_basis_options *options)
{
    gonio_i_mixtures *mixtures = NULL;
    gonio_status status = describe_origin(l);
    if (status == GONIO_OK) {
        status = prepare_mixtures(l, options, &mixtures);
    }
    if (status == GONIO_OK) {
        status = decompose(l);
    }
    gonio_i_mixtures_free(&mixtures);
    if (status == GONIO_OK) {
        status = fix_signs(l);
    }
    return status;
}

/* The default number of mixtures, for bases that use mixtures. */
static size_t count_mixtures(const gonio_database_view *view, const gonio_basis_options *options)
{
    const bool usual = view->representation == GONIO_SECTORED && view->mapping == GONIO_LOG &&
                       view->channels == GONIO_SEPARATE && !options->without_mean;
    return options->mixtures != GONIO_USUAL_MIXTURES ? options->mixtures
           : usual                                   ? GONIO_DEFAULT_MIXTURES
                                                     : 0;
}

/* Whether mixtures are implemented for a kind of basis. */
static gonio_status check_mixtures(gonio_context *context, const gonio_database_view *view,
                                   const gonio_basis_options *options)
{
    if (options->mixtures > 0 && (view->representation == GONIO_FULL ||
                                  view->mapping != GONIO_LOG || options->without_mean)) {
        return gonio_i_fail(
            context, GONIO_ERROR_ARGUMENT,
            "mixtures need the log mapping with a mean, on the sectored or the bivariate grid");
    }
    return GONIO_OK;
}

static gonio_status check_subset(gonio_context *context, const gonio_database_view *view,
                                 const gonio_basis_options *options)
{
    for (size_t k = 0; options->subset != NULL && k < options->subset_count; k++) {
        if (options->subset[k] >= view->materials) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "material %zu of a database of %zu",
                                options->subset[k], view->materials);
        }
    }
    return GONIO_OK;
}

/* K: the number that was asked for, or the default, limited by the columns. */
static gonio_status choose_components(gonio_context *context, size_t columns,
                                      const gonio_basis_options *options, size_t *components)
{
    const size_t asked = options->components;
    const size_t most = options->without_mean ? columns : columns - 1;
    if (columns < 2) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a basis needs at least 2 materials, there is %zu", columns);
    }
    if (asked > most) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu components asked for, but %zu columns give at most %zu; add "
                            "materials or ask for fewer components",
                            asked, columns, most);
    }
    const size_t usual =
        options->mixtures > 0 ? GONIO_MIXTURE_COMPONENTS : GONIO_DEFAULT_COMPONENTS;
    const bool all = options->without_mean || most < usual;
    *components = asked > 0 ? asked : all ? most : usual;
    return GONIO_OK;
}

gonio_status gonio_i_basis_learn_exact(gonio_context *context, const gonio_database *database,
                                       const gonio_basis_options *options, gonio_basis **basis,
                                       double **vectors)
{
    gonio_basis_options how;
    gonio_status status = GONIO_I_TAKE(context, gonio_basis_options, options, &how);
    if (status != GONIO_OK) {
        return status;
    }
    options = &how;
    learner l = {.context = context, .database = database, .subset = options->subset};
    l.view = gonio_database_describe(database);
    how.mixtures = count_mixtures(l.view, &how);
    l.materials = l.subset != NULL ? options->subset_count : l.view->materials;
    l.measured = l.view->columns / l.view->materials * l.materials;
    l.columns = l.measured + options->mixtures;
    l.any_rank = options->mixtures > 0 && options->components == 0;
    size_t components = 0;
    status = check_mixtures(context, l.view, options);
    if (status == GONIO_OK) {
        status = check_subset(context, l.view, options);
    }
    if (status == GONIO_OK) {
        status = choose_components(context, l.columns, options, &components);
    }
    if (status != GONIO_OK) {
        return status;
    }
    l.tiles = gonio_i_database_tiles(database);
    l.batches = (l.tiles + TILES_A_BATCH - 1) / TILES_A_BATCH;
    size_t finished = 0;
    l.finished = &finished;
    l.basis = gonio_i_basis_allocate(context, l.materials, options->mixtures, l.view->cells,
                                     l.view->channels, components,
                                     options->without_mean ? l.columns : l.columns - 1);
    if (l.basis == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    l.vectors = gonio_i_allocate(context, l.basis->rows * components, sizeof *l.vectors);
    if (l.vectors == NULL) {
        gonio_basis_free(&l.basis);
        return GONIO_ERROR_MEMORY;
    }
    l.basis->without_mean = options->without_mean;
    l.context = gonio_i_shared_context_begin(context);
    status = learn(&l, options);
    gonio_i_shared_context_end(l.context, context);
    if (status != GONIO_OK) {
        free(l.vectors);
        gonio_basis_free(&l.basis);
        return status;
    }
    *basis = l.basis;
    *vectors = l.vectors;
    return GONIO_OK;
}

gonio_status gonio_basis_learn(gonio_context *context, const gonio_database *database,
                               const gonio_basis_options *options, gonio_basis **basis)
{
    gonio_basis *made = NULL;
    double *vectors = NULL;
    gonio_status status = gonio_i_basis_learn_exact(context, database, options, &made, &vectors);
    if (status != GONIO_OK) {
        return status;
    }
    status = gonio_i_basis_keep_vectors(context, made, vectors);
    if (status == GONIO_OK) {
        status = gonio_i_basis_finish(context, made);
    }
    if (status != GONIO_OK) {
        gonio_basis_free(&made);
        return status;
    }
    *basis = made;
    return GONIO_OK;
}
