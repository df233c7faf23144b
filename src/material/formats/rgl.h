/* An RGL .bsdf in memory (rgl.c has the format's equations). */
#ifndef GONIO_RGL_H
#define GONIO_RGL_H

#include <stdbool.h>

#include <gonio/material.h>

#include "../warp.h"

/* A function over the unit square at the nodes of a grid. */
typedef struct gonio_i_rgl_image {
    size_t width;
    size_t height;
    float *value; /* [height][width] */
} gonio_i_rgl_image;

typedef struct gonio_i_rgl {
    size_t channels;
    double *wavelength; /* [channels], nm; NULL for R, G, B */
    size_t phis;
    double *phi; /* [phis]: azimuths of incidence, radians */
    size_t thetas;
    double *theta; /* [thetas] */
    bool isotropic;
    int repeats;   /* by rotation: 1, 2 (point symmetry) or 4 (two mirror planes) */
    bool jacobian; /* values are divided by ndf/(4 sigma) */
    gonio_i_rgl_image ndf;
    gonio_i_rgl_image sigma;
    gonio_i_warp vndf; /* slices [phis][thetas] */
    size_t side;       /* of the grid over s */
    float *value;      /* [phis][thetas][channels][side][side] */
    /* For a copy of the file; NULL where the file lacks them. */
    float *luminance;     /* [phis][thetas][side][side] */
    unsigned char *valid; /* [valid_size], bits */
    size_t valid_size;
    unsigned char *description; /* [description_size], not terminated */
    size_t description_size;
} gonio_i_rgl;

/* An image at (x, y) in the unit square, bilinear. */
double gonio_i_rgl_image_at(const gonio_i_rgl_image *image, double x, double y);

/* The coordinates of angles in images: u(theta), and v(phi) in [0, 1). */
double gonio_i_rgl_place_of_theta(double theta);
double gonio_i_rgl_place_of_phi(double phi);

/* The RGL file of a material, which belongs to the material; NULL if it was not read from one. */
const gonio_i_rgl *gonio_i_rgl_of(const gonio_material *material);

/* Writes it as it is, at most fields that gonio does not know missing. Errors: _IO, _MEMORY. */
gonio_status gonio_i_rgl_copy(gonio_context *context, const gonio_i_rgl *rgl, const char *name,
                              const char *path);

#endif
