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
    double *weight; /* [GONIO_CHANNELS][source.channels]: from spectra to colours, or NULL */
};

#endif
