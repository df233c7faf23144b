/* The tiles of an observation matrix: see tiles.h and matrix.h. */
#include "matrix.h"

#include <string.h>

#include "../core/core.h"
#include "../direction/grid.h"

/* A tile of all materials fits into a processor's cache. A tile of one material is large enough for
 * a system call. */
enum { TILE_VALUES = 1 << 19, LARGEST_TILE = 1024, SMALLEST_TILE = 64 };

size_t gonio_i_tile_cells(const gonio_database *database)
{
    const size_t cells = TILE_VALUES / (GONIO_CHANNELS * database->materials);
    return cells < SMALLEST_TILE ? SMALLEST_TILE : cells > LARGEST_TILE ? LARGEST_TILE : cells;
}

/* ---- layout ---- */

/* 1/s of the channels. Bins with a scale of their own are divided by that scale before. */
static void find_scales(gonio_database *database)
{
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        database->inverse_scale[channel] =
            database->options.mapping == GONIO_LOG ? 1.0 / gonio_log_scale(channel) : 1.0;
    }
}

static void find_valid_bins(gonio_database *database)
{
    for (int cell = 0; cell < GONIO_CELLS; cell++) {
        const gonio_bin bin = gonio_cell_bin(GONIO_BIVARIATE, cell);
        database->first_phi[cell] = (uint8_t)gonio_i_first_valid_phi(bin.theta_h, bin.theta_d);
    }
}

/* Lists the stored cells of one slab: those with valid bins, and all bivariate ones. Returns their
 * number. */
static size_t list_cells(const gonio_database *database, int theta_h, int32_t *stored)
{
    const gonio_representation representation = database->options.representation;
    const int32_t slab = gonio_grid_cells(representation) / GONIO_THETA_H_BINS;
    size_t count = 0;
    for (int32_t cell = theta_h * slab; cell < (theta_h + 1) * slab; cell++) {
        const gonio_i_bin_run all = gonio_i_cell_bins(representation, cell);
        const int first = database->first_phi[theta_h * GONIO_THETA_D_BINS + all.first.theta_d];
        stored[count] = cell;
        count += all.count == GONIO_PHI_D_BINS || gonio_i_valid_bins(all, first).count > 0;
    }
    return count;
}

gonio_status gonio_i_database_lay_out(gonio_context *context, gonio_database *database)
{
    const size_t most = gonio_i_tile_cells(database);
    const size_t slab =
        (size_t)gonio_grid_cells(database->options.representation) / GONIO_THETA_H_BINS;
    const size_t tiles = GONIO_THETA_H_BINS * ((slab + most - 1) / most);
    database->stored =
        gonio_i_allocate(context, GONIO_THETA_H_BINS * slab, sizeof *database->stored);
    database->tile = gonio_i_allocate(context, tiles + 1, sizeof *database->tile);
    if (database->stored == NULL || database->tile == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    find_scales(database);
    find_valid_bins(database);
    size_t first = 0;
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h++) {
        const size_t end = first + list_cells(database, theta_h, database->stored + first);
        database->slab_tiles[theta_h] = database->tiles;
        for (; first < end; first += database->tile[database->tiles++].count) {
            const size_t count = end - first < most ? end - first : most;
            database->tile[database->tiles] = (gonio_i_cell_tile){.first = first, .count = count};
        }
    }
    database->slab_tiles[GONIO_THETA_H_BINS] = database->tiles;
    database->stored_count = first;
    database->tile[database->tiles].first = first;
    return GONIO_OK;
}

off_t gonio_i_tile_offset(const gonio_database *database, const gonio_i_cell_tile *t,
                          size_t material)
{
    const size_t values = database->materials * t->first + material * t->count;
    return (off_t)(values * GONIO_CHANNELS * sizeof(float));
}

/* ---- reading ---- */

size_t gonio_i_database_tiles(const gonio_database *database)
{
    return database->tiles;
}

gonio_i_row_range gonio_i_database_tile_rows(const gonio_database *database, size_t tile)
{
    const size_t first = database->tile[tile].kept;
    const size_t end = database->tile[tile + 1].kept;
    return (gonio_i_row_range){gonio_i_rows_per_cell(database->options.channels) * first,
                               gonio_i_rows_per_cell(database->options.channels) * (end - first)};
}

size_t gonio_i_database_tile_room(const gonio_database *database)
{
    return gonio_i_rows_per_cell(database->options.channels) * gonio_i_tile_cells(database);
}

/* Removes the cells that are left out from the columns of a tile. */
static void drop_rows(const gonio_database *database, size_t tile, size_t columns, float *block)
{
    const size_t rows = gonio_i_rows_per_cell(database->options.channels);
    const size_t stored = database->tile[tile].count;
    const int32_t *cell = database->stored + database->tile[tile].first;
    const int32_t *kept = database->cell + database->tile[tile].kept;
    const int32_t *end = database->cell + database->tile[tile + 1].kept;
    float *to = block;
    for (size_t column = 0; column < columns; column++) {
        const int32_t *next = kept;
        for (size_t k = 0; k < stored && next < end; k++) {
            if (cell[k] == *next) {
                memmove(to, block + (column * stored + k) * rows, rows * sizeof *to);
                to += rows;
                next++;
            }
        }
    }
}

gonio_status gonio_i_database_read_tile(gonio_context *context, const gonio_database *database,
                                        size_t tile, const size_t *subset, size_t subset_count,
                                        float *block)
{
    const gonio_i_cell_tile *t = &database->tile[tile];
    const size_t materials = subset != NULL ? subset_count : database->materials;
    const size_t together = subset != NULL ? 1 : materials; /* all lie in one piece */
    const size_t values = GONIO_CHANNELS * t->count;
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < materials && status == GONIO_OK; k += together) {
        status =
            gonio_i_scratch_read(context, &database->scratch, tile, block + k * values,
                                 together * values * sizeof *block,
                                 gonio_i_tile_offset(database, t, subset != NULL ? subset[k] : 0));
    }
    if (status == GONIO_OK && t[1].kept - t->kept < t->count) {
        drop_rows(database, tile,
                  materials * gonio_i_columns_per_material(database->options.channels), block);
    }
    return status;
}
