/* Which bins of a slab hold data, and the bivariate average over them. */
#include <gonio/database.h>

#include "../core/core.h"
#include "../direction/grid.h"

void gonio_slab_mask(int theta_h, const double *rho, bool *data)
{
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
        const int first = gonio_i_first_valid_phi(theta_h, theta_d);
        const size_t row = (size_t)theta_d * GONIO_PHI_D_BINS;
        for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
            const size_t k = row + (size_t)p;
            data[k] = (p >= first) & (p < GONIO_PHI_D_BINS - first) & (rho[k] >= 0.0);
        }
    }
}

/* Mean of n values and the sum of their squared distances from it, over the bins with data. */
GONIO_I_VECTORISED static void mean_and_scatter(const double *g, const bool *data, int count,
                                                double *mean, double *scatter)
{
    double sum = 0.0;
    for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
        sum += data[p] ? g[p] : 0.0;
    }
    const double average = count > 0 ? sum / count : 0.0;
    double squares = 0.0;
    for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
        squares += data[p] ? (g[p] - average) * (g[p] - average) : 0.0;
    }
    *mean = average;
    *scatter = squares;
}

void gonio_slab_reduce(const double *g, const bool *data, gonio_slab_statistics *statistics)
{
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
        const size_t row = (size_t)theta_d * GONIO_PHI_D_BINS;
        int count = 0;
        for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
            count += data[row + (size_t)p];
        }
        statistics->count[theta_d] = count;
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            mean_and_scatter(g + (size_t)channel * GONIO_SLAB_BINS + row, data + row, count,
                             &statistics->mean[theta_d][channel],
                             &statistics->scatter[theta_d][channel]);
        }
    }
}
