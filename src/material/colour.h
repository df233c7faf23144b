/* Colours of spectra: linear R, G, B of the sRGB primaries. A flat spectrum is white. */
#ifndef GONIO_COLOUR_H
#define GONIO_COLOUR_H

#include <gonio/material.h>

/* Fills in weight[channel][count] for `count` wavelengths (nm, in any order) and an illuminant: the
 * colour of a spectrum is rgb[c] = sum_k weight[c][k] value[k].
 *
 * A spectrum is linear between the wavelengths, and constant beyond the first and the last (CIE
 * 15:2004, 7.2.3). It is weighted by the illuminant and the CIE 1931 colour-matching functions
 * every 5 nm from 380 to 780 nm. Each channel is divided by that of a flat spectrum. So a flat
 * spectrum is white whatever part of it was read. A single wavelength, or infrared only, is grey.
 * Errors: _MEMORY. */
gonio_status gonio_i_colour_weights(gonio_context *context, const double *wavelength, size_t count,
                                    gonio_illuminant illuminant, double *weight);

/* Whether the wavelengths determine colours: two of them are visible and at least 60 nm apart. */
bool gonio_i_colours_known(const double *wavelength, size_t count);

/* Notes that a table of colours is made from a spectrum that does not determine colours. */
void gonio_i_note_colours(gonio_context *context, const char *name, const double *wavelength,
                          size_t count);

/* Conversions between X, Y, Z and linear R, G, B of reflectances under equal energy. The three
 * values of a flat spectrum are equal in both. */
void gonio_i_xyz_to_rgb(const double xyz[3], double rgb[GONIO_CHANNELS]);
void gonio_i_rgb_to_xyz(const double rgb[GONIO_CHANNELS], double xyz[3]);

#endif
