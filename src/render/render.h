/* Inside rendering: materials that are ready. */
#ifndef GONIO_RENDER_RENDER_H
#define GONIO_RENDER_RENDER_H

#include "surface.h"

/* gonio_render of a prepared material, sampled like another (options' own is not looked at). */
gonio_status gonio_i_render_surface(gonio_context *context, const gonio_i_surface *surface,
                                    const gonio_i_surface *sampler,
                                    const gonio_render_options *options, gonio_image **image);

#endif
