/* Passes over the centred observation matrix: see centred_tiles.h. */
#include "centred_tiles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tiles that one thread sums before it waits to add its sum to the total. Batches are added in
 * order. */
enum { TILES_A_BATCH = 8 };

size_t gonio_i_tile_batches(size_t tiles)
{
    return (tiles + TILES_A_BATCH - 1) / TILES_A_BATCH;
}

static bool make_workspace(const gonio_i_learner *l, gonio_i_tile_workspace *w)
{
    const size_t values = gonio_i_database_tile_room(l->database) * l->columns;
    w->values = gonio_i_allocate(l->context, values, sizeof *w->values);
    w->h = gonio_i_allocate(l->context, values, sizeof *w->h);
    w->part = gonio_i_allocate(l->context, l->columns * l->columns, sizeof *w->part);
    return w->values != NULL && w->h != NULL && w->part != NULL;
}

static void free_workspace(gonio_i_tile_workspace *w)
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

static void find_means(const gonio_i_learner *l, const float *values, size_t rows, double *mean)
{
    memset(mean, 0, rows * sizeof *mean);
    const size_t mixtures = l->columns - l->measured - l->analytic;
    add_columns(values, rows, l->measured, l->weight.measured, mean);
    add_columns(values + l->measured * rows, rows, mixtures, l->weight.mixture, mean);
    add_columns(values + (l->columns - l->analytic) * rows, rows, l->analytic, l->weight.analytic,
                mean);
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
static void centre(const gonio_i_learner *l, const gonio_i_tile_workspace *w, size_t rows,
                   const double *mean)
{
    const size_t after = l->measured * rows;
    const size_t last = (l->columns - l->analytic) * rows;
    subtract_means(w->values, rows, l->measured, mean, sqrt(l->weight.measured), w->h);
    subtract_means(w->values + after, rows, l->columns - l->measured - l->analytic, mean,
                   sqrt(l->weight.mixture), w->h + after);
    subtract_means(w->values + last, rows, l->analytic, mean, sqrt(l->weight.analytic),
                   w->h + last);
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
static void find_origin(const gonio_i_learner *l, gonio_i_row_range rows,
                        const gonio_i_tile_workspace *w)
{
    double *mean = l->basis->mean + rows.first;
    if (!l->basis->without_mean) {
        find_means(l, w->values, rows.count, mean);
    } else if (l->basis->mapping == GONIO_LOG_RELATIVE) {
        find_medians(w->values, rows.count, l->columns, w->h, mean);
    }
}

/* Reads a tile and subtracts m. The first pass computes m. */
static gonio_status read_centred(const gonio_i_learner *l, size_t tile, gonio_i_row_range rows,
                                 const gonio_i_tile_workspace *w, bool first_pass)
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
    for (size_t j = 0; j < l->analytic; j++) {
        memcpy(w->values + (l->columns - l->analytic + j) * rows.count,
               l->random + j * l->basis->rows + rows.first, rows.count * sizeof *w->values);
    }
    if (first_pass) {
        find_origin(l, rows, w);
    }
    centre(l, w, rows.count, l->basis->mean + rows.first);
    return GONIO_OK;
}

static gonio_status work_on_batch(const gonio_i_learner *l, gonio_i_tile_work *work, size_t batch,
                                  const gonio_i_tile_workspace *w, const double *p, size_t n)
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

static gonio_status report_batch(const gonio_i_learner *l)
{
    size_t done;
#pragma omp atomic capture
    done = ++*l->finished;
    /* Two passes over the tiles. */
    return gonio_i_progress(l->context, "learning", (double)done / (double)(2 * l->batches));
}

gonio_status gonio_i_for_each_centred_tile(const gonio_i_learner *l, gonio_i_tile_work *work,
                                           const double *p, double *sum, size_t n)
{
    gonio_status result = GONIO_OK;
#pragma omp parallel num_threads(gonio_context_threads(l->context))
    {
        gonio_i_tile_workspace w = {0};
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
