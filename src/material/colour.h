/* Colours of spectra: linear R, G, B of the sRGB primaries, in which a flat spectrum is white. */
#ifndef GONIO_COLOUR_H
#define GONIO_COLOUR_H

#include <gonio/material.h>

/* weight[channel][count]: what each of `count` wavelengths (nm, in any order) adds to a channel of
 * the colour under an illuminant, so that rgb[c] = sum_k weight[c][k] value[k].
 *
 * Between the wavelengths a spectrum is taken to be linear, and constant beyond the first and the
 * last (CIE 15:2004, 7.2.3), so that a flat spectrum is white whatever part of it was read, and
 * readings of a single wavelength, or of infrared only, are grey. Weighted by the illuminant and
 * the CIE 1931 colour-matching functions every 5 nm from 380 to 780 nm; then each channel is
 * divided by that of a flat spectrum. Errors: _MEMORY. */
gonio_status gonio_i_colour_weights(gonio_context *context, const double *wavelength, size_t count,
                                    gonio_illuminant illuminant, double *weight);

/* Whether the wavelengths tell colours: at least two of them are visible, 60 nm apart or more. */
bool gonio_i_colours_known(const double *wavelength, size_t count);

/* Says so, where a table of colours is made of a spectrum that does not tell them. */
void gonio_i_note_colours(gonio_context *context, const char *name, const double *wavelength,
                          size_t count);

/* Between X, Y, Z and linear R, G, B of reflectances under equal energy, in which a flat spectrum
 * has three times the same in either. */
void gonio_i_xyz_to_rgb(const double xyz[3], double rgb[GONIO_CHANNELS]);
void gonio_i_rgb_to_xyz(const double rgb[GONIO_CHANNELS], double xyz[3]);

#endif
