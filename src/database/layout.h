/* The layout of an observation matrix. Only this file converts between rows, cells, channels, bins
 * and directions.
 *
 * The representation defines the cells of the grid (gonio/database.h). A matrix has rows for some
 * of the cells, in ascending order. The index of a cell among these is its position. The channel
 * model defines the rows of a position. */
#ifndef GONIO_LAYOUT_H
#define GONIO_LAYOUT_H

#include <gonio/database.h>

#include "../direction/grid.h"

/* ---- rows ---- */

/* Rows of a cell: 3 if joint, 1 if separate. */
static inline size_t gonio_i_rows_per_cell(gonio_channel_model channels)
{
    return channels == GONIO_JOINT ? GONIO_CHANNELS : 1;
}

/* Columns of a material: 1 if joint, 3 if separate. */
static inline size_t gonio_i_columns_per_material(gonio_channel_model channels)
{
    return GONIO_CHANNELS / gonio_i_rows_per_cell(channels);
}

/* The row of a channel of the cell at a position. Separate models ignore the channel. */
static inline size_t gonio_i_row_of(gonio_channel_model channels, size_t position, int channel)
{
    return channels == GONIO_JOINT ? GONIO_CHANNELS * position + (size_t)channel : position;
}

/* The position of a row's cell. */
static inline size_t gonio_i_position_of(gonio_channel_model channels, size_t row)
{
    return row / gonio_i_rows_per_cell(channels);
}

/* The channel of a row; 0 in separate models, where a row serves all channels. */
static inline int gonio_i_channel_of(gonio_channel_model channels, size_t row)
{
    return (int)(row % gonio_i_rows_per_cell(channels));
}

/* ---- cells and bins ---- */

/* The number of phi_d bins of a cell: 180 bivariate, 1 full, 15 sectored. */
int gonio_i_phi_bins(gonio_representation representation);

/* The number of cells of one theta_h and theta_d: 1 bivariate, 180 full, 12 sectored. In the
 * numbers of cells phi_d runs fastest, then theta_d, then theta_h. */
int gonio_i_phi_cells(gonio_representation representation);

/* A cell by its bins of theta_h and theta_d and its index among the cells of these.
 * phi_cells: gonio_i_phi_cells, for loops over very many cells. */
typedef struct gonio_i_cell_indices {
    int32_t theta_h;
    int32_t theta_d;
    int32_t phi;
} gonio_i_cell_indices;

static inline gonio_i_cell_indices gonio_i_indices_of_cell(int32_t phi_cells, int32_t cell)
{
    const int32_t both = cell / phi_cells;
    return (gonio_i_cell_indices){both / GONIO_THETA_D_BINS, both % GONIO_THETA_D_BINS,
                                  cell % phi_cells};
}

static inline int32_t gonio_i_cell_at(int32_t phi_cells, gonio_i_cell_indices at)
{
    return (at.theta_h * GONIO_THETA_D_BINS + at.theta_d) * phi_cells + at.phi;
}

/* A run of bins of one theta_h and theta_d. */
typedef struct gonio_i_bin_run {
    gonio_bin first;
    int count; /* 0 or more */
} gonio_i_bin_run;

/* All bins of a cell. */
gonio_i_bin_run gonio_i_cell_bins(gonio_representation representation, int32_t cell);

/* The valid bins of a run. first_valid: gonio_i_first_valid_phi of its theta_h and theta_d. */
gonio_i_bin_run gonio_i_valid_bins(gonio_i_bin_run run, int first_valid);

/* The number of valid bins of a cell. */
int gonio_i_valid_bin_count(gonio_representation representation, int32_t cell);

/* ---- directions ---- */

/* The direction that represents a cell: its centre, with the given phi_d for a bivariate cell. If
 * the centre is not above the horizon but other bins of the same theta_h and theta_d are, the
 * nearest phi_d of these. */
gonio_half_difference gonio_i_cell_direction(gonio_representation representation, int32_t cell,
                                             double phi_d);

/* A cell and its weight in an interpolation. */
typedef struct gonio_i_cell_weight {
    int32_t cell;
    double weight; /* >= 0; the weights add up to 1 */
} gonio_i_cell_weight;

/* The cells around a direction with the weights of linear interpolation (grid.h). Returns their
 * number. They are cells of the grid; some may have no rows. */
int gonio_i_cells_around(gonio_representation representation, gonio_half_difference at,
                         gonio_i_cell_weight around[GONIO_I_MOST_POINTS]);

#endif
