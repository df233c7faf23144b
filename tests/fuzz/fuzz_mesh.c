/* libFuzzer on meshes, OBJ and PLY: whatever the bytes are, a file is refused with one message or
 * is triangles of corners that there are, in the unit sphere. */
#include "fuzz.h"

#include "render/mesh.h"

static void check_mesh(const gonio_mesh *mesh)
{
    check(mesh->triangles > 0 && mesh->corners > 0, "a mesh has triangles");
    for (size_t k = 0; k < 3 * mesh->triangles; k++) {
        check(mesh->corner[k] < mesh->corners, "a corner is there");
        const float *position = mesh->position + 3 * (size_t)mesh->corner[k];
        const float *normal = mesh->normal + 3 * (size_t)mesh->corner[k];
        for (int c = 0; c < 3; c++) {
            check(fabsf(position[c]) < 1.01F, "it fits the sphere");
            check(fabsf(normal[c]) < 1.01F, "normals are unit vectors");
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    char path[128];
    gonio_mesh *mesh = NULL;
    fuzz_path(path, "mesh");
    fuzz_write(path, data, size);
    const gonio_status status = gonio_mesh_read(context, path, &mesh);
    check_status(status);
    if (status == GONIO_OK) {
        check_mesh(mesh);
    }
    gonio_mesh_free(&mesh);
    unlink(path);
    return 0;
}
