/* E6: the relative root mean square error in log space (Ali et al., eq. (6)). T = g. */
#include "metric.h"

static double loss(double rho, double scale, double cosines)
{
    (void)rho;
    (void)scale;
    (void)cosines;
    return 1.0;
}

const gonio_i_metric gonio_i_metric_e6 = {
    .view = {.name = "e6",
             .key = "e6_percent",
             .heading = "E6 %",
             .title = "E6",
             .unit = "%",
             .summary = "relative RMS of ln(1 + rho/s) over all valid bins (Ali et al., eq. 6)",
             .digits = 3,
             .plannable = true},
    .terms = gonio_i_log_terms,
    .finish = gonio_i_relative_rms_percent,
    .proportion = gonio_i_independent,
    .loss = loss,
};
