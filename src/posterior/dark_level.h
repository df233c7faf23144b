/* The dark level: what an instrument takes off its readings too much.
 *
 * A gonioreflectometer subtracts the signal that its detector has without light, and what stray
 * light it expects, and divides by the irradiance of the sample, which falls with cos theta_i.
 * Where it subtracts too much, it reads of a material of rho
 *
 *     max(0, rho - dark / cos theta_i),
 *
 * which is nothing at all where the material is dark or the lamp grazes it. How much that is, each
 * channel's readings tell: from either side of a reciprocal pair the same should be read, and what
 * is zero should not be far above it. */
#ifndef GONIO_DARK_LEVEL_H
#define GONIO_DARK_LEVEL_H

#include "observations.h"

/* Where readings are zero and a dark level explains all of them far better than none: *dark, one
 * for each column, 1/sr, which the caller frees. Otherwise NULL.
 * Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_dark_level_find(gonio_context *context, const gonio_i_prior *prior,
                                     const gonio_readings *readings, const gonio_i_noise *noise,
                                     const gonio_i_columns *columns, double **dark);

#endif
