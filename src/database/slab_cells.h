/* A slab of a material as the stored cells of an observation matrix, in log space. To add a
 * representation, write a function like bivariate_rows and add it to the table at the end of
 * slab_cells.c. */
#ifndef GONIO_SLAB_CELLS_H
#define GONIO_SLAB_CELLS_H

#include <gonio/database.h>

typedef struct gonio_i_slab_cells {
    double *rho;   /* the slab, [GONIO_SLAB_VALUES], 1/sr */
    double *scale; /* [GONIO_SLAB_BINS] of bins with a scale each */
    double *g;     /* [GONIO_SLAB_VALUES]: its stored cells in log space, by gonio_i_slab_strides */
    bool *data;    /* [GONIO_SLAB_BINS]: whether a stored cell has data */
} gonio_i_slab_cells;

/* The storage order of g: distances between cells and between channels. */
typedef struct gonio_i_strides {
    size_t cell;
    size_t channel;
} gonio_i_strides;

gonio_i_strides gonio_i_slab_strides(gonio_representation representation);

/* Fills in g and data from rho, which is overwritten. */
void gonio_i_slab_to_cells(const gonio_database *database, int theta_h,
                           const gonio_i_slab_cells *slab);

#endif
