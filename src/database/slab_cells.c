/* A slab of a material as stored cells: see slab_cells.h. */
#include "slab_cells.h"

#include <math.h>

#include "../core/core.h"
#include "../core/vector_math.h"
#include "matrix.h"
#include "slab_mean.h"

GONIO_I_VECTORISED static void scale_run(const double *rho, size_t count, double factor, double *x)
{
    for (size_t k = 0; k < count; k++) {
        x[k] = rho[k] > 0.0 ? rho[k] * factor : 0.0;
    }
}

/* Divides a slab by the scale of each bin. Bins without data stay below 0. */
GONIO_I_VECTORISED static void divide_slab(const double *scale, double *rho)
{
    for (size_t plane = 0; plane < GONIO_SLAB_VALUES; plane += GONIO_SLAB_BINS) {
        for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
            rho[plane + k] /= scale[k];
        }
    }
}

GONIO_I_VECTORISED static void find_data(const double *rho, size_t count, bool *data)
{
    for (size_t k = 0; k < count; k++) {
        data[k] = rho[k] >= 0.0;
    }
}

/* The valid bins of a slab of the full grid, in log space, [channel][cell]. */
static void full_rows(const gonio_database *database, int theta_h, const gonio_i_slab_cells *s)
{
    size_t count = 0;
    for (size_t d = 0; d < GONIO_THETA_D_BINS; d++) {
        const size_t first = database->first_phi[(size_t)theta_h * GONIO_THETA_D_BINS + d];
        const size_t length = GONIO_PHI_D_BINS - 2 * first;
        const double *rho = s->rho + d * GONIO_PHI_D_BINS + first;
        find_data(rho, length, s->data + count);
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            scale_run(rho + channel * GONIO_SLAB_BINS, length, database->inverse_scale[channel],
                      s->g + channel * GONIO_SLAB_BINS + count);
        }
        count += length;
    }
    for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
        double *g = s->g + channel * GONIO_SLAB_BINS;
        gonio_i_log1p(count, g, g);
    }
}

/* The mean over a sector's bins with data, in `first` .. `end` - 1 of [channel][bin]. */
static void reduce_sector(const gonio_i_slab_cells *s, size_t first, size_t end, size_t cell)
{
    size_t count = 0;
    double sum[GONIO_CHANNELS] = {0.0};
    for (size_t k = first; k < end; k++) {
        for (size_t channel = 0; channel < GONIO_CHANNELS && s->data[k]; channel++) {
            sum[channel] += s->g[channel * GONIO_SLAB_BINS + k];
        }
        count += s->data[k];
    }
    for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
        s->g[channel * GONIO_SLAB_BINS + cell] = count > 0 ? sum[channel] / (double)count : 0.0;
    }
    s->data[cell] = count > 0;
}

/* The cells of a slab of the sectored grid, [channel][cell]: the bins of the full grid are reduced
 * in place. A sector's index is never larger than that of its bins. */
static void sectored_rows(const gonio_database *database, int theta_h, const gonio_i_slab_cells *s)
{
    full_rows(database, theta_h, s);
    size_t bin = 0;
    size_t cell = 0;
    for (size_t d = 0; d < GONIO_THETA_D_BINS; d++) {
        const size_t first = database->first_phi[(size_t)theta_h * GONIO_THETA_D_BINS + d];
        const size_t last = GONIO_PHI_D_BINS - first;
        for (size_t p = first; p < last;) {
            const size_t edge = (p / GONIO_SECTOR_BINS + 1) * GONIO_SECTOR_BINS;
            const size_t end = edge < last ? edge : last;
            reduce_sector(s, bin, bin + end - p, cell++);
            bin += end - p;
            p = end;
        }
    }
}

/* The cells of a slab of the bivariate grid, [cell][channel]. */
static void bivariate_rows(const gonio_database *database, int theta_h, const gonio_i_slab_cells *s)
{
    gonio_i_slab_mean(database->first_phi + (size_t)theta_h * GONIO_THETA_D_BINS, s->rho,
                      database->inverse_scale, s->g);
    for (size_t k = 0; k < GONIO_THETA_D_BINS; k++) {
        s->data[k] = !isnan(s->g[k * GONIO_CHANNELS]);
    }
}

static const struct {
    gonio_i_strides strides;
    void (*fill)(const gonio_database *database, int theta_h, const gonio_i_slab_cells *s);
} representations[] = {[GONIO_BIVARIATE] = {{GONIO_CHANNELS, 1}, bivariate_rows},
                       [GONIO_FULL] = {{1, GONIO_SLAB_BINS}, full_rows},
                       [GONIO_SECTORED] = {{1, GONIO_SLAB_BINS}, sectored_rows}};

gonio_i_strides gonio_i_slab_strides(gonio_representation representation)
{
    return representations[representation].strides;
}

void gonio_i_slab_to_cells(const gonio_database *database, int theta_h,
                           const gonio_i_slab_cells *slab)
{
    if (database->options.mapping == GONIO_LOG_RELATIVE) {
        gonio_slab_scale(GONIO_LOG_RELATIVE, 0, theta_h, slab->scale);
        divide_slab(slab->scale, slab->rho);
    }
    representations[database->options.representation].fill(database, theta_h, slab);
}
