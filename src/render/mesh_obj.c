/* OBJ meshes, by assimp. It sees only the lines of corners, faces and groups, because its readers
 * of materials do not tolerate damaged files. */
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh.h"

/* ---- selecting lines ---- */

/* Whether a line begins with a word that is kept. */
static bool is_kept(const char *line, const char *end)
{
    static const char *const words[] = {"v", "vn", "vt", "f", "g", "o", "s"};
    while (line < end && (*line == ' ' || *line == '\t')) {
        line++;
    }
    size_t length = 0;
    while (line + length < end && strchr(" \t\r", line[length]) == NULL) {
        length++;
    }
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        if (strlen(words[k]) == length && memcmp(words[k], line, length) == 0) {
            return true;
        }
    }
    return false;
}

/* Whether a line continues in the next. */
static bool goes_on(const char *line, const char *end)
{
    end -= end > line && end[-1] == '\r';
    return end > line && end[-1] == '\\';
}

/* Replaces all other lines, and those that continue them, by blanks. */
static void blank_others(char *text, size_t size)
{
    const char *last = text + size;
    bool continued = false;
    bool kept = false;
    for (char *line = text; line < last;) {
        char *end = memchr(line, '\n', (size_t)(last - line));
        end = end != NULL ? end : text + size;
        kept = continued ? kept : is_kept(line, end);
        continued = goes_on(line, end);
        if (!kept) {
            memset(line, ' ', (size_t)(end - line));
        }
        line = end + 1;
    }
}

/* ---- size ---- */

/* The largest side of the box around all corners. */
static double extent_of(const struct aiScene *scene)
{
    double low[3] = {INFINITY, INFINITY, INFINITY};
    double high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (unsigned m = 0; m < scene->mNumMeshes; m++) {
        for (unsigned v = 0; v < scene->mMeshes[m]->mNumVertices; v++) {
            const struct aiVector3D *p = &scene->mMeshes[m]->mVertices[v];
            const double at[3] = {p->x, p->y, p->z};
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], at[k]);
                high[k] = fmax(high[k], at[k]);
            }
        }
    }
    return fmax(fmax(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
}

/* Enlarges a small mesh by a power of two, which is exact: assimp joins corners that are closer
 * than 1e-5 in any unit. */
static void enlarge(const struct aiScene *scene)
{
    const double extent = extent_of(scene);
    if (!(extent > 0.0) || extent >= 1024.0 || !isfinite(extent)) {
        return;
    }
    const float factor = (float)ldexp(1.0, (int)fmin(10 - ilogb(extent), 120));
    for (unsigned m = 0; m < scene->mNumMeshes; m++) {
        for (unsigned v = 0; v < scene->mMeshes[m]->mNumVertices; v++) {
            struct aiVector3D *p = &scene->mMeshes[m]->mVertices[v];
            p->x *= factor;
            p->y *= factor;
            p->z *= factor;
        }
    }
}

/* ---- the mesh ---- */

static gonio_status add_part(gonio_i_mesh_making *making, const struct aiMesh *part)
{
    gonio_status status = GONIO_OK;
    const size_t first = making->mesh->corners;
    for (unsigned v = 0; v < part->mNumVertices && status == GONIO_OK; v++) {
        const struct aiVector3D *p = &part->mVertices[v];
        const struct aiVector3D *n = part->mNormals != NULL ? &part->mNormals[v] : p;
        const float position[3] = {p->x, p->y, p->z};
        const float normal[3] = {n->x, n->y, n->z};
        status = gonio_i_mesh_add_corner(making, position, part->mNormals != NULL ? normal : NULL);
    }
    for (unsigned f = 0; f < part->mNumFaces && status == GONIO_OK; f++) {
        const struct aiFace *face = &part->mFaces[f];
        if (face->mNumIndices == 3) { /* not points and lines */
            const uint32_t corner[3] = {(uint32_t)(first + face->mIndices[0]),
                                        (uint32_t)(first + face->mIndices[1]),
                                        (uint32_t)(first + face->mIndices[2])};
            status = gonio_i_mesh_add_triangle(making, corner);
        }
    }
    return status;
}

/* Reads a text from memory, so that it cannot refer to other files. NULL if it cannot be read. */
static const struct aiScene *import_scene(const char *text, size_t size)
{
    const struct aiScene *scene =
        aiImportFileFromMemory(text, (unsigned)size, aiProcess_ValidateDataStructure, "obj");
    if (scene == NULL) {
        return NULL;
    }
    enlarge(scene);
    return aiApplyPostProcessing(scene, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices);
}

gonio_status gonio_i_read_obj(gonio_i_mesh_making *making, const gonio_i_bytes *bytes)
{
    char *text = gonio_i_allocate(making->context, bytes->size + 1, 1);
    if (text == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(text, bytes->data, bytes->size);
    blank_others(text, bytes->size);
    const struct aiScene *scene = import_scene(text, bytes->size);
    free(text);
    if (scene == NULL) {
        return gonio_i_fail(making->context, GONIO_ERROR_FORMAT, "%s: cannot be read as OBJ: %s",
                            making->path, aiGetErrorString());
    }
    gonio_status status = GONIO_OK;
    for (unsigned m = 0; m < scene->mNumMeshes && status == GONIO_OK; m++) {
        status = add_part(making, scene->mMeshes[m]);
    }
    aiReleaseImport(scene);
    return status;
}
