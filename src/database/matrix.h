/* The struct of an observation matrix, for this stage's files.
 *
 * Only cells that can hold data are stored: the valid bins of the full grid, all cells of the
 * bivariate one. They are divided into tiles of neighbouring cells of one slab. Scratch layout:
 * [tile][material][column of the material][row in the tile], where a tile's rows are those of all
 * its stored cells, in the order of the matrix; a cell without data holds NaN.
 *
 * Values are float32, because the matrix is read twice. The relative error of 6e-8 is far below the
 * noise of any measurement, and its effect on a basis is as random as that noise. */
#ifndef GONIO_MATRIX_H
#define GONIO_MATRIX_H

#include <gonio/database.h>

#include "layout.h"
#include "scratch.h"
#include "tiles.h"

/* Bits: whether some material has data in a cell, and whether some material lacks it. */
enum { GONIO_I_HAS_DATA = 1, GONIO_I_LACKS_DATA = 2 };

typedef struct gonio_i_cell_tile {
    size_t first; /* of its stored cells */
    size_t count;
    size_t kept; /* position of its first cell that is kept */
} gonio_i_cell_tile;

struct gonio_database {
    gonio_database_options options;
    gonio_i_scratch scratch;
    size_t materials;
    char **names;
    uint64_t *fingerprints;
    bool *anisotropic; /* [materials] */
    size_t stored_count;
    int32_t *stored; /* [stored_count] cells of the grid, ascending */
    size_t tiles;
    gonio_i_cell_tile *tile;                   /* [tiles + 1], the last one empty */
    size_t slab_tiles[GONIO_THETA_H_BINS + 1]; /* the first tile of each slab */
    uint8_t first_phi[GONIO_CELLS];            /* grid.h */
    double inverse_scale[GONIO_CHANNELS];      /* 1/s, of values already divided by a bin's own s */
    size_t cells;
    int32_t *cell; /* those of `stored` that are kept */
    gonio_database_view view;
};

/* The most cells of a tile. */
size_t gonio_i_tile_cells(const gonio_database *database);

/* The offset of a material's rows of a tile in the scratch file. */
off_t gonio_i_tile_offset(const gonio_database *database, const gonio_i_cell_tile *t,
                          size_t material);

/* Sets the stored cells and the tiles. Errors: _MEMORY. */
gonio_status gonio_i_database_lay_out(gonio_context *context, gonio_database *database);

/* Materials to learn from: files, opened one at a time, or materials in memory. */
typedef struct gonio_i_sources {
    const char *const *path;               /* [materials] or NULL */
    const gonio_material *const *material; /* [materials] or NULL */
} gonio_i_sources;

/* Reads all materials into the scratch files, and sets their names and fingerprints. seen[stored
 * cell]: which of GONIO_I_HAS_DATA and GONIO_I_LACKS_DATA hold of some material. Errors: those of
 * gonio_database_create. */
gonio_status gonio_i_database_read_materials(gonio_context *context, gonio_database *database,
                                             const gonio_i_sources *from, uint8_t *seen);

#endif
