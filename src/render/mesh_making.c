/* Adding corners and triangles to a mesh, each of them checked. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "mesh.h"

static bool is_finite_vector(const float v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

/* Twice the area, squared, relative to the longest side: 0 for a triangle without area. */
static bool has_area(const float *a, const float *b, const float *c)
{
    double u[3];
    double v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)b[k] - (double)a[k];
        v[k] = (double)c[k] - (double)a[k];
    }
    const double cross[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                             u[0] * v[1] - u[1] * v[0]};
    const double side = fmax(gonio_i_length(u), gonio_i_length(v));
    return gonio_i_length(cross) > 1e-12 * side * side && side > 0.0;
}

/* Makes room for one more item of `size` bytes, by doubling. */
static gonio_status make_room(const gonio_i_mesh_making *m, size_t count, size_t size, size_t *room,
                              void **array)
{
    if (count < *room) {
        return GONIO_OK;
    }
    const size_t wanted = *room > 0 ? 2 * *room : 1024;
    void *larger = wanted <= UINT32_MAX / 4 ? reallocarray(*array, wanted, size) : NULL;
    if (larger == NULL) {
        return gonio_i_fail(m->context, GONIO_ERROR_MEMORY, "%s: too large: out of memory",
                            m->path);
    }
    *array = larger;
    *room = wanted;
    return GONIO_OK;
}

gonio_status gonio_i_mesh_add_corner(gonio_i_mesh_making *making, const float position[3],
                                     const float *normal)
{
    static const float none[3] = {0.0F, 0.0F, 0.0F};
    gonio_mesh *mesh = making->mesh;
    if (!is_finite_vector(position)) {
        return gonio_i_fail(making->context, GONIO_ERROR_DATA,
                            "%s: corner %zu is not finite (%g, %g, %g)", making->path,
                            mesh->corners + 1, (double)position[0], (double)position[1],
                            (double)position[2]);
    }
    size_t room = making->corner_room;
    gonio_status status =
        make_room(making, mesh->corners, 3 * sizeof(float), &room, (void **)&mesh->position);
    if (status == GONIO_OK) {
        status = make_room(making, mesh->corners, 3 * sizeof(float), &making->corner_room,
                           (void **)&mesh->normal);
    }
    if (status == GONIO_OK) {
        const bool given = normal != NULL && is_finite_vector(normal);
        memcpy(mesh->position + 3 * mesh->corners, position, 3 * sizeof *position);
        memcpy(mesh->normal + 3 * mesh->corners, given ? normal : none, 3 * sizeof *none);
        making->with_normals = making->with_normals && given;
        mesh->corners++;
    }
    return status;
}

gonio_status gonio_i_mesh_add_triangle(gonio_i_mesh_making *making, const uint32_t corner[3])
{
    gonio_mesh *mesh = making->mesh;
    for (int k = 0; k < 3; k++) {
        if (corner[k] >= mesh->corners) {
            return gonio_i_fail(making->context, GONIO_ERROR_FORMAT,
                                "%s: a face names a corner that does not exist", making->path);
        }
    }
    if (!has_area(mesh->position + 3 * (size_t)corner[0], mesh->position + 3 * (size_t)corner[1],
                  mesh->position + 3 * (size_t)corner[2])) {
        making->flat++;
        return GONIO_OK;
    }
    const gonio_status status = make_room(making, mesh->triangles, 3 * sizeof(uint32_t),
                                          &making->triangle_room, (void **)&mesh->corner);
    if (status == GONIO_OK) {
        memcpy(mesh->corner + 3 * mesh->triangles, corner, 3 * sizeof *corner);
        mesh->triangles++;
    }
    return status;
}
