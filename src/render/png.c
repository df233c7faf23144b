/* PNG pictures, by libpng. */
#include <png.h>
#include <stdlib.h>

#include "../core/output.h"
#include "image.h"

gonio_status gonio_i_write_png(gonio_context *context, int width, int height,
                               const unsigned char *rgb, const char *path)
{
    png_image png = {.version = PNG_IMAGE_VERSION,
                     .width = (png_uint_32)width,
                     .height = (png_uint_32)height,
                     .format = PNG_FORMAT_RGB};
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    unsigned char *bytes = gonio_i_allocate(context, size, 1);
    if (bytes == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = GONIO_OK;
    if (png_image_write_to_memory(&png, bytes, &size, 0, rgb, 0, NULL) == 0) {
        status = gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot be made as PNG: %s", path,
                              png.message);
    }
    gonio_i_output output;
    if (status == GONIO_OK) {
        status = gonio_i_output_open(context, path, &output);
        if (status == GONIO_OK) {
            status = gonio_i_output_write(context, &output, bytes, size);
            status = gonio_i_output_close(context, &output, status);
        }
    }
    free(bytes);
    return status;
}

gonio_status gonio_image_write_png(gonio_context *context, const gonio_image *image,
                                   const gonio_tone *tone, const char *path)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    unsigned char *rgb = gonio_i_allocate(context, pixels, 3);
    if (rgb == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < pixels; k++) {
        double shown[3];
        gonio_i_shown(tone, image->rgba + k * GONIO_IMAGE_CHANNELS, shown);
        gonio_i_shown_bytes(shown, rgb + 3 * k);
    }
    const gonio_status status = gonio_i_write_png(context, image->width, image->height, rgb, path);
    free(rgb);
    return status;
}
