/* Environments inside the library: looking them up and sampling them. */
#ifndef GONIO_RENDER_ENVIRONMENT_H
#define GONIO_RENDER_ENVIRONMENT_H

#include <gonio/render.h>

/* The radiance from a direction (unit, in the environment's frame), and the density with which
 * gonio_i_environment_sample samples it, 1/sr. */
void gonio_i_environment_look(const gonio_environment *environment, const double direction[3],
                              double radiance[3], double *density);

/* The radiance for display: linear between pixels. */
void gonio_i_environment_shown(const gonio_environment *environment, const double direction[3],
                               double radiance[3]);

/* A direction for two uniform numbers in (0, 1). Its density is proportional to the luminance. */
void gonio_i_environment_sample(const gonio_environment *environment, const double uniform[2],
                                double direction[3]);

/* Makes an environment of an image, which it owns in any case. Errors: as gonio_environment_open.
 */
gonio_status gonio_i_environment_wrap(gonio_context *context, const char *name, gonio_image *image,
                                      bool repair, gonio_environment **environment);

/* Makes the image of a built-in environment; NULL for an unknown name. */
gonio_status gonio_i_environment_make(gonio_context *context, const char *name,
                                      gonio_image **image);

#endif
