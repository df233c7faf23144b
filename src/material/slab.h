/* A slab of the grid from any material. */
#ifndef GONIO_SLAB_H
#define GONIO_SLAB_H

#include <gonio/material.h>

/* gonio_material_read_slab, where a material without read_slab is evaluated at one bin of each run
 * of `run` bins of phi_d, whose value the others get. The index theta_h must be valid. A bin gets
 * the mean over the pair and its reciprocal and, if the source is anisotropic, over azimuths of the
 * half vector (azimuth_mean.h). */
gonio_status gonio_i_slab_read(gonio_context *context, const gonio_material *material, int theta_h,
                               int run, double *rho);

#endif
