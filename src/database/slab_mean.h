/* The bivariate average of one slab, made fast because learning spends its time on it. */
#ifndef GONIO_SLAB_MEAN_H
#define GONIO_SLAB_MEAN_H

#include <gonio/database.h>

/* mean[theta_d][channel]: the mean of g = ln(1 + rho/s) over the valid phi_d bins with data, NaN
 * where there are none. rho: a slab (material.h). first_phi[theta_d]: the slab's
 * gonio_i_first_valid_phi. inverse_scale: 1/s of each channel. Agrees with gonio_slab_reduce to
 * rounding. */
void gonio_i_slab_mean(const uint8_t *first_phi, const double *rho,
                       const double inverse_scale[GONIO_CHANNELS], double *mean);

#endif
