/* A flat square sample. */
#include <stdlib.h>

#include "../core/core.h"
#include "mesh.h"

enum { SIDES = 4, TRIANGLES = 2 };

gonio_status gonio_i_mesh_flat(gonio_context *context, gonio_mesh **mesh)
{
    static const float at = 0.70710678F; /* its corners are on the unit sphere */
    static const float sign[SIDES][2] = {
        {-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}};
    static const uint32_t corner[3 * TRIANGLES] = {0, 1, 2, 0, 2, 3};
    gonio_mesh *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->corners = SIDES;
    made->triangles = TRIANGLES;
    made->position = gonio_i_allocate(context, 3 * (size_t)SIDES, sizeof *made->position);
    made->normal = gonio_i_allocate(context, 3 * (size_t)SIDES, sizeof *made->normal);
    made->corner = gonio_i_allocate(context, 3 * (size_t)TRIANGLES, sizeof *made->corner);
    if (made->position == NULL || made->normal == NULL || made->corner == NULL) {
        gonio_mesh_free(&made);
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < 3 * (size_t)SIDES; k++) {
        made->position[k] = k % 3 < 2 ? at * sign[k / 3][k % 3] : 0.0F;
        made->normal[k] = k % 3 < 2 ? 0.0F : 1.0F;
    }
    for (size_t k = 0; k < 3 * (size_t)TRIANGLES; k++) {
        made->corner[k] = corner[k];
    }
    *mesh = made;
    return GONIO_OK;
}
