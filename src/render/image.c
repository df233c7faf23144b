/* Images in memory, and files read whole. */
#include "image.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

gonio_status gonio_image_create(gonio_context *context, int width, int height, gonio_image **image)
{
    if (width < 1 || height < 1 || width > GONIO_MOST_PIXELS || height > GONIO_MOST_PIXELS) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "an image of %d x %d pixels: each side must be 1 to %d", width, height,
                            GONIO_MOST_PIXELS);
    }
    gonio_image *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *made = (gonio_image){width, height, NULL};
    made->rgba = gonio_i_allocate(context, (size_t)width * (size_t)height,
                                  GONIO_IMAGE_CHANNELS * sizeof *made->rgba);
    if (made->rgba == NULL) {
        free(made);
        return GONIO_ERROR_MEMORY;
    }
    *image = made;
    return GONIO_OK;
}

void gonio_image_free(gonio_image **image)
{
    if (image == NULL || *image == NULL) {
        return;
    }
    free((*image)->rgba);
    free(*image);
    *image = NULL;
}

/* ---- whole files ---- */

static gonio_status cannot_read(gonio_context *context, const char *path, const char *why)
{
    return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, why);
}

static gonio_status read_stream(gonio_context *context, const char *path, FILE *stream,
                                gonio_i_bytes *bytes)
{
    struct stat status;
    if (fstat(fileno(stream), &status) != 0) {
        return cannot_read(context, path, strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) {
        return cannot_read(context, path,
                           S_ISDIR(status.st_mode) ? strerror(EISDIR) : "not a regular file");
    }
    if (status.st_size == 0) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: the file is empty", path);
    }
    /* One byte more, so that text ends with a zero. */
    bytes->data = gonio_i_allocate(context, (size_t)status.st_size + 1, 1);
    if (bytes->data == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    bytes->size = fread(bytes->data, 1, (size_t)status.st_size, stream);
    return bytes->size == (size_t)status.st_size
               ? GONIO_OK
               : cannot_read(context, path, "it became shorter meanwhile");
}

gonio_status gonio_i_read_bytes(gonio_context *context, const char *path, gonio_i_bytes *bytes)
{
    *bytes = (gonio_i_bytes){0};
    struct stat look;
    if (stat(path, &look) == 0 && S_ISFIFO(look.st_mode)) { /* opening one would wait */
        return cannot_read(context, path, "not a regular file");
    }
    FILE *stream = fopen(path, "rbe");
    if (stream == NULL) {
        return cannot_read(context, path, strerror(errno));
    }
    const gonio_status status = read_stream(context, path, stream, bytes);
    fclose(stream);
    if (status != GONIO_OK) {
        gonio_i_free_bytes(bytes);
    }
    return status;
}

void gonio_i_free_bytes(gonio_i_bytes *bytes)
{
    free(bytes->data);
    *bytes = (gonio_i_bytes){0};
}
