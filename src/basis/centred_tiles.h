/* Passes over the observation matrix, tile by tile, with its mean subtracted. Mixtures are columns
 * of it too. The tiles and the order of their sums depend on the matrix only, not on the threads.
 */
#ifndef GONIO_CENTRED_TILES_H
#define GONIO_CENTRED_TILES_H

#include "../database/tiles.h"
#include "learner.h"

/* Buffers of a thread. */
typedef struct gonio_i_tile_workspace {
    float *values; /* a tile, [column][row] */
    double *h;     /* the same, less m */
    double *part;  /* of a sum over tiles, [columns][columns] */
} gonio_i_tile_workspace;

/* Work on one tile of a batch: adds to w->part. p is NULL in the first pass. */
typedef gonio_status gonio_i_tile_work(const gonio_i_learner *l, gonio_i_row_range rows,
                                       const gonio_i_tile_workspace *w, const double *p);

/* The number of batches of tiles in a pass. */
size_t gonio_i_tile_batches(size_t tiles);

/* Runs the work on all tiles. sum (n x n): the sum of w->part, in order. The first pass, without p,
 * finds the mean. Errors: _MEMORY, _IO, _CANCELLED, and those of the work. */
gonio_status gonio_i_for_each_centred_tile(const gonio_i_learner *l, gonio_i_tile_work *work,
                                           const double *p, double *sum, size_t n);

#endif
