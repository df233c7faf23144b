/* Inside the grid: which bins are valid, and linear interpolation between bin centres. */
#ifndef GONIO_GRID_H
#define GONIO_GRID_H

#include <math.h>

#include <gonio/direction.h>

/* The valid bins of a cell are those with first <= phi_d < 180 - first; 90 if there are none. */
int gonio_i_first_valid_phi(int theta_h, int theta_d);

/* Whether all indices are those of a bin. */
bool gonio_i_is_bin(gonio_bin bin);

/* cos theta_i cos theta_o = (cos th cos td)^2 - (sin th sin td cos pd)^2 at the centres of a slab's
 * bins: cosines[theta_d][phi_d]. */
void gonio_i_slab_cosines(int theta_h, double *cosines);

/* Linear interpolation between two neighbouring bins. */
typedef struct gonio_i_between {
    int low;
    double share; /* of the next one */
} gonio_i_between;

/* At a distance in bins from the centre of the first; constant beyond the ends. */
static inline gonio_i_between gonio_i_between_bins(double at, int bins)
{
    const double inside = fmin(fmax(at, 0.0), bins - 1.0);
    const int low = (int)fmin(inside, bins - 2.0);
    return (gonio_i_between){low, inside - low};
}

enum {
    GONIO_I_BILINEAR = 4,
    GONIO_I_TRILINEAR = 8,
    GONIO_I_MOST_POINTS = GONIO_I_TRILINEAR + GONIO_I_BILINEAR * GONIO_SECTORS
};

typedef struct gonio_i_stencil {
    gonio_bin bin;
    double weight; /* >= 0; the weights add up to 1 */
} gonio_i_stencil;

/* The bins around a point, linear in sqrt(theta_h), theta_d and (trilinear) phi_d, which is
 * periodic with period pi; constant beyond the first and the last centre. Bilinear: phi_d = 0 in
 * every bin. Each returns how many there are.
 *
 * Where theta_h or theta_d is 0 there is no phi_d. From the first centre of either on towards 0
 * what is trilinear becomes the mean over 12 phi_d, so that rounding of phi_d does not matter. The
 * first 8 points are the usual ones; the others have the same theta_h and theta_d. */
int gonio_i_bilinear(gonio_half_difference coordinates, gonio_i_stencil stencil[GONIO_I_BILINEAR]);
int gonio_i_trilinear(gonio_half_difference coordinates,
                      gonio_i_stencil stencil[GONIO_I_MOST_POINTS]);

/* The same between the middles of runs of `depth` bins of phi_d, a divisor of 180. A run is
 * represented by its bin depth/2. */
int gonio_i_trilinear_runs(gonio_half_difference coordinates, int depth,
                           gonio_i_stencil stencil[GONIO_I_MOST_POINTS]);

/* The same between the centres of sectors of phi_d. A sector is represented by its middle bin. */
int gonio_i_trilinear_sectors(gonio_half_difference coordinates,
                              gonio_i_stencil stencil[GONIO_I_MOST_POINTS]);

#endif
