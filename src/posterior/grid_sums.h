/* The sum of the field's variances over the grid, without the matrix Q (variance.c).
 *
 * With R the sum of bins t' t over the rows, the sum of bins t Q t' is the trace of Q R:
 *
 *     h^2 tr R_ff - tr(S^-1 M) + sum_j q_j d_j R d_j',   M = w' R w,
 *     d_j R d_j' = z R_ff z' - 2 z N s + s' M s,   N = R_f w,   s = S^-1 F z,   z = a z_j - z.
 *
 * R, M and N depend on the directions and the model, z_j R_ff z_j' and z_j N on the samples too.
 * They are made once for all columns. */
#ifndef GONIO_GRID_SUMS_H
#define GONIO_GRID_SUMS_H

#include "fit.h"

typedef struct gonio_i_grid_sums gonio_i_grid_sums;

/* gram: R, [K][K], with the remainder ([K + n][K + n]) if `remainder` is set; not kept. The sites
 * must outlive the sums. Errors: _MEMORY. */
gonio_status gonio_i_grid_sums_create(gonio_context *context, const gonio_i_sites *sites,
                                      const gonio_i_model *model, bool remainder,
                                      const double *gram, gonio_i_grid_sums **sums);
void gonio_i_grid_sums_free(gonio_i_grid_sums **sums);

/* The sum of bins t Q t' for a fit over the sites, solved for the model. Any number of threads may
 * ask. Errors: _MEMORY. */
gonio_status gonio_i_grid_sums_of(const gonio_i_grid_sums *sums, const gonio_i_fit *fit,
                                  double *sum);

#endif
