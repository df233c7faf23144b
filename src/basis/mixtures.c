/* Mixtures of measured columns: see mixtures.h. */
#include "mixtures.h"

#include <math.h>
#include <stdlib.h>

#include "../core/random.h"
#include "../core/vector_math.h"
#include "../database/tiles.h"
#include "../direction/grid.h"

/* Standard deviations of ln f and ln t. */
static const double WIDTH_DEVIATION = 0.3;
static const double TILT_DEVIATION = 0.25;

enum { CHUNK = 256 }; /* rows that are mixed together */

/* A varied measured column: the bins from which its value at each theta_h and theta_d comes. */
typedef struct half {
    size_t column;
    double share;
    gonio_i_between theta_h[GONIO_THETA_H_BINS];
    gonio_i_between theta_d[GONIO_THETA_D_BINS];
} half;

typedef struct recipe {
    half half[2];
} recipe;

struct gonio_i_mixtures {
    const gonio_basis *basis;
    size_t count;
    recipe *recipe;
    float *measured; /* [column][row] */
};

/* The bins of theta_h / f; theta_h is spaced by a square root. */
static void widen(double f, gonio_i_between *theta_h)
{
    for (int k = 0; k < GONIO_THETA_H_BINS; k++) {
        theta_h[k] = gonio_i_between_bins((k + 0.5) / sqrt(f) - 0.5, GONIO_THETA_H_BINS);
    }
}

/* The bins of 90 degrees (theta_d / 90 degrees)^t. */
static void bend(double t, gonio_i_between *theta_d)
{
    for (int k = 0; k < GONIO_THETA_D_BINS; k++) {
        const double bent = pow((k + 0.5) / GONIO_THETA_D_BINS, t);
        theta_d[k] = gonio_i_between_bins(GONIO_THETA_D_BINS * bent - 0.5, GONIO_THETA_D_BINS);
    }
}

static void draw_half(gonio_i_random *random, size_t columns, double share, half *h)
{
    h->column = (size_t)gonio_i_random_below(random, columns);
    h->share = share;
    widen(exp(WIDTH_DEVIATION * gonio_i_random_normal(random)), h->theta_h);
    bend(exp(TILT_DEVIATION * gonio_i_random_normal(random)), h->theta_d);
}

static void draw(gonio_i_mixtures *m, size_t columns, uint64_t seed)
{
    for (size_t k = 0; k < m->count; k++) {
        gonio_i_random random;
        gonio_i_random_seed(&random, seed, k);
        const double share = gonio_i_random_uniform(&random);
        draw_half(&random, columns, share, &m->recipe[k].half[0]);
        draw_half(&random, columns, 1.0 - share, &m->recipe[k].half[1]);
    }
}

/* All rows of the measured columns, in memory. */
static gonio_status read_measured(gonio_context *context, const gonio_database *database,
                                  const gonio_basis_options *options, size_t columns,
                                  gonio_i_mixtures *m)
{
    const size_t room = gonio_i_database_tile_room(database);
    float *block = gonio_i_allocate(context, room * columns, sizeof *block);
    gonio_status status = block == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t t = 0; t < gonio_i_database_tiles(database) && status == GONIO_OK; t++) {
        const gonio_i_row_range rows = gonio_i_database_tile_rows(database, t);
        if (rows.count == 0) {
            continue;
        }
        status = gonio_i_database_read_tile(context, database, t, options->subset,
                                            m->basis->materials, block);
        for (size_t j = 0; j < columns && status == GONIO_OK; j++) {
            for (size_t i = 0; i < rows.count; i++) {
                m->measured[j * m->basis->rows + rows.first + i] = block[j * rows.count + i];
            }
        }
    }
    free(block);
    return status;
}

gonio_status gonio_i_mixtures_create(gonio_context *context, const gonio_basis *basis,
                                     const gonio_database *database,
                                     const gonio_basis_options *options,
                                     gonio_i_mixtures **mixtures)
{
    const size_t columns = gonio_i_columns_per_material(basis->channels) * basis->materials;
    gonio_i_mixtures *m = gonio_i_allocate(context, 1, sizeof *m);
    if (m == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    m->basis = basis;
    m->count = basis->mixtures;
    m->recipe = gonio_i_allocate(context, m->count, sizeof *m->recipe);
    m->measured = gonio_i_allocate(context, columns * basis->rows, sizeof *m->measured);
    gonio_status status = m->recipe == NULL || m->measured == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        draw(m, columns, options->seed);
        status = read_measured(context, database, options, columns, m);
    }
    if (status != GONIO_OK) {
        gonio_i_mixtures_free(&m);
        return status;
    }
    *mixtures = m;
    return GONIO_OK;
}

