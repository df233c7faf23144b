/* The files that a command is given, opened once they are known to be what it needs. */
#ifndef GONIO_INPUTS_H
#define GONIO_INPUTS_H

#include "command_line.h"

/* As gonio_material_open, after gonio_file_expect. */
gonio_status tool_open_material(const tool *t, const char *path, gonio_material **material);

/* As gonio_readings_read, after gonio_file_expect. */
gonio_status tool_read_readings(const tool *t, const char *path,
                                const gonio_readings_options *options, gonio_readings **readings);

/* As gonio_mesh_read, after gonio_file_expect. */
gonio_status tool_read_mesh(const tool *t, const char *path, gonio_mesh **mesh);

#endif
