/* Formats of meshes and images, judged by content: see file_formats.h. */
#include "file_formats.h"

#include <string.h>

static const char *const mesh_names[] = {"OBJ", "PLY"};
static const char *const image_names[] = {"OpenEXR", "Radiance .hdr", "PNG"};

static bool begins(const char *bytes, size_t size, const char *with, size_t length)
{
    return size >= length && memcmp(bytes, with, length) == 0;
}

/* Whether lines begin with the words of OBJ files. */
static bool looks_like_obj(const char *bytes, size_t size)
{
    static const char *const words[] = {"v",      "vn",     "vt",     "vp",  "f",    "l",
                                        "p",      "o",      "g",      "s",   "mg",   "mtllib",
                                        "usemtl", "usemap", "maplib", "lod", "call", "csh"};
    size_t line = 0;
    const char *text = gonio_i_first_line(bytes, size, &line);
    const size_t length = text != NULL ? strcspn(text, " \t\r\n") : 0;
    for (size_t k = 0; k < sizeof words / sizeof *words && length > 0; k++) {
        if (strlen(words[k]) == length && strncmp(words[k], text, length) == 0) {
            return true;
        }
    }
    return false;
}

gonio_i_mesh_format gonio_i_mesh_format_find(const char *bytes, size_t size)
{
    if (begins(bytes, size, "ply\n", 4) || begins(bytes, size, "ply\r", 4)) {
        return GONIO_I_PLY;
    }
    return looks_like_obj(bytes, size) ? GONIO_I_OBJ : GONIO_I_NO_MESH;
}

gonio_i_image_format gonio_i_image_format_find(const char *bytes, size_t size)
{
    static const char exr[] = "\x76\x2f\x31\x01";
    static const char png[] = "\x89PNG\r\n\x1a\n";
    if (begins(bytes, size, exr, sizeof exr - 1)) {
        return GONIO_I_EXR;
    }
    /* The first line of every .hdr file; some programs write the second name. */
    if (begins(bytes, size, "#?RADIANCE\n", 11) || begins(bytes, size, "#?RGBE\n", 7)) {
        return GONIO_I_RADIANCE;
    }
    return begins(bytes, size, png, sizeof png - 1) ? GONIO_I_PNG : GONIO_I_NO_IMAGE;
}

const char *gonio_i_mesh_format_of(const gonio_i_file *file)
{
    const gonio_i_mesh_format format = gonio_i_mesh_format_find(file->head, file->head_size);
    return format != GONIO_I_NO_MESH ? mesh_names[format] : NULL;
}

const char *gonio_i_image_format_of(const gonio_i_file *file)
{
    const gonio_i_image_format format = gonio_i_image_format_find(file->head, file->head_size);
    return format != GONIO_I_NO_IMAGE ? image_names[format] : NULL;
}

const char *gonio_i_mesh_format_name(int index)
{
    return index < GONIO_I_NO_MESH ? mesh_names[index] : NULL;
}

const char *gonio_i_image_format_name(int index)
{
    return index < GONIO_I_PNG ? image_names[index] : NULL;
}
