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

void gonio_i_bilinear(gonio_half_difference c, gonio_i_stencil stencil[GONIO_I_BILINEAR])
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
}

/* Between the middles of runs of `depth` bins of phi_d. */
static void trilinear(gonio_half_difference c, int depth,
                      gonio_i_stencil stencil[GONIO_I_TRILINEAR])
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
}

void gonio_i_trilinear(gonio_half_difference c, gonio_i_stencil stencil[GONIO_I_TRILINEAR])
{
    trilinear(c, 1, stencil);
}

void gonio_i_trilinear_sectors(gonio_half_difference c, gonio_i_stencil stencil[GONIO_I_TRILINEAR])
{
    trilinear(c, GONIO_SECTOR_BINS, stencil);
}
