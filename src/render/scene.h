/* The object that rays meet. */
#ifndef GONIO_RENDER_SCENE_H
#define GONIO_RENDER_SCENE_H

#include <gonio/render.h>

#include "../core/core.h"

typedef struct gonio_i_scene gonio_i_scene;

typedef struct gonio_i_hit {
    double point[3];
    double face[3];   /* unit normal of the surface, on the side that the ray came from */
    double normal[3]; /* the same interpolated between a mesh's corners */
} gonio_i_hit;

/* Makes a scene of a mesh, or of the unit sphere (NULL). Several threads may trace it. Errors:
 * _MEMORY. */
gonio_status gonio_i_scene_create(gonio_context *context, const gonio_mesh *mesh,
                                  gonio_i_scene **scene);
void gonio_i_scene_free(gonio_i_scene **scene);

/* Traces a ray. direction: unit. Returns whether it meets the object. */
bool gonio_i_scene_trace(const gonio_i_scene *scene, const double origin[3],
                         const double direction[3], gonio_i_hit *hit);

/* Whether nothing is in the way from a hit in a direction, up to a distance (INFINITY allowed). */
bool gonio_i_scene_is_free(const gonio_i_scene *scene, const gonio_i_hit *hit,
                           const double direction[3], double distance);

#endif