void gonio_i_mixtures_free(gonio_i_mixtures **mixtures)
{
    if (mixtures == NULL || *mixtures == NULL) {
        return;
    }
    free((*mixtures)->recipe);
    free((*mixtures)->measured);
    free(*mixtures);
    *mixtures = NULL;
}

void gonio_i_mixtures_parents(const gonio_i_mixtures *mixtures, int32_t *parents)
{
    for (size_t k = 0; k < mixtures->count; k++) {
        parents[2 * k] = (int32_t)mixtures->recipe[k].half[0].column;
        parents[2 * k + 1] = (int32_t)mixtures->recipe[k].half[1].column;
    }
}

/* Rows that are mixed together, with their places on the grid. */
typedef struct row_run {
    size_t count;
    int32_t phi_cells;
    gonio_i_cell_indices at[CHUNK];
    int channel[CHUNK];
} row_run;

static void find_rows(const gonio_basis *basis, size_t first, size_t count, row_run *run)
{
    run->count = count;
    run->phi_cells = gonio_i_phi_cells(basis->representation);
    for (size_t i = 0; i < count; i++) {
        const size_t position = gonio_i_position_of(basis->channels, first + i);
        run->at[i] = gonio_i_indices_of_cell(run->phi_cells, basis->cell[position]);
        run->channel[i] = gonio_i_channel_of(basis->channels, first + i);
    }
}

/* A row of a varied column: interpolated between four cells. */
static double stretched(const gonio_i_mixtures *m, const half *h, const row_run *run, size_t i)
{
    const gonio_i_cell_indices at = run->at[i];
    const gonio_i_between at_h = h->theta_h[at.theta_h];
    const gonio_i_between at_d = h->theta_d[at.theta_d];
    const float *column = m->measured + h->column * m->basis->rows;
    const int32_t *position =
        m->basis->position +
        gonio_i_cell_at(run->phi_cells, (gonio_i_cell_indices){at_h.low, at_d.low, at.phi});
    double sum = 0.0;
    for (int k = 0; k < 4; k++) {
        const int32_t further =
            gonio_i_cell_at(run->phi_cells, (gonio_i_cell_indices){k / 2, k % 2, 0});
        sum += (k / 2 == 0 ? 1.0 - at_h.share : at_h.share) *
               (k % 2 == 0 ? 1.0 - at_d.share : at_d.share) *
               (double)column[gonio_i_row_of(m->basis->channels, (size_t)position[further],
                                             run->channel[i])];
    }
    return sum;
}

/* share (e^g - 1) of one of the two columns. */
static void reflectance(const gonio_i_mixtures *m, const half *h, const row_run *run, double *x)
{
    for (size_t i = 0; i < run->count; i++) {
        x[i] = stretched(m, h, run, i);
    }
    gonio_i_expm1(run->count, x, x);
    for (size_t i = 0; i < run->count; i++) {
        x[i] *= h->share;
    }
}

static void mix(const gonio_i_mixtures *m, const recipe *r, const row_run *run, float *values)
{
    double x[CHUNK];
    double y[CHUNK];
    reflectance(m, &r->half[0], run, x);
    reflectance(m, &r->half[1], run, y);
    for (size_t i = 0; i < run->count; i++) {
        x[i] += y[i];
    }
    gonio_i_log1p(run->count, x, x);
    for (size_t i = 0; i < run->count; i++) {
        values[i] = (float)x[i];
    }
}

void gonio_i_mixtures_fill(const gonio_i_mixtures *mixtures, size_t first, size_t count,
                           float *values)
{
    for (size_t i = 0; i < count; i += CHUNK) {
        row_run run;
        find_rows(mixtures->basis, first + i, count - i < CHUNK ? count - i : CHUNK, &run);
        for (size_t k = 0; k < mixtures->count; k++) {
            mix(mixtures, &mixtures->recipe[k], &run, values + k * count + i);
        }
    }
}
