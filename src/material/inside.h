/* The struct of a material, for this stage's files. */
#ifndef GONIO_MATERIAL_INSIDE_H
#define GONIO_MATERIAL_INSIDE_H

#include <gonio/material.h>

struct gonio_material {
    char *name;
    char *format;
    gonio_material_source source;
    double *wavelength; /* [source.channels]; NULL for colours */
    gonio_material_view view;
    /* Fills, of a slab, the row of phi_d at one theta_d index, in its place: the same numbers as
     * the source's read_slab, for a few directions. NULL: read_slab is used. */
    gonio_status (*read_row)(void *self, gonio_context *context, int theta_h, int theta_d,
                             double *rho);
    double *weight; /* [GONIO_CHANNELS][source.channels]: from spectra to colours, or NULL */
};

#endif
