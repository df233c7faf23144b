/* A slab of the grid from a material that is evaluated at any directions. */
#ifndef GONIO_SLAB_H
#define GONIO_SLAB_H

#include <gonio/material.h>

/* Computes rho (GONIO_SLAB_VALUES) at the centres of the bins of a theta_h index by
 * source->evaluate. A bin gets the mean over the pair and its reciprocal and, if the source is
 * anisotropic, over 8 azimuths of the half vector. Spectra become colours by `weight` (colour.h).
 * The three values of a single channel are equal. A channel without data is 0 where others have
 * data. Bins beyond source->theta_limit have no data. Errors: _MEMORY, those of the source. */
gonio_status gonio_i_slab_evaluate(gonio_context *context, const gonio_material_source *source,
                                   const double *weight, int theta_h, double *rho);

#endif
