/* Rendering: a material on a sphere or a mesh under a lamp or an environment; tone mapping;
 * differences of renderings.
 *
 * Frame of a scene: x to the right, y up, z towards the viewer. The object is centred and scaled to
 * a bounding sphere of radius 1. Only direct light of the lamp or the environment is computed. A
 * mesh casts shadows on itself, but its parts do not light each other.
 *
 * Images are linear R, G, B with the primaries of BT.709 and white D65, as materials are.
 *
 * A library that is built without the renderer (GONIO_RENDER=OFF) has these functions too. Reading
 * and writing images, reading meshes and rendering then fail with GONIO_ERROR_ARGUMENT. */
#ifndef GONIO_RENDER_H
#define GONIO_RENDER_H

#include <gonio/evaluate.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- images ---- */

enum { GONIO_IMAGE_CHANNELS = 4, GONIO_MOST_PIXELS = 65536 /* either way */ };

/* rgba[height][width][4], top row first. A is the opacity: the share of the pixel that is covered.
 * R, G, B are multiplied by A. */
typedef struct gonio_image {
    int width, height;
    float *rgba;
} gonio_image;

/* Makes a transparent image. Errors: _ARGUMENT for a side below 1 or above GONIO_MOST_PIXELS;
 * _MEMORY. */
GONIO_API gonio_status gonio_image_create(gonio_context *context, int width, int height,
                                          gonio_image **image);
GONIO_API void gonio_image_free(gonio_image **image);

/* Reads an OpenEXR (channels R, G, B and if there A, or Y; scan lines or tiles) or a Radiance .hdr
 * image, recognised by content. Without A the image is opaque. Errors: _IO; _FORMAT for other
 * files, damage and kinds of OpenEXR that cannot be read (deep data); _MEMORY. */
GONIO_API gonio_status gonio_image_read(gonio_context *context, const char *path,
                                        gonio_image **image);

/* Writes float32 R, G, B, A as OpenEXR. The file appears whole or not at all. Errors: _IO, _MEMORY.
 */
GONIO_API gonio_status gonio_image_write_exr(gonio_context *context, const gonio_image *image,
                                             const char *path);

/* ---- tone mapping ---- */

/* The global operator of Reinhard, Stark, Shirley and Ferwerda, "Photographic Tone Reproduction for
 * Digital Images" (2002), eqs. (1), (2) and (4): with Lw a pixel's luminance, L = key Lw / average,
 * Ld = L (1 + L / white^2)/(1 + L), and R, G, B scaled by Ld / Lw, clipped at 1. */
typedef struct gonio_tone {
    double key; /* a, the luminance of the average after mapping: 0.18 */
    double
        average;  /* exp(mean ln(1e-5 + Lw)), over pixels that are neither transparent nor black */
    double white; /* the least L that becomes white: that of the brightest pixel */
} gonio_tone;

/* Measures an image. A black image has average and white 1. */
GONIO_API gonio_tone gonio_tone_measure(const gonio_image *image, double key);

/* Maps one linear colour, not multiplied by A, to 0 .. 1 of a display, not encoded. */
GONIO_API void gonio_tone_apply(const gonio_tone *tone, const double rgb[3], double shown[3]);

/* The transfer function of sRGB (IEC 61966-2-1): encodes a linear value in 0 .. 1. */
GONIO_API double gonio_srgb_encode(double linear);

/* Writes an image as PNG: tone-mapped, on black, 8-bit sRGB. The file appears whole or not at
 * all. Errors: _IO, _MEMORY. */
GONIO_API gonio_status gonio_image_write_png(gonio_context *context, const gonio_image *image,
                                             const gonio_tone *tone, const char *path);

/* ---- differences of renderings ---- */

/* The display whose white is R = G = B = 1: HDR reference white, Report ITU-R BT.2408. */
#define GONIO_DISPLAY_WHITE 203.0 /* cd/m^2 */

/* Delta E_ITP (Recommendation ITU-R BT.2124) of two linear display colours, 0 .. 1 of
 * GONIO_DISPLAY_WHITE: 720 sqrt(dI^2 + dT^2 + dP^2), I = I, T = Ct/2, P = Cp of ICtCp with PQ
 * (BT.2100), from BT.709 by way of BT.2020. A difference of 1 is just visible. */
