/* Which reader an image file needs. */
#include "image.h"

/* The first line of every .hdr file; some programs write the second name. */
static bool is_radiance(const gonio_i_bytes *bytes)
{
    return gonio_i_begins_with(bytes, "#?RADIANCE\n", 11) ||
           gonio_i_begins_with(bytes, "#?RGBE\n", 7);
}

gonio_status gonio_image_read(gonio_context *context, const char *path, gonio_image **image)
{
    static const char exr_magic[4] = {0x76, 0x2f, 0x31, 0x01};
    gonio_i_bytes bytes;
    gonio_status status = gonio_i_read_bytes(context, path, &bytes);
    if (status != GONIO_OK) {
        return status;
    }
    if (gonio_i_begins_with(&bytes, exr_magic, sizeof exr_magic)) {
        status = gonio_i_read_exr(context, path, &bytes, image);
    } else if (is_radiance(&bytes)) {
        status = gonio_i_read_radiance(context, path, &bytes, image);
    } else {
        status = gonio_i_fail(context, GONIO_ERROR_FORMAT,
                              "%s: not an image that gonio reads (OpenEXR, Radiance .hdr), judged "
                              "by its content",
                              path);
    }
    gonio_i_free_bytes(&bytes);
    return status;
}
