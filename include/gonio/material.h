/* A material: a BRDF at any directions, in any channels: colours, one channel, or wavelengths.
 *
 * Its source (a file, an analytic model, a callback) gives values at any directions, on the grid of
 * direction.h, or both. Each is computed from the other if needed.
 *
 * On the grid a material is read one theta_h index (a slab) at a time, and never held whole.
 * A slab is an array rho[channel][theta_d][phi_d] of 3 x 90 x 180 doubles (GONIO_SLAB_VALUES) in
 * 1/sr, linear R, G, B, of an isotropic and reciprocal surface. A bin with data has three finite
 * values >= 0; a bin without has -1 in all three channels. */
#ifndef GONIO_MATERIAL_H
#define GONIO_MATERIAL_H

#include <stdbool.h>
#include <stddef.h>

#include <gonio/context.h>
#include <gonio/direction.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GONIO_SLAB_BINS = GONIO_THETA_D_BINS * GONIO_PHI_D_BINS, /* 16,200 */
    GONIO_SLAB_VALUES = GONIO_CHANNELS * GONIO_SLAB_BINS     /* 48,600 */
};

typedef struct gonio_material gonio_material;

/* The source of a material's values: read_slab, evaluate or both. They may be called from several
 * threads at once and must give the same values every time. */
typedef struct gonio_material_source {
    size_t size; /* sizeof(gonio_material_source) */
    /* Fills rho (GONIO_SLAB_VALUES) for one theta_h index in 0 .. 89. NULL: made from evaluate, as
     * gonio_material_read_slab says. */
    gonio_status (*read_slab)(void *self, gonio_context *context, int theta_h, double *rho);
    /* Releases self; may be NULL. */
    void (*release)(void *self);
    void *self;
    /* Fills values[count][channels], 1/sr, for directions above the horizon. NaN or a negative
     * number: no data. NULL: interpolated from slabs. */
    gonio_status (*evaluate)(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values);
    size_t channels;          /* of evaluate; 0 for R, G, B */
    const double *wavelength; /* [channels], nm, copied; NULL: 3 channels are R, G, B, 1 is grey */
    bool anisotropic;         /* values depend on phi_h too */
    double theta_limit;       /* polar angle up to which values were measured, radians; 0: all */
    bool both_halves;         /* slabs are means of phi_d and phi_d + pi, which the source holds */
    double halves_difference; /* RMS of their difference over the RMS of the mean */
} gonio_material_source;

/* A description of a material. The view and its pointers belong to the material. */
typedef struct gonio_material_view {
    const char *name;         /* as gonio_material_name */
    const char *format;       /* as gonio_material_format */
    size_t channels;          /* of gonio_material_evaluate */
    const double *wavelength; /* [channels], nm; NULL: R, G, B, or grey */
    bool anisotropic;
    double theta_limit; /* radians; 0 for none */
    bool evaluated;     /* by its source at any directions, not from a table */
    bool both_halves;   /* as in gonio_material_source, as is the next */
    double halves_difference;
} gonio_material_view;

/* Opens a material: a MERL .binary table (phi_d of 180 bins, or 360 folded by reciprocity), a
 * neural BRDF .h5, an RGL .bsdf (RGB or spectral, isotropic or not), the unpolarised part of a
 * KAIST .pbsdf, a UTIA .bin, the reflection of BSDF-XML (Klems matrices, tensor trees), a Zemax
 * BSDF with all its sample rotations, recognised by content, or "atlas:NAME" for a built-in one.
 * The path is copied. Errors: _IO (missing, unreadable, a directory), _FORMAT (not a known format,
 * truncated, oversized, non-finite weights), _ARGUMENT (no such built-in material), _MEMORY. */
GONIO_API gonio_status gonio_material_open(gonio_context *context, const char *path,
                                           gonio_material **material);

/* Makes a material of a source. On success the material owns source.self and releases it when it is
 * freed. On failure the caller still owns it. The strings are copied. Errors:
 * _ARGUMENT (neither read_slab nor evaluate, channels without wavelengths other than 1 and 3, a
 * source that was not initialised), _MEMORY. */
GONIO_API gonio_status gonio_material_create(gonio_context *context, const char *name,
                                             const char *format,
                                             const gonio_material_source *source,
                                             gonio_material **material);

GONIO_API void gonio_material_free(gonio_material **material);

/* The name: of a file, its base name without the extension; of a built-in, the part after ':'. */
GONIO_API const char *gonio_material_name(const gonio_material *material);

/* The origin in words: "MERL table 90 x 90 x 180", "neural BRDF 6-21-21-3". */
GONIO_API const char *gonio_material_format(const gonio_material *material);

GONIO_API const gonio_material_view *gonio_material_describe(const gonio_material *material);

/* The BRDF at any pairs of directions: values[count][channels] in 1/sr, channels as
 * gonio_material_describe says. NaN where there are no data: below the horizon, beyond theta_limit,
 * in a hole, or in a channel that is negative there. From the source itself if it can evaluate;
 * otherwise from its table by trilinear interpolation, as gonio_table_value. Thread-safe; uses the
 * context's threads. Errors: _MEMORY, and those of the source. */
