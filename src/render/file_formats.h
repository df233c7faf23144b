/* Formats of meshes and images, judged by content, also without the renderer. */
#ifndef GONIO_RENDER_FILE_FORMATS_H
#define GONIO_RENDER_FILE_FORMATS_H

#include "../core/file_head.h"

typedef enum gonio_i_mesh_format {
    GONIO_I_OBJ = 0,
    GONIO_I_PLY,
    GONIO_I_NO_MESH
} gonio_i_mesh_format;

typedef enum gonio_i_image_format {
    GONIO_I_EXR = 0,
    GONIO_I_RADIANCE,
    GONIO_I_PNG, /* which is written, not read */
    GONIO_I_NO_IMAGE
} gonio_i_image_format;

/* The format of a file that begins with these bytes. A zero follows them. */
gonio_i_mesh_format gonio_i_mesh_format_find(const char *bytes, size_t size);
gonio_i_image_format gonio_i_image_format_find(const char *bytes, size_t size);

/* The name of a file's format; NULL if it has none of these. */
const char *gonio_i_mesh_format_of(const gonio_i_file *file);
const char *gonio_i_image_format_of(const gonio_i_file *file);

/* The names of the formats that are read; NULL past the last. */
const char *gonio_i_mesh_format_name(int index);
const char *gonio_i_image_format_name(int index);

#endif
