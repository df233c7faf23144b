/* From spectra to colours. */
#ifndef GONIO_SPECTRUM_H
#define GONIO_SPECTRUM_H

#include <stddef.h>

#include <gonio/direction.h>

/* A spectrum as linear R, G, B of the sRGB primaries, in which a flat spectrum is white.
 * wavelength[count] in nm, value[count]. */
void gonio_i_spectrum_to_rgb(const double *wavelength, const double *value, size_t count,
                             double rgb[GONIO_CHANNELS]);

#endif