GONIO_API gonio_status gonio_material_evaluate(gonio_context *context,
                                               const gonio_material *material,
                                               const gonio_pair *pairs, size_t count,
                                               double *values);

/* The light under which the colours of a spectrum are computed: equal energy, CIE D65, CIE A. */
typedef enum gonio_illuminant {
    GONIO_ILLUMINANT_E,
    GONIO_ILLUMINANT_D65,
    GONIO_ILLUMINANT_A
} gonio_illuminant;

/* Sets the light under which the colours of a material's spectra are computed from now on: in
 * slabs, tables, renderings and files of colours. The default is equal energy. No other thread may
 * use the material meanwhile. Errors: _MEMORY. */
GONIO_API gonio_status gonio_material_set_illuminant(gonio_context *context,
                                                     gonio_material *material,
                                                     gonio_illuminant illuminant);

/* Reads one slab into rho (GONIO_SLAB_VALUES doubles, the caller's). Thread-safe. A source
 * without read_slab is evaluated at the centres of the bins: the mean of both sides of the
 * reciprocal pair and, if it is anisotropic, of azimuths of the half vector: 16, or 32 where a
 * narrow lobe needs them. Spectra become linear sRGB under the illuminant, in which a flat spectrum
 * is white. One channel becomes grey. A channel without data is 0 if others have data. There are no
 * data beyond theta_limit. Errors: _ARGUMENT (theta_h outside 0 .. 89), and those of the source
 * (_IO, _FORMAT). */
GONIO_API gonio_status gonio_material_read_slab(gonio_context *context,
                                                const gonio_material *material, int theta_h,
                                                double *rho);

/* A 64-bit fingerprint of a material's values: XXH3 over the slabs in order, as little-endian
 * doubles in 1/sr. Copies of a MERL table have the same fingerprint; a neural BRDF and the table
 * made from it may differ in a last digit, and so in this. Feed all 90 slabs in order. Errors of
 * making one, which have no message: _MEMORY. */
typedef struct gonio_fingerprint gonio_fingerprint;
GONIO_API gonio_status gonio_fingerprint_create(gonio_fingerprint **fingerprint);
GONIO_API void gonio_fingerprint_add(gonio_fingerprint *fingerprint, const void *data, size_t size);
GONIO_API uint64_t gonio_fingerprint_value(const gonio_fingerprint *fingerprint);
GONIO_API void gonio_fingerprint_free(gonio_fingerprint **fingerprint);

/* Writes a material as a MERL .binary table: int32 90, 90, 180, then three planes (R, G, B) of
 * float64 rho / ((1, 1.15, 1.66)/1500), -1 for no data. The file appears whole or not at all.
 * Errors: _IO, _CANCELLED, and those of the source. */
GONIO_API gonio_status gonio_material_write_merl(gonio_context *context,
                                                 const gonio_material *material, const char *path);

/* Writes a material as an RGL .bsdf, which Mitsuba 3 and pbrt-v4 render as `measured`: RGB, or
 * spectra where the material has wavelengths (ascending, at most 512). An isotropic one is
 * evaluated at 26 incidences and 84 x 84 places, 32 x 32 or more for spectra; an anisotropic one at
 * 21 incidences, 13 azimuths of these over half a turn (25 over a whole one, unless half a turn of
 * the sample changes nothing) and up to 48 x 48 places. Where the material has no data, the nearest
 * places with data are used. A material that was read from an RGL .bsdf, anisotropic or not, is
 * written unchanged. The file appears whole or not at all.
 * Errors: _ARGUMENT (too many wavelengths), _IO, _MEMORY, _CANCELLED, and those of the source. */
GONIO_API gonio_status gonio_material_write_rgl(gonio_context *context,
                                                const gonio_material *material, const char *path);

/* How a material is written. */
typedef struct gonio_write_options {
    size_t size;        /* of this struct, which gonio_write_options_default sets */
    const char *format; /* by name; NULL: that of the path's extension, or a MERL table if gonio
                         * does not know it */
    double
        theta_i_step; /* steps of directions on a grid (csv; zemax except for theta_o), radians; */
    double theta_o_step; /* 0: the default of the format */
    double phi_step;
    bool average_azimuths; /* write the mean over azimuths of an anisotropic material, in formats
                            * that hold isotropic ones too */
} gonio_write_options;

/* All fields are 0 except the size. */
GONIO_API void gonio_write_options_default_of(gonio_write_options *options, size_t size);
static inline void gonio_write_options_default(gonio_write_options *options)
{
    gonio_write_options_default_of(options, sizeof *options);
}

/* Writes a material in a format; options may be NULL. docs/formats.md says what each keeps. The
 * file appears whole or not at all. Errors: _ARGUMENT (no such format; what the format cannot
 * hold, as a MERL table an anisotropic material, unless its mean is asked for), _IO, _MEMORY,
 * _CANCELLED, those of the source. */
