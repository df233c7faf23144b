/* Triangle meshes from OBJ and PLY files, by assimp; checked, centred and scaled. */
#include "mesh.h"

#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "image.h"

/* What is counted while a mesh is made. */
typedef struct loading {
    gonio_context *context;
    const char *path;
    const struct aiScene *scene;
    size_t flat; /* triangles without area */
} loading;

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

/* ---- what assimp has read ---- */

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

static void add_triangle(loading *l, gonio_mesh *mesh, const unsigned *index, size_t first)
{
    uint32_t *corner = mesh->corner + 3 * mesh->triangles;
    for (int k = 0; k < 3; k++) {
        corner[k] = (uint32_t)(first + index[k]);
    }
    if (has_area(mesh->position + 3 * (size_t)corner[0], mesh->position + 3 * (size_t)corner[1],
                 mesh->position + 3 * (size_t)corner[2])) {
        mesh->triangles++;
    } else {
        l->flat++;
    }
}

static gonio_status add_part(loading *l, const struct aiMesh *part, gonio_mesh *mesh)
{
    const size_t first = mesh->corners;
    for (unsigned v = 0; v < part->mNumVertices; v++) {
        float *position = mesh->position + 3 * mesh->corners;
        float *normal = mesh->normal + 3 * mesh->corners;
        memcpy(position, &part->mVertices[v], 3 * sizeof *position);
        if (!is_finite_vector(position)) {
            return gonio_i_fail(
                l->context, GONIO_ERROR_DATA, "%s: corner %zu is not finite (%g, %g, %g)", l->path,
                mesh->corners + 1, (double)position[0], (double)position[1], (double)position[2]);
        }
        if (part->mNormals != NULL) {
            const struct aiVector3D *n = &part->mNormals[v];
            const float given[3] = {n->x, n->y, n->z};
            memcpy(normal, given, is_finite_vector(given) ? sizeof given : 0);
        }
        mesh->corners++;
    }
    for (unsigned f = 0; f < part->mNumFaces; f++) {
        const struct aiFace *face = &part->mFaces[f];
        if (face->mNumIndices != 3) { /* points and lines */
            continue;
        }
        for (int k = 0; k < 3; k++) {
            if (face->mIndices[k] >= part->mNumVertices) {
                return gonio_i_fail(l->context, GONIO_ERROR_FORMAT,
                                    "%s: face %u names a corner that is not there", l->path, f + 1);
            }
        }
        add_triangle(l, mesh, face->mIndices, first);
    }
    return GONIO_OK;
}

static gonio_status add_parts(loading *l, gonio_mesh *mesh)
{
    size_t corners = 0;
    size_t faces = 0;
    for (unsigned m = 0; m < l->scene->mNumMeshes; m++) {
        corners += l->scene->mMeshes[m]->mNumVertices;
        faces += l->scene->mMeshes[m]->mNumFaces;
    }
    if (corners > UINT32_MAX) {
        return gonio_i_fail(l->context, GONIO_ERROR_DATA, "%s: too many corners", l->path);
    }
    mesh->position = gonio_i_allocate(l->context, corners + 1, 3 * sizeof *mesh->position);
    mesh->normal = gonio_i_allocate(l->context, corners + 1, 3 * sizeof *mesh->normal);
    mesh->corner = gonio_i_allocate(l->context, faces + 1, 3 * sizeof *mesh->corner);
    if (mesh->position == NULL || mesh->normal == NULL || mesh->corner == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = GONIO_OK;
    for (unsigned m = 0; m < l->scene->mNumMeshes && status == GONIO_OK; m++) {
        status = add_part(l, l->scene->mMeshes[m], mesh);
    }
    if (status == GONIO_OK && mesh->triangles == 0) {
        status = gonio_i_fail(l->context, GONIO_ERROR_DATA,
                              l->flat > 0 ? "%s: none of its triangles has an area"
                                          : "%s: the mesh has no faces",
                              l->path);
    }
    return status;
}

/* ---- into the unit sphere ---- */

/* About the middle of the box around the corners that triangles use. */
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

/* Words that begin the lines of an OBJ file. */
static bool looks_like_obj(const gonio_i_bytes *bytes)
{
    static const char *const words[] = {"v", "vn", "vt", "vp", "f",      "l",     "p",
                                        "o", "g",  "s",  "#",  "mtllib", "usemtl"};
    if (memchr(bytes->data, '\0', bytes->size) != NULL) {
        return false;
    }
    const char *text = (const char *)bytes->data;
    text += strspn(text, " \t\r\n");
    const size_t length = text[0] == '#' ? 1 : strcspn(text, " \t\r\n");
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        if (strlen(words[k]) == length && strncmp(words[k], text, length) == 0) {
            return true;
        }
    }
    return false;
}

