/* Where rays meet the object. */
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

/* A mesh, or with NULL the unit sphere. Tracing is safe from several threads. Errors: _MEMORY. */
gonio_status gonio_i_scene_create(gonio_context *context, const gonio_mesh *mesh,
                                  gonio_i_scene **scene);
void gonio_i_scene_free(gonio_i_scene **scene);

/* direction: unit. */
bool gonio_i_scene_trace(const gonio_i_scene *scene, const double origin[3],
                         const double direction[3], gonio_i_hit *hit);

/* Whether the way from a hit in a direction, so far (INFINITY allowed), is free. */
bool gonio_i_scene_is_free(const gonio_i_scene *scene, const gonio_i_hit *hit,
                           const double direction[3], double distance);

#endif
