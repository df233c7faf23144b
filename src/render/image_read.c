/* Reading images: chooses the reader of a file's format. */
#include "file_formats.h"
#include "image.h"

gonio_status gonio_image_read(gonio_context *context, const char *path, gonio_image **image)
{
    gonio_i_bytes bytes;
    gonio_status status = gonio_i_read_bytes(context, path, &bytes);
    if (status != GONIO_OK) {
        return status;
    }
    switch (gonio_i_image_format_find((const char *)bytes.data, bytes.size)) {
    case GONIO_I_EXR:
        status = gonio_i_read_exr(context, path, &bytes, image);
        break;
    case GONIO_I_RADIANCE:
        status = gonio_i_read_radiance(context, path, &bytes, image);
        break;
    default:
        status = gonio_i_fail(context, GONIO_ERROR_FORMAT,
                              "%s: not an image that gonio reads (%s, %s), judged by its content",
                              path, gonio_i_image_format_name(GONIO_I_EXR),
                              gonio_i_image_format_name(GONIO_I_RADIANCE));
    }
    gonio_i_free_bytes(&bytes);
    return status;
}
