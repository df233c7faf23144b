/* The atlas: built-in analytic materials of the classes that measured databases cover (metals,
 * metallic paints, plastics, phenolics, paints, fabrics, woods, rubbers, stones), so that
 * everything runs with nothing downloaded. All are isotropic, reciprocal, and reflect at most what
 * they receive at every incidence. They open as materials under the name "atlas:NAME" (material.h).
 *
 * Beside them stand anisotropic materials (brushed metals, weaves, grained woods, laminates), which
 * open under such names too. They have indices of their own, and are in no basis that gonio learns
 * by itself.
 *
 * And there are random isotropic materials, of the same model with parameters drawn at random, from
 * which a basis is learned too (gonio_recipe). They open as "atlas:random-0000" and so on. */
#ifndef GONIO_ATLAS_H
#define GONIO_ATLAS_H

#include <gonio/direction.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How many named materials there are (at least 100), numbered from 0. */
GONIO_API int gonio_atlas_count(void);

/* Random material k, k = 0 .. GONIO_ATLAS_RANDOM_COUNT - 1, has the index GONIO_ATLAS_RANDOM + k,
 * the class "random", and no name, but gonio_atlas_find finds it by "random-0000" ... */
enum { GONIO_ATLAS_RANDOM = 10000, GONIO_ATLAS_RANDOM_COUNT = 10000 };

/* A material's name ("gold-polished") and class ("metal"); NULL for an index out of range.
 * Names are lower-case words joined by hyphens and unique. */
GONIO_API const char *gonio_atlas_name(int index);
GONIO_API const char *gonio_atlas_class(int index);

/* The index of a name, or -1. */
GONIO_API int gonio_atlas_find(const char *name);

/* The BRDF, 1/sr, R G B, at half/difference coordinates; 0 where a direction is at or below the
 * horizon or the index is out of range. */
GONIO_API void gonio_atlas_value(int index, gonio_half_difference coordinates,
                                 double rho[GONIO_CHANNELS]);

/* The values at the centres of all bins with one theta_h index: rho[channel][theta_d][phi_d]
 * (3 x 90 x 180), -1 where the bin is not valid. Safe to call from several threads. */
GONIO_API void gonio_atlas_slab(int index, int theta_h, double *rho);

/* How many anisotropic materials there are (at least 16), numbered from 0. */
GONIO_API int gonio_atlas_anisotropic_count(void);

/* An anisotropic material's name ("steel-hairline"), which no isotropic one has, and its class
 * ("brushed metal"); NULL for an index out of range. */
GONIO_API const char *gonio_atlas_anisotropic_name(int index);
GONIO_API const char *gonio_atlas_anisotropic_class(int index);

/* How many rotations of the sample in a full turn change nothing: 1, 2 (half a turn) or 4 (a
 * quarter); 0 for an index out of range. */
GONIO_API int gonio_atlas_anisotropic_symmetry(int index);

/* The index of an anisotropic material's name, or -1. */
GONIO_API int gonio_atlas_anisotropic_find(const char *name);

/* Its BRDF, 1/sr, R G B, at a pair of directions; 0 where one is at or below the horizon or the
 * index is out of range. */
GONIO_API void gonio_atlas_anisotropic_value(int index, gonio_pair pair,
                                             double rho[GONIO_CHANNELS]);

#ifdef __cplusplus
}
#endif
#endif
