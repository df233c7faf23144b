/* The files that a command is given: see inputs.h. */
#include "inputs.h"

const char *tool_as;

gonio_status tool_open_material(const tool *t, const char *path, gonio_material **material)
{
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    const gonio_status status = gonio_file_expect(t->context, path, GONIO_KIND_MATERIAL, &kind);
    return status == GONIO_OK ? gonio_material_open(t->context, path, material) : status;
}

gonio_status tool_read_readings(const tool *t, const char *path,
                                const gonio_readings_options *options, gonio_readings **readings)
{
    gonio_readings_options how = *options;
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    gonio_status status = GONIO_OK;
    if (tool_as != NULL) {
        status = gonio_convention_parse(t->context, tool_as, &how.as);
    }
    if (status == GONIO_OK && how.as.format == NULL) {
        status = gonio_file_expect(t->context, path, GONIO_KIND_READINGS, &kind);
    }
    return status == GONIO_OK ? gonio_readings_read(t->context, path, &how, readings) : status;
}

gonio_status tool_read_mesh(const tool *t, const char *path, gonio_mesh **mesh)
{
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    const gonio_status status = gonio_file_expect(t->context, path, GONIO_KIND_MESH, &kind);
    return status == GONIO_OK ? gonio_mesh_read(t->context, path, mesh) : status;
}
