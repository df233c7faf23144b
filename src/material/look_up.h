/* A material's table looked up between the centres of its bins. */
#ifndef GONIO_LOOK_UP_H
#define GONIO_LOOK_UP_H

#include <gonio/material.h>

#include "../direction/grid.h"

/* The first and the last slab that a trilinear stencil has bins in. */
void gonio_i_stencil_slabs(const gonio_i_stencil *stencil, int *first, int *last);

/* As gonio_table_value, from the slabs in which the point's stencil has bins; the others may be
 * NULL. Weights of bins without data go to the others. */
bool gonio_i_look_up(const double *const slab[GONIO_THETA_H_BINS],
                     gonio_half_difference coordinates, double rho[GONIO_CHANNELS]);

#endif
