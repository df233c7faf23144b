/* A slab of the grid from a material that is evaluated at any directions. */
#ifndef GONIO_SLAB_H
#define GONIO_SLAB_H

#include <gonio/material.h>

/* rho (GONIO_SLAB_VALUES) at the centres of the bins of a theta_h index, from source->evaluate: the
 * mean of either side of the reciprocal pair and, if the source is anisotropic, of 8 azimuths of
 * the half vector. Colours: of spectra by `weight` (colour.h); of one channel three times the same.
 * A channel without data is 0 where others have some; bins beyond source->theta_limit have none.
 * Errors: _MEMORY, those of the source. */
gonio_status gonio_i_slab_evaluate(gonio_context *context, const gonio_material_source *source,
                                   const double *weight, int theta_h, double *rho);

#endif
