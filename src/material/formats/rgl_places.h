/* The density of the places of an RGL .bsdf: rgl_write.c explains their use. */
#ifndef GONIO_RGL_PLACES_H
#define GONIO_RGL_PLACES_H

#include <gonio/material.h>

#include "../sampler.h"

/* Nodes of ndf, sigma and vndf along u. */
enum { GONIO_I_RGL_NORMALS = 128 };

/* Light from theta_i at azimuth 0, mirrored at the half vector of (u, v). */
typedef struct gonio_i_rgl_mirrored {
    double theta_m;  /* polar angle of the half vector */
    double cosine_m; /* between it and the incident direction */
    double cosine_o; /* of the outgoing direction; negative below the horizon */
    gonio_angles outgoing;
} gonio_i_rgl_mirrored;

gonio_i_rgl_mirrored gonio_i_rgl_mirror(double theta_i, double u, double v);

/* The polar angle of a half vector at u. */
double gonio_i_rgl_theta(double u);

/* A row of nodes that are evenly spaced over 0 .. 1, looked up linearly. */
double gonio_i_rgl_look_up(const float row[GONIO_I_RGL_NORMALS], double u);

/* The density of places over u at its nodes, given ndf at the same. Directions beyond `limit`
 * (radians) do not count. Errors: _MEMORY, those of the source. */
gonio_status gonio_i_rgl_places(gonio_context *context, const gonio_i_sampler *sampler,
                                const float ndf[GONIO_I_RGL_NORMALS], double limit,
                                float density[GONIO_I_RGL_NORMALS]);

#endif
