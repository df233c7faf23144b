/* Linear interpolation between bin centres: see grid.h. */
#include "grid.h"

#include <math.h>

typedef struct interval {
    int low, high;
    double fraction; /* weight of high */
} interval;

/* position: in bins, centres at k + 1/2. */
static interval clamped(double position, int bins)
{
    const double p = fmin(fmax(position - 0.5, 0.0), bins - 1.0);
    const int low = (int)p;
    return (interval){low, low + 1 < bins ? low + 1 : low, p - low};
}

static interval periodic(double position, int bins)
{
    const double p = position - 0.5 + bins;
    const int low = (int)floor(p);
    return (interval){low % bins, (low + 1) % bins, p - low};
}

int gonio_i_bilinear(gonio_half_difference c, gonio_i_stencil stencil[GONIO_I_BILINEAR])
{
    const double quarter = M_PI / 2.0;
    const interval h =
        clamped(GONIO_THETA_H_BINS * sqrt(fmax(c.theta_h, 0.0) / quarter), GONIO_THETA_H_BINS);
    const interval d = clamped(GONIO_THETA_D_BINS * c.theta_d / quarter, GONIO_THETA_D_BINS);
    for (int k = 0; k < GONIO_I_BILINEAR; k++) {
        const bool upper_h = (k & 2) != 0;
        const bool upper_d = (k & 1) != 0;
        stencil[k] = (gonio_i_stencil){{upper_h ? h.high : h.low, upper_d ? d.high : d.low, 0},
                                       (upper_h ? h.fraction : 1.0 - h.fraction) *
                                           (upper_d ? d.fraction : 1.0 - d.fraction)};
    }
    return GONIO_I_BILINEAR;
}

/* How much phi_d means: 1 from the first centres of theta_h and theta_d on, 0 where either is 0. */
static double meaning_of_phi_d(gonio_half_difference c)
{
    const gonio_half_difference first = gonio_bin_centre((gonio_bin){0, 0, 0});
    return fmin(fmax(c.theta_h, 0.0) / first.theta_h, 1.0) *
           fmin(fmax(c.theta_d, 0.0) / first.theta_d, 1.0);
}

/* Turns a share of the first 8 points into the mean over phi_d. Returns how many points there are.
 */
static int blend_with_mean(const gonio_i_stencil plane[GONIO_I_BILINEAR], double share,
                           gonio_i_stencil stencil[GONIO_I_MOST_POINTS])
{
    int points = GONIO_I_TRILINEAR;
    for (int k = 0; k < GONIO_I_TRILINEAR; k++) {
        stencil[k].weight *= 1.0 - share;
    }
    for (int k = 0; k < GONIO_I_BILINEAR; k++) {
        for (int sector = 0; sector < GONIO_SECTORS && plane[k].weight > 0.0; sector++) {
            gonio_bin bin = plane[k].bin;
            bin.phi_d = sector * GONIO_SECTOR_BINS + GONIO_SECTOR_BINS / 2;
            stencil[points++] = (gonio_i_stencil){bin, share * plane[k].weight / GONIO_SECTORS};
        }
    }
    return points;
}

int gonio_i_trilinear_runs(gonio_half_difference c, int depth,
                           gonio_i_stencil stencil[GONIO_I_MOST_POINTS])
{
    gonio_i_stencil plane[GONIO_I_BILINEAR];
    gonio_i_bilinear(c, plane);
    const int runs = GONIO_PHI_D_BINS / depth;
    const interval p = periodic(runs * c.phi_d / M_PI, runs);
    const int low = p.low * depth + depth / 2;
    const int high = p.high * depth + depth / 2;
    for (int k = 0; k < GONIO_I_BILINEAR; k++) {
        stencil[2 * k] = (gonio_i_stencil){{plane[k].bin.theta_h, plane[k].bin.theta_d, low},
                                           plane[k].weight * (1.0 - p.fraction)};
        stencil[2 * k + 1] = (gonio_i_stencil){{plane[k].bin.theta_h, plane[k].bin.theta_d, high},
                                               plane[k].weight * p.fraction};
    }
    const double share = 1.0 - meaning_of_phi_d(c);
    return share > 0.0 ? blend_with_mean(plane, share, stencil) : GONIO_I_TRILINEAR;
}

int gonio_i_trilinear(gonio_half_difference c, gonio_i_stencil stencil[GONIO_I_MOST_POINTS])
{
    return gonio_i_trilinear_runs(c, 1, stencil);
}

int gonio_i_trilinear_sectors(gonio_half_difference c, gonio_i_stencil stencil[GONIO_I_MOST_POINTS])
{
    return gonio_i_trilinear_runs(c, GONIO_SECTOR_BINS, stencil);
}
