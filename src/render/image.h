/* Images inside the library: files read whole, and the readers and writers of formats. */
#ifndef GONIO_RENDER_IMAGE_H
#define GONIO_RENDER_IMAGE_H

#include <gonio/render.h>

#include "../core/core.h"

typedef struct gonio_i_bytes {
    size_t size;
    unsigned char *data; /* followed by a zero */
} gonio_i_bytes;

/* Errors: _IO; _FORMAT for an empty file; _MEMORY. Released with gonio_i_free_bytes. */
gonio_status gonio_i_read_bytes(gonio_context *context, const char *path, gonio_i_bytes *bytes);
void gonio_i_free_bytes(gonio_i_bytes *bytes);

/* Read OpenEXR and Radiance .hdr from memory. `path` is for messages. */
gonio_status gonio_i_read_exr(gonio_context *context, const char *path, const gonio_i_bytes *bytes,
                              gonio_image **image);
gonio_status gonio_i_read_radiance(gonio_context *context, const char *path,
                                   const gonio_i_bytes *bytes, gonio_image **image);

/* A picture, rgb[height][width][3], 8-bit sRGB. */
gonio_status gonio_i_write_png(gonio_context *context, int width, int height,
                               const unsigned char *rgb, const char *path);

/* A tone-mapped pixel on black, linear; a display shows 0 .. 1. */
void gonio_i_shown(const gonio_tone *tone, const float rgba[GONIO_IMAGE_CHANNELS], double shown[3]);

/* The same pixel as three bytes, encoded as sRGB. */
void gonio_i_shown_bytes(const double shown[3], unsigned char bytes[3]);

#endif
