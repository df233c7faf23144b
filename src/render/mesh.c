/* Triangle meshes from files: chooses the reader of a format, centres and scales the mesh. */
#include "mesh.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "file_formats.h"
#include "geometry.h"

void gonio_mesh_free(gonio_mesh **mesh)
{
    if (mesh == NULL || *mesh == NULL) {
        return;
    }
    free((*mesh)->position);
    free((*mesh)->normal);
    free((*mesh)->corner);
    free(*mesh);
    *mesh = NULL;
}

size_t gonio_mesh_triangles(const gonio_mesh *mesh)
{
    return mesh->triangles;
}

size_t gonio_mesh_corners(const gonio_mesh *mesh)
{
    return mesh->corners;
}

/* ---- into the unit sphere ---- */

/* The centre of the box around the corners that triangles use. */
static void find_centre(const gonio_mesh *mesh, double centre[3])
{
    double low[3] = {INFINITY, INFINITY, INFINITY};
    double high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t t = 0; t < 3 * mesh->triangles; t++) {
        const float *p = mesh->position + 3 * (size_t)mesh->corner[t];
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], (double)p[k]);
            high[k] = fmax(high[k], (double)p[k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        centre[k] = 0.5 * (low[k] + high[k]);
    }
}

static void fit(gonio_mesh *mesh)
{
    double centre[3];
    find_centre(mesh, centre);
    double radius = 0.0;
    for (size_t t = 0; t < 3 * mesh->triangles; t++) {
        const float *p = mesh->position + 3 * (size_t)mesh->corner[t];
        const double d[3] = {(double)p[0] - centre[0], (double)p[1] - centre[1],
                             (double)p[2] - centre[2]};
        radius = fmax(radius, gonio_i_length(d));
    }
    for (size_t k = 0; k < 3 * mesh->corners; k++) {
        mesh->position[k] = (float)(((double)mesh->position[k] - centre[k % 3]) / radius);
    }
    for (size_t c = 0; c < mesh->corners; c++) {
        float *n = mesh->normal + 3 * c;
        double unit[3] = {(double)n[0], (double)n[1], (double)n[2]};
        gonio_i_normalise(unit);
        for (int k = 0; k < 3; k++) {
            n[k] = (float)unit[k];
        }
    }
}

/* ---- reading ---- */

typedef gonio_status mesh_reader(gonio_i_mesh_making *making, const gonio_i_bytes *bytes);

/* In the order of gonio_i_mesh_format. */
static mesh_reader *const readers[] = {gonio_i_read_obj, gonio_i_read_ply, NULL};

static gonio_status read_bytes(gonio_i_mesh_making *making, const gonio_i_bytes *bytes)
{
    mesh_reader *const reader =
        readers[gonio_i_mesh_format_find((const char *)bytes->data, bytes->size)];
    if (reader == NULL || bytes->size > INT_MAX) {
        return gonio_i_fail(making->context, GONIO_ERROR_FORMAT,
                            "%s: not a mesh that gonio reads (OBJ, PLY, below 2 GiB), judged by "
                            "its content",
                            making->path);
    }
    const gonio_status status = reader(making, bytes);
    if (status == GONIO_OK && making->mesh->triangles == 0) {
        return gonio_i_fail(making->context, GONIO_ERROR_DATA,
                            making->flat > 0 ? "%s: none of its triangles has an area"
                                             : "%s: the mesh has no faces",
                            making->path);
    }
    return status;
}

/* Warns of flaws of a mesh that is used all the same. */
static gonio_status finish(const gonio_i_mesh_making *making)
{
    gonio_status status = GONIO_OK;
    if (making->flat > 0) {
        gonio_i_warn(making->context, "%s: %zu of %zu triangles have no area and are left out",
                     making->path, making->flat, making->flat + making->mesh->triangles);
    }
    if (!making->with_normals) {
        gonio_i_note(making->context, "%s: lacks normals; they are made from its faces",
                     making->path);
        status = gonio_i_mesh_make_normals(making->context, making->mesh);
    }
    if (status == GONIO_OK) {
        fit(making->mesh);
    }
    return status;
}

gonio_status gonio_mesh_read(gonio_context *context, const char *path, gonio_mesh **mesh)
{
    gonio_i_bytes bytes;
    gonio_status status = gonio_i_read_bytes(context, path, &bytes);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_i_mesh_making making = {.context = context, .path = path, .with_normals = true};
    making.mesh = gonio_i_allocate(context, 1, sizeof *making.mesh);
    status = making.mesh == NULL ? GONIO_ERROR_MEMORY : read_bytes(&making, &bytes);
    gonio_i_free_bytes(&bytes);
    free(making.polygon);
    if (status == GONIO_OK) {
        status = finish(&making);
    }
    if (status != GONIO_OK) {
        gonio_mesh_free(&making.mesh);
        return status;
    }
    *mesh = making.mesh;
    return GONIO_OK;
}
