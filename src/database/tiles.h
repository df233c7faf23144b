/* The observation matrix by tiles. It is written in tiles, and tiles are the fastest way to read
 * it. */
#ifndef GONIO_TILES_H
#define GONIO_TILES_H

#include <gonio/database.h>

/* The number of tiles. Tiles are in the order of the rows. */
size_t gonio_i_database_tiles(const gonio_database *database);

/* The rows of a tile: `count` from `first`; none if all its cells are left out. */
typedef struct gonio_i_row_range {
    size_t first;
    size_t count;
} gonio_i_row_range;

gonio_i_row_range gonio_i_database_tile_rows(const gonio_database *database, size_t tile);

/* The largest number of values a column that gonio_i_database_read_tile needs space for. */
size_t gonio_i_database_tile_room(const gonio_database *database);

/* Reads the rows of a tile into block[column][count] for the given materials, as
 * gonio_database_read_rows does; block has room for tile_room values a column. Errors: _IO. */
gonio_status gonio_i_database_read_tile(gonio_context *context, const gonio_database *database,
                                        size_t tile, const size_t *subset, size_t subset_count,
                                        float *block);

/* The columns of a material that is not one of the database's, on its rows: columns[column of the
 * material][rows], as gonio_database_read_rows gives those of its own. A row without data is NaN.
 * Threads may call it at the same time. Errors: _MEMORY; those of reading the material. */
gonio_status gonio_i_database_read_other(gonio_context *context, const gonio_database *database,
                                         const gonio_material *material, float *columns);

#endif
