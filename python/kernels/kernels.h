/* Loops of the Python package over arrays: directions as vectors, predictions, pixels, and a
 * material whose table is an array. */
#ifndef GONIO_PYTHON_KERNELS_H
#define GONIO_PYTHON_KERNELS_H

#include <gonio/gonio.h>

/* What is wrong with vectors; an index is that of the first one, or `count` if there is none. */
typedef struct gonio_python_vectors {
    size_t not_finite;
    size_t zero;  /* shorter than 1e-12 */
    size_t below; /* at or below the horizon */
    size_t far;   /* its length differs from 1 the most, by `off` */
    double off;
} gonio_python_vectors;

/* Unit vectors w[count][3], normal +z, to angles: at[count * stride], theta and phi. */
void gonio_python_angles(const double *w, size_t count, int threads, double *at, size_t stride,
                         gonio_python_vectors *found);

/* Angles at[count * stride] to unit vectors w[count][3]. */
void gonio_python_unit_vectors(const double *at, size_t stride, size_t count, int threads,
                               double *w);

/* gonio_reconstruction_predict at each pair: value[count][channels], deviation alike or NULL; NaN
 * where it predicts nothing. */
void gonio_python_predict(const gonio_basis *basis, const gonio_reconstruction *reconstruction,
                          const gonio_pair *pairs, size_t count, size_t channels, int threads,
                          double *value, double *deviation);

/* gonio_mapping_scale at each pair: scale[count][channels]. */
void gonio_python_scales(gonio_mapping mapping, bool colours, const gonio_pair *pairs, size_t count,
                         size_t channels, int threads, double *scale);

/* gonio_table_albedo at each theta: albedo[count][3] and the share of the hemisphere. */
void gonio_python_albedos(const gonio_table *table, const double *theta, size_t count, int threads,
                          double *albedo, double *share);

/* A tone-mapped image as sRGB, on black: srgb[height][width][3]. */
void gonio_python_tone_map(const gonio_image *image, const gonio_tone *tone, int threads,
                           uint8_t *srgb);

/* A material that reads its slabs from rho[90][3][90][180], which must outlive it. NaN or below 0:
 * no data. Errors: those of gonio_material_create. */
gonio_status gonio_python_array_material(gonio_context *context, const char *name,
                                         const double *rho, gonio_material **material);

/* A material that calls back into Python; `self` is a handle of cffi. */
typedef gonio_status (*gonio_python_evaluation)(void *self, gonio_context *context,
                                                const gonio_pair *pairs, size_t count,
                                                double *values);
gonio_status gonio_python_function_material(gonio_context *context, const char *name, void *self,
                                            size_t channels, const double *wavelength,
                                            bool anisotropic, gonio_python_evaluation evaluate,
                                            gonio_material **material);

#endif
