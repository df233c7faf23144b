/* A material prepared for rendering: fast to look up at any pair of directions, and to sample.
 *
 * Directions are unit vectors in the surface's frame (normal +z), both above the surface. */
#ifndef GONIO_RENDER_SURFACE_H
#define GONIO_RENDER_SURFACE_H

#include <gonio/render.h>

typedef struct gonio_i_surface gonio_i_surface;

/* The material must outlive calls that ask for values; sampling does not need it. Errors: _DATA if
 * the material has no data at all, _MEMORY, _CANCELLED, those of the material. */
gonio_status gonio_i_surface_create(gonio_context *context, const gonio_material *material,
                                    gonio_i_surface **surface);
void gonio_i_surface_free(gonio_i_surface **surface);

/* Whether its values depend on the azimuth of the frame. */
bool gonio_i_surface_is_anisotropic(const gonio_i_surface *surface);

/* The coordinates of two directions. */
typedef struct gonio_i_meeting {
    double towards_light[3]; /* the directions themselves */
    double towards_viewer[3];
    gonio_half_difference at;
    double incident; /* cosine of the incident direction */
    double half;     /* cosine between either direction and the half vector */
} gonio_i_meeting;

gonio_i_meeting gonio_i_meet(const double incident[3], const double outgoing[3]);

/* The BRDF, 1/sr: that of gonio_material_evaluate if the material can be evaluated at any
 * directions, otherwise that of gonio_table_value. Without data there, it is that of the nearest
 * bin with data (render.h). */
void gonio_i_surface_value(const gonio_i_surface *surface, const gonio_i_meeting *meeting,
                           double rho[GONIO_CHANNELS]);

/* An incident direction for three uniform numbers in (0, 1). It is sampled either by the cosine or
 * by a half vector whose polar angle is distributed like the highlight, each as often as its share
 * of the reflected light. False if the direction is below the surface. */
bool gonio_i_surface_sample(const gonio_i_surface *surface, const double outgoing[3],
                            const double uniform[3], double incident[3]);

/* The density of gonio_i_surface_sample, 1/sr. */
double gonio_i_surface_density(const gonio_i_surface *surface, const gonio_i_meeting *meeting);

#endif
