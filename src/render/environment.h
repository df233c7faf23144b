/* Inside an environment: looking it up and sampling it. */
#ifndef GONIO_RENDER_ENVIRONMENT_H
#define GONIO_RENDER_ENVIRONMENT_H

#include <gonio/render.h>

/* Radiance from a direction (unit, of the environment's own frame), and how densely
 * gonio_i_environment_sample samples it, 1/sr. */
void gonio_i_environment_look(const gonio_environment *environment, const double direction[3],
                              double radiance[3], double *density);

/* The radiance, linear between pixels, for showing it. */
void gonio_i_environment_shown(const gonio_environment *environment, const double direction[3],
                               double radiance[3]);

/* A direction for two uniform numbers in (0, 1), with density in proportion to the luminance. */
void gonio_i_environment_sample(const gonio_environment *environment, const double uniform[2],
                                double direction[3]);

/* Wraps an image, which it takes over in any case. Errors as gonio_environment_open. */
gonio_status gonio_i_environment_wrap(gonio_context *context, const char *name, gonio_image *image,
                                      bool repair, gonio_environment **environment);

/* An image of a built-in environment; NULL is written for an unknown name. */
gonio_status gonio_i_environment_make(gonio_context *context, const char *name,
                                      gonio_image **image);

#endif
