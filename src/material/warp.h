/* Warps of the unit square: the map that makes a density uniform, and back.
 *
 * A density is given at the nodes of a grid of height x width (rows along y, columns along x) that
 * spans the square, bilinear between them, for several slices: one for each incidence. With P the
 * density of a point u = (x, y), the warp maps u to
 *
 *     s = (integral of P along its row up to x / integral of the whole row,
 *          integral of the rows' integrals up to y / integral of all rows),
 *
 * s is uniform if u is distributed with the density P. Densities and integrals are interpolated
 * linearly between slices (Dupuy and Jakob 2018, section 4). */
#ifndef GONIO_WARP_H
#define GONIO_WARP_H

#include <stddef.h>

#include <gonio/context.h>

typedef struct gonio_i_warp {
    size_t width;
    size_t height;
    size_t slices;
    double *density; /* [slices][height][width], each slice scaled so that it integrates to 1 */
    double *row;     /* [slices][height][width]: integral along a row up to each node */
    double *column;  /* [slices][height]: integral of the rows' integrals up to each row */
} gonio_i_warp;

enum { GONIO_I_BLEND = 4 };

/* Slices and their weights, which add up to 1. */
typedef struct gonio_i_blend {
    int count;
    size_t slice[GONIO_I_BLEND];
    double weight[GONIO_I_BLEND];
} gonio_i_blend;

/* Makes a warp of values[slices][height][width] >= 0, width and height at least 2. Slices that are
 * 0 everywhere become uniform. Negative and non-finite values count as 0. To be freed in any case.
 * Errors: _MEMORY. */
gonio_status gonio_i_warp_create(gonio_context *context, const float *values, size_t slices,
                                 size_t height, size_t width, gonio_i_warp *warp);
void gonio_i_warp_free(gonio_i_warp *warp);

/* Maps a point u of the square to s; also gives the density at u. */
double gonio_i_warp_invert(const gonio_i_warp *warp, const gonio_i_blend *blend, const double u[2],
                           double s[2]);

/* The inverse: maps s to u; also gives the density at u. */
double gonio_i_warp_sample(const gonio_i_warp *warp, const gonio_i_blend *blend, const double s[2],
                           double u[2]);

/* A position on an axis of nodes: the node before it, and the fraction of the way to the next. */
typedef struct gonio_i_step {
    size_t before; /* at most count - 2, or 0 if there is one node */
    double share;  /* 0 .. 1 */
} gonio_i_step;

/* The position of `at` among ascending nodes, clamped to the first and last. */
gonio_i_step gonio_i_step_among(const double *node, size_t count, double at);

/* The position of `at` in 0 .. 1 among evenly spaced nodes. */
gonio_i_step gonio_i_step_evenly(size_t count, double at);

#endif
