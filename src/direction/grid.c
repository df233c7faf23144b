/* The grid of 90 x 90 x 180 bins (MERL's). */
#include "grid.h"

#include <math.h>

/* Rounding may move a point that lies on an edge to either side of it. */
static const double edge = 1e-6;

static int clamp_index(double position, int bins)
{
    const double index = floor(position + edge);
    return index < 0.0 ? 0 : index >= bins ? bins - 1 : (int)index;
}

gonio_bin gonio_bin_of(gonio_half_difference c)
{
    const double phi = GONIO_PHI_D_BINS * c.phi_d / M_PI;
    return (gonio_bin){
        clamp_index(GONIO_THETA_H_BINS * sqrt(fmax(c.theta_h, 0.0) / (M_PI / 2.0)),
                    GONIO_THETA_H_BINS),
        clamp_index(GONIO_THETA_D_BINS * c.theta_d / (M_PI / 2.0), GONIO_THETA_D_BINS),
        phi + edge >= GONIO_PHI_D_BINS ? 0 : clamp_index(phi, GONIO_PHI_D_BINS),
    };
}

gonio_half_difference gonio_bin_centre(gonio_bin bin)
{
    const double root = (bin.theta_h + 0.5) / GONIO_THETA_H_BINS;
    return (gonio_half_difference){
        root * root * (M_PI / 2.0),
        (bin.theta_d + 0.5) / GONIO_THETA_D_BINS * (M_PI / 2.0),
        (bin.phi_d + 0.5) / GONIO_PHI_D_BINS * M_PI,
    };
}

bool gonio_i_is_bin(gonio_bin bin)
{
    return bin.theta_h >= 0 && bin.theta_h < GONIO_THETA_H_BINS && bin.theta_d >= 0 &&
           bin.theta_d < GONIO_THETA_D_BINS && bin.phi_d >= 0 && bin.phi_d < GONIO_PHI_D_BINS;
}

bool gonio_bin_is_valid(gonio_bin bin)
{
    if (!gonio_i_is_bin(bin)) {
        return false;
    }
    double incident = 0.0;
    double outgoing = 0.0;
    gonio_cosines(gonio_bin_centre(bin), &incident, &outgoing);
    return incident > 0.0 && outgoing > 0.0;
}

int32_t gonio_bin_index(gonio_bin bin)
{
    return bin.phi_d + GONIO_PHI_D_BINS * (bin.theta_d + GONIO_THETA_D_BINS * bin.theta_h);
}

gonio_bin gonio_bin_from_index(int32_t index)
{
    const int32_t cell = index / GONIO_PHI_D_BINS;
    return (gonio_bin){cell / GONIO_THETA_D_BINS, cell % GONIO_THETA_D_BINS,
                       index % GONIO_PHI_D_BINS};
}

/* cos theta_i and cos theta_o are both positive where |cos phi_d| < 1/(tan theta_h tan theta_d),
 * which is an interval around phi_d = pi/2. */
int gonio_i_first_valid_phi(int theta_h, int theta_d)
{
    const gonio_half_difference c = gonio_bin_centre((gonio_bin){theta_h, theta_d, 0});
    const double limit = cos(c.theta_h) * cos(c.theta_d) / (sin(c.theta_h) * sin(c.theta_d));
    if (limit > 1.0) {
        return 0;
    }
    const double position = acos(limit) / M_PI * GONIO_PHI_D_BINS - 0.5;
    const int first = (int)ceil(position);
    return first < GONIO_PHI_D_BINS / 2 ? first : GONIO_PHI_D_BINS / 2;
}

void gonio_i_slab_cosines(int theta_h, double *cosines)
{
    double cos_phi[GONIO_PHI_D_BINS];
    for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
        cos_phi[p] = cos(gonio_bin_centre((gonio_bin){0, 0, p}).phi_d);
    }
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
        const gonio_half_difference c = gonio_bin_centre((gonio_bin){theta_h, theta_d, 0});
        const double even = cos(c.theta_h) * cos(c.theta_d);
        const double odd = sin(c.theta_h) * sin(c.theta_d);
        for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
            const double swing = odd * cos_phi[p];
            cosines[theta_d * GONIO_PHI_D_BINS + p] = (even - swing) * (even + swing);
        }
    }
}
