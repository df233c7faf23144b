/* Radiance .hdr images, by stb_image. */
#include <limits.h>
#include <stb_image.h>

#include "image.h"

/* stb's floats are the caller's image but for A, which is 1. */
gonio_status gonio_i_read_radiance(gonio_context *context, const char *path,
                                   const gonio_i_bytes *bytes, gonio_image **image)
{
    int width = 0;
    int height = 0;
    int channels = 0;
    if (bytes->size > INT_MAX) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: larger than 2 GiB", path);
    }
    const int size = (int)bytes->size;
    if (stbi_info_from_memory(bytes->data, size, &width, &height, &channels) != 0 &&
        (width > GONIO_MOST_PIXELS || height > GONIO_MOST_PIXELS)) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: an image of %d x %d pixels: each side must be 1 to %d", path,
                            width, height, GONIO_MOST_PIXELS);
    }
    float *pixels =
        stbi_loadf_from_memory(bytes->data, size, &width, &height, &channels, GONIO_IMAGE_CHANNELS);
    if (pixels == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: cannot be read as a Radiance image: %s", path,
                            stbi_failure_reason());
    }
    const gonio_status status = gonio_image_create(context, width, height, image);
    if (status == GONIO_OK) {
        const size_t count = (size_t)width * (size_t)height * GONIO_IMAGE_CHANNELS;
        for (size_t k = 0; k < count; k++) {
            (*image)->rgba[k] = pixels[k];
        }
    }
    stbi_image_free(pixels);
    return status;
}