/* assimp's importer for what the content is; NULL for anything else. */
static const char *importer_of(const gonio_i_bytes *bytes)
{
    if (gonio_i_begins_with(bytes, "ply\n", 4) || gonio_i_begins_with(bytes, "ply\r", 4)) {
        return "ply";
    }
    return looks_like_obj(bytes) ? "obj" : NULL;
}

static bool states_normals(const gonio_i_bytes *bytes, const char *importer)
{
    const char *sign = strcmp(importer, "ply") == 0 ? " nx" : "\nvn";
    return memmem(bytes->data, bytes->size, sign, 3) != NULL;
}

static gonio_status make_mesh(loading *l, gonio_mesh **mesh)
{
    gonio_mesh *made = gonio_i_allocate(l->context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status = add_parts(l, made);
    if (status != GONIO_OK) {
        gonio_mesh_free(&made);
        return status;
    }
    if (l->flat > 0) {
        gonio_i_warn(l->context, "%s: %zu of %zu triangles have no area and are left out", l->path,
                     l->flat, l->flat + made->triangles);
    }
    fit(made);
    *mesh = made;
    return GONIO_OK;
}

/* Faces that meet at more than this angle do not share a normal where a file has none. */
static const float crease = 50.0F; /* degrees */

/* From memory, so that a file can name no other files. */
static gonio_status import(loading *l, const gonio_i_bytes *bytes, const char *importer,
                           gonio_mesh **mesh)
{
    const unsigned flags = aiProcess_Triangulate | aiProcess_GenSmoothNormals |
                           aiProcess_JoinIdenticalVertices | aiProcess_ValidateDataStructure;
    struct aiPropertyStore *how = aiCreatePropertyStore();
    if (how == NULL) {
        return gonio_i_fail(l->context, GONIO_ERROR_MEMORY, "%s: out of memory", l->path);
    }
    aiSetImportPropertyFloat(how, AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, crease);
    l->scene = aiImportFileFromMemoryWithProperties((const char *)bytes->data,
                                                    (unsigned)bytes->size, flags, importer, how);
    aiReleasePropertyStore(how);
    if (l->scene == NULL) {
        return gonio_i_fail(l->context, GONIO_ERROR_FORMAT, "%s: cannot be read as %s: %s", l->path,
                            importer, aiGetErrorString());
    }
    const gonio_status status = make_mesh(l, mesh);
    aiReleaseImport(l->scene);
    if (status == GONIO_OK && !states_normals(bytes, importer)) {
        gonio_i_note(l->context, "%s: has no normals; they are made from its faces", l->path);
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
    loading l = {.context = context, .path = path};
    const char *importer = importer_of(&bytes);
    if (importer == NULL || bytes.size > INT_MAX) {
        status = gonio_i_fail(context, GONIO_ERROR_FORMAT,
                              "%s: not a mesh that gonio reads (OBJ, PLY, below 2 GiB), judged by "
                              "its content",
                              path);
    } else {
        status = import(&l, &bytes, importer, mesh);
    }
    gonio_i_free_bytes(&bytes);
    return status;
}
