/* The bivariate average of one slab: see slab_mean.h.
 *
 * A mean of logarithms is the logarithm of a product. So the 180 values of a cell take 8 logarithms
 * instead of 180: each of 8 lanes multiplies up to 23 factors 1 + rho/s. Factors below 1e13 do not
 * overflow a lane. A cell with a larger factor, which no real material has, is summed one by one.
 */
#include "slab_mean.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "../core/core.h"
#include "../core/vector_math.h"

enum { LANES = 8, LANE_ROWS = GONIO_THETA_D_BINS * GONIO_CHANNELS };

/* Eight lanes as one vector (an extension of gcc and clang), so that they stay in registers. */
typedef double lane_vector __attribute__((vector_size(LANES * sizeof(double))));
typedef int64_t lane_mask __attribute__((vector_size(LANES * sizeof(int64_t))));

/* Multiplies 1 + rho/s of the bins first .. last - 1 into the lanes; a bin without data, which
 * holds -1, counts as 0. Returns whether no lane overflowed. */
GONIO_I_VECTORISED static bool multiply(const double *rho, int first, int last,
                                        double inverse_scale, double lanes[LANES])
{
    const lane_vector zero = {0.0};
    const lane_vector one = zero + 1.0;
    lane_vector product = one;
    for (int p = first; p < last; p += LANES) {
        lane_vector x = zero;
        memcpy(&x, rho + p, p + LANES <= last ? sizeof x : (size_t)(last - p) * sizeof(double));
        x = (lane_vector)((lane_mask)x & (lane_mask)(x > zero));
        product *= one + x * inverse_scale;
    }
    memcpy(lanes, &product, sizeof product);
    bool finite = true;
    for (int l = 0; l < LANES; l++) {
        finite = finite && lanes[l] <= DBL_MAX;
    }
    return finite;
}

GONIO_I_VECTORISED static int count_data(const double *rho, int first, int last)
{
    int count = 0;
    for (int p = first; p < last; p++) {
        count += rho[p] >= 0.0;
    }
    return count;
}

/* The sum of single logarithms, for factors that might overflow a product. */
static double sum_logs(const double *rho, int first, int last, double inverse_scale)
{
    double sum = 0.0;
    for (int p = first; p < last; p++) {
        sum += log1p(fmax(rho[p], 0.0) * inverse_scale);
    }
    return sum;
}

void gonio_i_slab_mean(const uint8_t *first_phi, const double *rho,
                       const double inverse_scale[GONIO_CHANNELS], double *mean)
{
    double lanes[LANE_ROWS][LANES];
    double rest[LANE_ROWS] = {0}; /* sums of single logarithms */
    int count[GONIO_THETA_D_BINS];
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
        const int first = first_phi[theta_d];
        const int last = GONIO_PHI_D_BINS - first;
        const double *row = rho + (size_t)theta_d * GONIO_PHI_D_BINS;
        count[theta_d] = count_data(row, first, last);
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            const double *values = row + (size_t)channel * GONIO_SLAB_BINS;
            const int k = theta_d * GONIO_CHANNELS + channel;
            if (!multiply(values, first, last, inverse_scale[channel], lanes[k])) {
                rest[k] = sum_logs(values, first, last, inverse_scale[channel]);
                for (int l = 0; l < LANES; l++) {
                    lanes[k][l] = 1.0;
                }
            }
        }
    }
    gonio_i_log(sizeof lanes / sizeof(double), lanes[0], lanes[0]);
    for (int k = 0; k < LANE_ROWS; k++) {
        double sum = rest[k];
        for (int l = 0; l < LANES; l++) {
            sum += lanes[k][l];
        }
        const int data = count[k / GONIO_CHANNELS];
        mean[k] = data > 0 ? sum / data : NAN;
    }
}
