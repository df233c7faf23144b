/* The functions of the renderer in a library that is built without it (GONIO_RENDER=OFF). */
#include "image.h"

static gonio_status not_built(gonio_context *context)
{
    return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                        "this gonio was built without the renderer (GONIO_RENDER=OFF)");
}

gonio_status gonio_image_read(gonio_context *context, const char *path, gonio_image **image)
{
    (void)path;
    (void)image;
    return not_built(context);
}

gonio_status gonio_image_write_exr(gonio_context *context, const gonio_image *image,
                                   const char *path)
{
    (void)image;
    (void)path;
    return not_built(context);
}

gonio_status gonio_image_write_png(gonio_context *context, const gonio_image *image,
                                   const gonio_tone *tone, const char *path)
{
    (void)image;
    (void)tone;
    (void)path;
    return not_built(context);
}

gonio_status gonio_mesh_read(gonio_context *context, const char *path, gonio_mesh **mesh)
{
    (void)path;
    (void)mesh;
    return not_built(context);
}

/* Objects of the renderer do not exist in such a library. */
void gonio_mesh_free(gonio_mesh **mesh)
{
    (void)mesh;
}

size_t gonio_mesh_triangles(const gonio_mesh *mesh)
{
    (void)mesh;
    return 0;
}

size_t gonio_mesh_corners(const gonio_mesh *mesh)
{
    (void)mesh;
    return 0;
}

gonio_status gonio_render(gonio_context *context, const gonio_material *material,
                          const gonio_render_options *options, gonio_image **image)
{
    (void)material;
    (void)options;
    (void)image;
    return not_built(context);
}

gonio_status gonio_reference_create(gonio_context *context, const gonio_material *material,
                                    const gonio_render_options *options,
                                    gonio_reference **reference)
{
    (void)material;
    (void)options;
    (void)reference;
    return not_built(context);
}

void gonio_reference_free(gonio_reference **reference)
{
    (void)reference;
}

const gonio_image *gonio_reference_image(const gonio_reference *reference)
{
    (void)reference;
    return NULL;
}

gonio_tone gonio_reference_tone(const gonio_reference *reference)
{
    (void)reference;
    return (gonio_tone){1.0, 1.0, 1.0};
}

gonio_status gonio_reference_render(gonio_context *context, const gonio_reference *reference,
                                    const gonio_material *other, gonio_image **image)
{
    (void)reference;
    (void)other;
    (void)image;
    return not_built(context);
}

gonio_status gonio_reference_compare(gonio_context *context, const gonio_reference *reference,
                                     const gonio_material *other, gonio_image_error *error)
{
    (void)reference;
    (void)other;
    (void)error;
    return not_built(context);
}

gonio_status gonio_comparison_picture_write_png(gonio_context *context,
                                                const gonio_comparison_picture *picture,
                                                const char *path)
{
    (void)picture;
    (void)path;
    return not_built(context);
}
