/* Directions, the half/difference coordinates and the grid of bins.
 *
 * Frame: the surface's own; normal +z, tangent +x. The incident (light) and the outgoing (view)
 * direction both point away from the surface. theta is measured from the normal, phi from +x
 * towards +y. Radians.
 *
 * Half/difference coordinates (Rusinkiewicz 1998): half vector h = (i + o)/|i + o| =
 * (theta_h, phi_h), difference d = R_y(-theta_h) R_z(-phi_h) i = (theta_d, phi_d). An isotropic
 * material does not depend on phi_h, and by reciprocity phi_d and phi_d + pi are the same sample.
 *
 * The grid is MERL's: 90 x 90 x 180 bins in (theta_h, theta_d, phi_d), phi_d fastest, theta_h
 * spaced by a square root so that bins crowd around the mirror direction. A cell is a (theta_h,
 * theta_d) pair: all the bins that differ in phi_d only.
 *
 * All functions are pure: threads may call them at the same time. */
#ifndef GONIO_DIRECTION_H
#define GONIO_DIRECTION_H

#include <stdbool.h>

#include <gonio/status.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GONIO_THETA_H_BINS = 90,
    GONIO_THETA_D_BINS = 90,
    GONIO_PHI_D_BINS = 180,
    GONIO_CELLS = GONIO_THETA_H_BINS * GONIO_THETA_D_BINS, /* 8,100 */
    GONIO_BINS = GONIO_CELLS * GONIO_PHI_D_BINS,           /* 1,458,000 */
    GONIO_SECTORS = 12,                                    /* of phi_d */
    GONIO_SECTOR_BINS = GONIO_PHI_D_BINS / GONIO_SECTORS,  /* phi_d bins of a sector */
    GONIO_CHANNELS = 3                                     /* R, G, B */
};

typedef struct gonio_angles {
    double theta; /* from the normal, [0, pi/2] above the horizon */
    double phi;   /* azimuth from +x */
} gonio_angles;

typedef struct gonio_pair {
    gonio_angles incident; /* towards the light */
    gonio_angles outgoing; /* towards the viewer */
} gonio_pair;

typedef struct gonio_half_difference {
    double theta_h; /* [0, pi/2] */
    double theta_d; /* [0, pi/2] */
    double phi_d;   /* [0, pi): reciprocity folded */
} gonio_half_difference;

typedef struct gonio_bin {
    int theta_h; /* 0 .. 89 */
    int theta_d; /* 0 .. 89 */
    int phi_d;   /* 0 .. 179 */
} gonio_bin;

/* Half/difference coordinates of a pair. A pair of opposite directions (both on the horizon) has
 * no half vector: it is given theta_h = 0. Where theta_h = 0, phi_h is taken as 0; where
 * theta_d = 0, phi_d is 0. */
GONIO_API gonio_half_difference gonio_half_difference_from_pair(gonio_pair pair);

/* The pair with phi_h = 0: i = R_y(theta_h) d, o = 2 (i.h) h - i. Azimuths in [0, 2 pi). One of the
 * directions may come out below the horizon (theta > pi/2): see gonio_bin_is_valid. */
GONIO_API gonio_pair gonio_pair_from_half_difference(gonio_half_difference coordinates);

/* Cosines of the incident and the outgoing polar angle:
 * cos th cos td -+ sin th sin td cos pd. */
GONIO_API void gonio_cosines(gonio_half_difference coordinates, double *incident, double *outgoing);

/* The bin that holds a point: floor(90 sqrt(theta_h/(pi/2))), floor(90 theta_d/(pi/2)),
 * floor(180 phi_d/pi), clamped to the grid. A point within 1e-6 of a bin's upper edge counts to the
 * next bin, so that rounding does not decide (phi_d = 90 degrees is bin 90). */
GONIO_API gonio_bin gonio_bin_of(gonio_half_difference coordinates);

/* A bin's centre: theta_h = ((i+1/2)/90)^2 pi/2, theta_d = (j+1/2)/90 pi/2,
 * phi_d = (k+1/2)/180 pi. */
GONIO_API gonio_half_difference gonio_bin_centre(gonio_bin bin);

/* Whether both directions at the bin's centre are above the horizon: 1,096,216 bins are. False for
 * a bin outside the grid. */
GONIO_API bool gonio_bin_is_valid(gonio_bin bin);

/* Index of a bin in the grid, phi_d fastest: k + 180 (j + 90 i); and back. This is arithmetic
 * alone: what is outside the grid stays outside. */
GONIO_API int32_t gonio_bin_index(gonio_bin bin);
GONIO_API gonio_bin gonio_bin_from_index(int32_t index);

#ifdef __cplusplus
}
#endif
#endif
