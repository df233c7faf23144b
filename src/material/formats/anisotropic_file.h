/* Anisotropic tables in HDF5: the layout that reader and writer share.
 *
 * Root attributes: format ("gonio anisotropic BRDF table"), version (1), name, unit ("1/sr"),
 * equation, symmetry (s). Datasets: coefficient, float32 [theta_h 90][theta_d 90][phi_d P][channel]
 * [1 + 2 N], NaN for no data; floor, float64 [channel]; theta_limit, float64 [1], radians, 0 for
 * none; theta_h, theta_d, phi_d, float64, the cells' centres in radians; wavelength_nm, float64
 * [channel], where channels are wavelengths; otherwise there are three channels, R, G, B, or one.
 * material.h has the equation. */
#ifndef GONIO_ANISOTROPIC_FILE_H
#define GONIO_ANISOTROPIC_FILE_H

#include <gonio/material.h>

#define GONIO_I_ANISOTROPIC_FORMAT "gonio anisotropic BRDF table"

enum { GONIO_I_ANISOTROPIC_VERSION = 1, GONIO_I_ANISOTROPIC_RANK = 5 };

/* Writes a material as an anisotropic table: its own, or one that is made from it. The file appears
 * whole or not at all. Errors: _IO, _MEMORY, _CANCELLED, those of the material. */
gonio_status gonio_i_anisotropic_write(gonio_context *context, const gonio_material *material,
                                       const char *path);

#endif