GONIO_API double gonio_delta_e_itp(const double a[3], const double b[3]);

typedef struct gonio_image_error {
    double psnr;        /* dB: 10 log10(1/mean squared difference) of encoded R, G, B in 0 .. 1;
                         * infinite for equal images */
    double delta_e_itp; /* mean over the same pixels */
} gonio_image_error;

/* Compares renderings as they are displayed: both with the tone mapping of the reference, on black.
 * Pixels that are transparent in both do not count. `map`, if not NULL, is filled with Delta E_ITP
 * of each pixel [height][width], 0 where both are transparent. Errors: _MISMATCH for images of
 * different sizes; _DATA if both are transparent everywhere. */
GONIO_API gonio_status gonio_image_compare(gonio_context *context, const gonio_image *reference,
                                           const gonio_image *other, const gonio_tone *tone,
                                           gonio_image_error *error, float *map);

/* ---- scenes ---- */

typedef struct gonio_mesh gonio_mesh;

/* Reads triangles and polygons of an OBJ or PLY file (recognised by content; text or binary), and
 * moves and scales them to the unit sphere. Missing normals are made from the faces, with a note.
 * Triangles without area are left out, with a warning. Errors: _IO; _FORMAT for other
 * and damaged files; _DATA for a mesh without faces, without extent, or with coordinates that are
 * not finite; _MEMORY. */
GONIO_API gonio_status gonio_mesh_read(gonio_context *context, const char *path, gonio_mesh **mesh);
GONIO_API void gonio_mesh_free(gonio_mesh **mesh);

/* The numbers of triangles and corners. Corners are shared if the file has normals. */
GONIO_API size_t gonio_mesh_triangles(const gonio_mesh *mesh);
GONIO_API size_t gonio_mesh_corners(const gonio_mesh *mesh);

/* Light from all directions: an image in longitude and latitude. Its top row is up (+y). Its centre
 * is behind the object for the viewer (-z). Left to right is as the viewer turns to the right.
 * Radiance is constant within a pixel. */
typedef struct gonio_environment gonio_environment;

/* Names and one-line descriptions of the built-in environments; NULL past the last. */
GONIO_API const char *gonio_environment_name(int index);
GONIO_API const char *gonio_environment_summary(int index);

/* Opens a built-in environment by name, or an image file. With `repair`, negative, NaN and infinite
 * pixels count as black, with a warning. Errors: those of gonio_image_read; _DATA for such pixels
 * without `repair` (the message names the first) and for a black environment. */
GONIO_API gonio_status gonio_environment_open(gonio_context *context, const char *path, bool repair,
                                              gonio_environment **environment);
GONIO_API void gonio_environment_free(gonio_environment **environment);

typedef enum gonio_lamp {
    GONIO_LAMP_DIRECTIONAL, /* very far away */
    GONIO_LAMP_POINT
} gonio_lamp;

typedef struct gonio_render_options {
    size_t size;            /* of this struct, which gonio_render_options_default sets */
    int width, height;      /* pixels */
    int samples;            /* a pixel */
    uint64_t seed;          /* of the samples */
    const gonio_mesh *mesh; /* NULL for the unit sphere */
    /* The light; NULL for the lamp. It is rotated about the vertical axis by environment_turn,
     * radians (its centre moves to the right for the viewer). */
    const gonio_environment *environment;
    double environment_turn;
    bool show_environment; /* show it behind the object; the image is then opaque */
    gonio_lamp lamp;
    double lamp_position[3]; /* its position, or the direction to a directional lamp. The irradiance
                              * at the origin, facing the lamp, is pi: a white Lambertian surface
                              * there has radiance 1. */
    double azimuth, elevation; /* of the viewer about the object, radians; 0, 0 is on +z */
    double field_of_view;      /* vertical, radians, 0 .. 2; 0 for parallel rays. The viewer is so
                                * far away that the unit sphere fills 0.95 of the shorter side. */
    /* Of anisotropic materials: the azimuth 0 of the sample is horizontal on the surface, to the
     * right of who looks at it, turned about the normal by this angle, radians. On a sphere it
     * follows the circles of latitude, as if turned on a lathe. */
    double grain;
    bool flat; /* a flat square sample that faces +z, within the unit sphere, in place of the
                * sphere; a mesh comes before it */
} gonio_render_options;

