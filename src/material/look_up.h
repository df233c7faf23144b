/* Look-ups in a material's table, interpolated between the centres of its bins. */
#ifndef GONIO_LOOK_UP_H
#define GONIO_LOOK_UP_H

#include <gonio/material.h>

#include "../direction/grid.h"

/* The first and the last slab of the bins of a trilinear stencil. */
void gonio_i_stencil_slabs(const gonio_i_stencil *stencil, int *first, int *last);

/* As gonio_table_value, from the slabs of the stencil's bins; the other slabs may be NULL. The
 * weights of bins without data go to the other bins. */
bool gonio_i_look_up(const double *const slab[GONIO_THETA_H_BINS],
                     gonio_half_difference coordinates, double rho[GONIO_CHANNELS]);

#endif