GONIO_API gonio_status gonio_material_write(gonio_context *context, const gonio_material *material,
                                            const char *path, const gonio_write_options *options);

/* Names of the formats, extensions of their files (with a dot) and one-line descriptions; NULL past
 * the last. */
GONIO_API const char *gonio_material_writer_name(int index);
GONIO_API const char *gonio_material_writer_extension(int index);
GONIO_API const char *gonio_material_writer_summary(int index);

/* Whether a format is written as the mean over azimuths if gonio_write_options.average_azimuths
 * asks for it; the others keep azimuths. */
GONIO_API bool gonio_material_writer_averages(int index);

/* The index of the format that a file is written in, as of gonio_write_options.format; -1 for an
 * unknown name. */
GONIO_API int gonio_material_writer_find(const char *path, const char *format);

/* ---- anisotropic tables ---- */

/* Most orders of phi_h in an anisotropic table. */
enum { GONIO_ANISOTROPIC_ORDERS = 32 };

/* A reciprocal BRDF that depends on phi_h, on the grid of direction.h. At the centre of each cell
 * (theta_h, theta_d, phi_d) and in each channel it is a Fourier series of phi_h in log space, with
 * the symmetry s and N orders:
 *
 *     ln(rho + floor) = c[0] + sum over k = 1 .. N of c[2k-1] cos(k s phi_h) + c[2k] sin(k s phi_h)
 *
 * phi_h is the azimuth of the half vector (direction.h). Elongated Gaussian lobes need one order.
 * A cell of R, G, B takes 12 + 24 N bytes: 12 cells of phi_d and 2 orders 6 MB, 36 cells and 12
 * orders 87 MB. A table may have 1 GiB. */
typedef struct gonio_anisotropic_table {
    size_t size; /* sizeof(gonio_anisotropic_table) */
    size_t channels;
    const double *wavelength; /* [channels], nm; NULL: 3 channels are R, G, B, 1 is grey */
    int phi_d_cells;          /* of each theta_h and theta_d: a divisor of 180, evenly spaced over
                               * 0 .. pi; 12 are the sectors, 180 the bins */
    int symmetry;        /* 1: none; 2: half a turn of the sample changes nothing; 4: a quarter */
    int orders;          /* N: 0 .. GONIO_ANISOTROPIC_ORDERS; 0 is isotropic */
    const double *floor; /* [channels], 1/sr, 0 or more */
    /* [90 theta_h][90 theta_d][phi_d_cells][channels][1 + 2 orders]; NaN as the first of a series:
     * no data. */
    const float *coefficient;
    double theta_limit; /* polar angle up to which values were measured, radians; 0: all */
} gonio_anisotropic_table;

/* Makes a material of an anisotropic table, whose arrays are copied. It is evaluated at any
 * directions: rho is trilinear between the centres of cells, continuous at the poles of the
 * coordinates too, and the same with both directions exchanged. Values below 0 are 0. Errors:
 * _ARGUMENT (sizes, floors, wavelengths), _MEMORY. */
GONIO_API gonio_status gonio_anisotropic_material(gonio_context *context, const char *name,
                                                  const char *format,
                                                  const gonio_anisotropic_table *table,
                                                  gonio_material **material);

/* ---- tables ---- */

/* A material read whole (35 MB), for look-ups in any order. Errors of loading: _CANCELLED, _MEMORY,
 * and those of the source. */
typedef struct gonio_table gonio_table;

GONIO_API gonio_status gonio_table_load(gonio_context *context, const gonio_material *material,
                                        gonio_table **table);
GONIO_API void gonio_table_free(gonio_table **table);

/* All values, rho[theta_h][channel][theta_d][phi_d] (90 slabs); they belong to the table. */
GONIO_API const double *gonio_table_values(const gonio_table *table);

/* The BRDF at any directions, trilinear between bin centres in (sqrt theta_h, theta_d, phi_d),
 * phi_d periodic, bins without data left out and the weights of the others scaled up. Within the
 * first bin of theta_h or theta_d it fades into the mean over phi_d, because phi_d has no meaning
 * at 0. Returns false, and rho = 0, if either direction is at or below the horizon or none of the
 * bins around has data. */
GONIO_API bool gonio_table_value(const gonio_table *table, gonio_half_difference coordinates,
                                 double rho[GONIO_CHANNELS]);

/* The directional-hemispherical reflectance (albedo) for light from theta_i, by the midpoint rule
 * on a grid of outgoing directions around the mirror direction. Directions without data count as 0;
 * NaN if none has data. Returns the share of the hemisphere, weighted by the cosine, in which there
 * are data: where it is below 1 the albedo is a lower bound. */
GONIO_API double gonio_table_albedo(const gonio_table *table, double theta_i,
                                    double albedo[GONIO_CHANNELS]);

#ifdef __cplusplus
}
#endif
#endif
