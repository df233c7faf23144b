/* Sums over bins and the errors that are ratios of them: see metrics.h. */
#include "metrics.h"

void gonio_i_error_add(gonio_i_error_sums *total, const gonio_i_error_sums *part)
{
    total->log_difference += part->log_difference;
    total->log_reference += part->log_reference;
    total->cube_difference += part->cube_difference;
    total->cube_reference += part->cube_reference;
    total->ratio += part->ratio;
}

gonio_error gonio_i_error_of(const gonio_i_error_sums *sums, double values)
{
    return (gonio_error){
        .e6 = 100.0 * sqrt(sums->log_difference / sums->log_reference),
        .cube_root = 100.0 * sqrt(sums->cube_difference / sums->cube_reference),
        .log_relative = sqrt(sums->ratio / values),
    };
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
