/* OBJ meshes, by assimp. */
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "mesh.h"

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

/* From memory, so that a file can name no other files. */
gonio_status gonio_i_read_obj(gonio_i_mesh_making *making, const gonio_i_bytes *bytes)
{
    const unsigned flags =
        aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_ValidateDataStructure;
    const struct aiScene *scene =
        aiImportFileFromMemory((const char *)bytes->data, (unsigned)bytes->size, flags, "obj");
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
