/* The dark level: the dark signal that an instrument subtracted in excess.
 *
 * A gonioreflectometer subtracts its detector's dark signal and the expected stray light, and
 * divides by the irradiance of the sample, which falls with cos theta_i. If it subtracts too much,
 * its reading of a material of rho is
 *
 *     max(0, rho - dark / cos theta_i),
 *
 * which is zero where the material is dark or the light is grazing. The readings of each channel
 * determine the level: both sides of a reciprocal pair should be equal, and where a reading is zero
 * the prediction should not be far above it. */
#ifndef GONIO_DARK_LEVEL_H
#define GONIO_DARK_LEVEL_H

#include "observations.h"

/* If some readings are zero and a dark level explains all readings far better than none, *dark is
 * the level of each column, 1/sr, which the caller frees. Otherwise *dark is NULL.
 * Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_dark_level_find(gonio_context *context, const gonio_i_prior *prior,
                                     const gonio_readings *readings, const gonio_i_noise *noise,
                                     const gonio_i_columns *columns, double **dark);

#endif