/* 512 x 512, 64 samples from seed 0, a sphere, no environment, a directional lamp up to the left in
 * front, seen from the front at 30 degrees. */
GONIO_API void gonio_render_options_default_of(gonio_render_options *options, size_t size);
static inline void gonio_render_options_default(gonio_render_options *options)
{
    gonio_render_options_default_of(options, sizeof *options);
}

/* Renders a material. The BRDF is trilinear between bin centres, as in gonio_table_value, or that
 * of gonio_material_evaluate if the material can be evaluated. Where no
 * bin around has data, it is that of the nearest bin with data along theta_d, then theta_h, then
 * phi_d. The environment is sampled by its radiance, the BRDF by its highlight and the cosine; both
 * are combined by the balance heuristic (Veach and Guibas 1995). The error falls as
 * 1/sqrt(samples). The same seed gives the same image on any number of threads. options may be
 * NULL. *image is the caller's; it needs neither the material nor what options points to. Memory:
 * 60 MB, and 16 bytes a pixel. Errors: _ARGUMENT (sizes, samples < 1, an impossible view or lamp);
 * _DATA for a material without data; _MEMORY; _CANCELLED; those of the material. */
GONIO_API gonio_status gonio_render(gonio_context *context, const gonio_material *material,
                                    const gonio_render_options *options, gonio_image **image);

/* ---- comparison pictures ---- */

/* A rendered material that others are compared with. The others are sampled in the same directions
 * as the reference. So they share its noise, which then hardly affects the differences. */
typedef struct gonio_reference gonio_reference;

/* Renders a reference. options NULL is the setting of `gonio compare --render`: 256 x 256 pixels,
 * 64 samples, a sphere in the built-in studio. What options points to must outlive the reference.
 * Errors: those of gonio_render. */
GONIO_API gonio_status gonio_reference_create(gonio_context *context,
                                              const gonio_material *material,
                                              const gonio_render_options *options,
                                              gonio_reference **reference);
GONIO_API void gonio_reference_free(gonio_reference **reference);

/* The reference's rendering, which belongs to it, and its tone mapping with key 0.18. */
GONIO_API const gonio_image *gonio_reference_image(const gonio_reference *reference);
GONIO_API gonio_tone gonio_reference_tone(const gonio_reference *reference);

/* Renders another material in the same way. Errors: those of gonio_render. */
GONIO_API gonio_status gonio_reference_render(gonio_context *context,
                                              const gonio_reference *reference,
                                              const gonio_material *other, gonio_image **image);

/* Renders another material and compares it with the reference. Errors: those of gonio_render. */
GONIO_API gonio_status gonio_reference_compare(gonio_context *context,
                                               const gonio_reference *reference,
                                               const gonio_material *other,
                                               gonio_image_error *error);

/* One rendering of a comparison picture. */
typedef struct gonio_picture_cell {
    const gonio_image *image; /* NULL for an empty place */
    double e6;                /* per cent; NaN for none */
} gonio_picture_cell;

/* Renderings of one size in rows (materials) and columns (methods). The first column is the
 * reference. The others have its tone mapping and are compared with it. E6, PSNR and Delta E_ITP
 * are below each of them. */
typedef struct gonio_comparison_picture {
    size_t size; /* sizeof(gonio_comparison_picture) */
    size_t rows, columns;
    const char *const *row_names;    /* [rows]; UTF-8 */
    const char *const *column_names; /* [columns] */
    const gonio_picture_cell *cells; /* [rows][columns] */
    double key;                      /* of the tone mapping */
    bool differences;                /* also draw Delta E_ITP below each row */
    double largest_difference;       /* Delta E_ITP of the brightest colour in it; 20 if 0 */
} gonio_comparison_picture;

/* Draws a comparison picture as PNG. The file appears whole or not at all. Errors: _ARGUMENT for a
 * picture without cells, or too large; _MISMATCH for images of other sizes; those of
 * gonio_image_compare; _IO. */
GONIO_API gonio_status gonio_comparison_picture_write_png(gonio_context *context,
                                                          const gonio_comparison_picture *picture,
                                                          const char *path);

#ifdef __cplusplus
}
#endif
#endif
