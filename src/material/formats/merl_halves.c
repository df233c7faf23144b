/* The two halves of phi_d in MERL tables: see merl_halves.h. */
#include "merl_halves.h"

#include <math.h>

/* Whether a number is data. -1, NaN and infinity are not. Slightly negative numbers are noise. */
static bool has_data(double stored)
{
    return stored > -1.0 && stored < INFINITY;
}

static double mean_of(double a, double b)
{
    if (has_data(a) && has_data(b)) {
        return 0.5 * (a + b);
    }
    return has_data(a) ? a : has_data(b) ? b : -1.0;
}

void gonio_i_merl_fold(const double *full, double *half)
{
    for (size_t row = 0; row < GONIO_THETA_D_BINS; row++) {
        const double *from = full + row * GONIO_I_MERL_FULL_CIRCLE;
        for (size_t k = 0; k < GONIO_PHI_D_BINS; k++) {
            half[row * GONIO_PHI_D_BINS + k] = mean_of(from[k], from[k + GONIO_PHI_D_BINS]);
        }
    }
}

void gonio_i_merl_compare_halves(const double *full, double scale, gonio_i_merl_halves *halves)
{
    for (size_t row = 0; row < GONIO_THETA_D_BINS; row++) {
        const double *from = full + row * GONIO_I_MERL_FULL_CIRCLE;
        for (size_t k = 0; k < GONIO_PHI_D_BINS; k++) {
            const double a = from[k];
            const double b = from[k + GONIO_PHI_D_BINS];
            if (has_data(a) && has_data(b)) {
                const double difference = scale * (a - b);
                const double mean = scale * 0.5 * (a + b);
                halves->difference += difference * difference;
                halves->mean += mean * mean;
            }
        }
    }
}

double gonio_i_merl_difference(const gonio_i_merl_halves *halves)
{
    return halves->mean > 0.0 ? sqrt(halves->difference / halves->mean) : 0.0;
}
