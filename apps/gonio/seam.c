/* The seam of a table: see seam.h. */
#include "seam.h"

#include <math.h>

typedef struct sums {
    double across;
    double elsewhere;
    size_t rows;
} sums;

/* Adds the bins of one cell and channel, rho[GONIO_PHI_D_BINS]. */
static void add_row(const double *rho, int channel, sums *to)
{
    double g[GONIO_PHI_D_BINS];
    for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
        if (rho[p] < 0.0) {
            return;
        }
        g[p] = gonio_log_from_brdf(rho[p], channel);
    }
    for (int p = 1; p < GONIO_PHI_D_BINS; p++) {
        to->elsewhere += fabs(g[p] - g[p - 1]);
    }
    to->across += fabs(g[0] - g[GONIO_PHI_D_BINS - 1]);
    to->rows++;
}

tool_seam tool_find_seam(const gonio_table *table)
{
    const double *rho = gonio_table_values(table);
    sums all = {0};
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h++) {
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
                add_row(rho, channel, &all);
                rho += GONIO_PHI_D_BINS;
            }
        }
    }
    const double rows = all.rows > 0 ? (double)all.rows : 1.0;
    return (tool_seam){all.across / rows, all.elsewhere / (rows * (GONIO_PHI_D_BINS - 1))};
}

bool tool_seam_shows(const tool_seam *seam)
{
    return seam->across > 0.005 && seam->across > 5.0 * seam->elsewhere;
}
