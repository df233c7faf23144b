/* Normals of a mesh that has none. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "mesh.h"

/* Faces that meet at more than 50 degrees do not share a normal. */
static const double crease = 0.6427876096865393; /* its cosine */

/* A corner of more triangles than this is crowded; comparisons at all crowded ones: a second or
 * two.
 */
enum { CROWDED = 64 };
static const size_t patience = 200000000;

/* The triangles around each corner c: triangle[first[c]] .. triangle[first[c + 1] - 1]. */
typedef struct neighbours {
    size_t *first;      /* [corners + 1] */
    uint32_t *triangle; /* [3 triangles] */
    double *face;       /* [triangles][3]: normals as long as twice the area */
    size_t comparisons; /* so far, at crowded corners */
} neighbours;

static void free_neighbours(neighbours *n)
{
    free(n->first);
    free(n->triangle);
    free(n->face);
}

static void face_normal(const gonio_mesh *mesh, size_t triangle, double normal[3])
{
    const uint32_t *corner = mesh->corner + 3 * triangle;
    double u[3];
    double v[3];
    for (int k = 0; k < 3; k++) {
        const double origin = (double)mesh->position[3 * (size_t)corner[0] + k];
        u[k] = (double)mesh->position[3 * (size_t)corner[1] + k] - origin;
        v[k] = (double)mesh->position[3 * (size_t)corner[2] + k] - origin;
    }
    normal[0] = u[1] * v[2] - u[2] * v[1];
    normal[1] = u[2] * v[0] - u[0] * v[2];
    normal[2] = u[0] * v[1] - u[1] * v[0];
}

static gonio_status find_neighbours(gonio_context *context, const gonio_mesh *mesh, neighbours *n)
{
    const size_t uses = 3 * mesh->triangles;
    n->first = gonio_i_allocate(context, mesh->corners + 2, sizeof *n->first);
    n->triangle = gonio_i_allocate(context, uses, sizeof *n->triangle);
    n->face = gonio_i_allocate(context, mesh->triangles, 3 * sizeof *n->face);
    if (n->first == NULL || n->triangle == NULL || n->face == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    /* Numbers are counted two places ahead and summed up. Filling the lists moves them by one. */
    for (size_t k = 0; k < uses; k++) {
        n->first[(size_t)mesh->corner[k] + 2]++;
    }
    for (size_t c = 2; c < mesh->corners + 2; c++) {
        n->first[c] += n->first[c - 1];
    }
    for (size_t k = 0; k < uses; k++) {
        n->triangle[n->first[(size_t)mesh->corner[k] + 1]++] = (uint32_t)(k / 3);
    }
    for (size_t t = 0; t < mesh->triangles; t++) {
        face_normal(mesh, t, n->face + 3 * t);
    }
    return GONIO_OK;
}

/* Whether faces around the corner can still be compared with each other. */
static bool is_patient(neighbours *n, uint32_t corner)
{
    const size_t around = n->first[corner + 1] - n->first[corner];
    n->comparisons += around > CROWDED ? around : 0;
    return around <= CROWDED || n->comparisons <= patience;
}

static void mean_normal(neighbours *n, size_t triangle, uint32_t corner, float normal[3])
{
    const double *own = n->face + 3 * triangle;
    const bool alone = !is_patient(n, corner);
    double sum[3] = {alone ? own[0] : 0.0, alone ? own[1] : 0.0, alone ? own[2] : 0.0};
    for (size_t k = n->first[corner]; k < n->first[corner + 1] && !alone; k++) {
        const double *other = n->face + 3 * (size_t)n->triangle[k];
        const double lengths = gonio_i_length(own) * gonio_i_length(other);
        if (gonio_i_dot3(own, other) >= crease * lengths) {
            gonio_i_along(sum, 1.0, other, sum);
        }
    }
    gonio_i_normalise(sum);
    for (int k = 0; k < 3; k++) {
        normal[k] = (float)sum[k];
    }
}

/* Gives each triangle corners of its own, with their normals. */
static gonio_status split_corners(gonio_context *context, gonio_mesh *mesh, neighbours *n,
                                  float *position, float *normal)
{
    const size_t uses = 3 * mesh->triangles;
    for (size_t k = 0; k < uses; k++) {
        if (k % GONIO_I_MESH_PROGRESS == 0) {
            const gonio_status status =
                gonio_i_progress(context, "making normals", (double)k / (double)uses);
            if (status != GONIO_OK) {
                return status;
            }
        }
        memcpy(position + 3 * k, mesh->position + 3 * (size_t)mesh->corner[k],
               3 * sizeof *position);
        mean_normal(n, k / 3, mesh->corner[k], normal + 3 * k);
        mesh->corner[k] = (uint32_t)k;
    }
    return GONIO_OK;
}

gonio_status gonio_i_mesh_make_normals(gonio_context *context, gonio_mesh *mesh)
{
    const size_t uses = 3 * mesh->triangles;
    neighbours n = {0};
    float *position = NULL;
    float *normal = NULL;
    gonio_status status = find_neighbours(context, mesh, &n);
    if (status == GONIO_OK) {
        position = gonio_i_allocate(context, uses, 3 * sizeof *position);
        normal = gonio_i_allocate(context, uses, 3 * sizeof *normal);
        status = position != NULL && normal != NULL
                     ? split_corners(context, mesh, &n, position, normal)
                     : GONIO_ERROR_MEMORY;
    }
    free_neighbours(&n);
    if (status != GONIO_OK) {
        free(position);
        free(normal);
        return status;
    }
    free(mesh->position);
    free(mesh->normal);
    mesh->position = position;
    mesh->normal = normal;
    mesh->corners = uses;
    return GONIO_OK;
}
