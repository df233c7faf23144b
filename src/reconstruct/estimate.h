/* Reconstruction by posterior: from readings to its columns, and from those to a reconstruction. */
#ifndef GONIO_ESTIMATE_H
#define GONIO_ESTIMATE_H

#include <gonio/reconstruct.h>

#include "../posterior/observations.h"

/* Both fill in a new reconstruction. Errors: those of gonio_reconstruct; _ARGUMENT for a basis of
 * another mapping than log; _MISMATCH for spectra and a joint basis. */
gonio_status gonio_i_estimate_readings(gonio_context *context, const gonio_basis *basis,
                                       const gonio_readings *readings,
                                       const gonio_reconstruct_options *options,
                                       gonio_reconstruction **reconstruction);
gonio_status gonio_i_estimate_rows(gonio_context *context, const gonio_basis *basis,
                                   const gonio_reconstruct_options *options, const size_t *rows,
                                   size_t count, const double *b,
                                   gonio_reconstruction **reconstruction);

/* What both need: a basis and options of the right kind. */
gonio_status gonio_i_estimate_check(gonio_context *context, const gonio_basis *basis,
                                    const gonio_readings *readings,
                                    const gonio_reconstruct_options *options);

gonio_i_noise gonio_i_estimate_noise(const gonio_reconstruct_options *options);

#endif
