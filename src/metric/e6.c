/* E6: the relative root mean square error in log space (Ali et al., eq. (6)). T = g. */
#include "../core/vector_math.h"
#include "metric.h"

static void terms(const gonio_i_compared *v, double *difference, double *reference)
{
    const double factor = 1.0 / v->scale;
    for (size_t k = 0; k < v->count; k++) {
        reference[k] = v->reference[k] * factor;
        difference[k] = v->other[k] * factor;
    }
    gonio_i_log1p(v->count, reference, reference);
    gonio_i_log1p(v->count, difference, difference);
    for (size_t k = 0; k < v->count; k++) {
        difference[k] = reference[k] - difference[k];
    }
}

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
             .summary = "relative RMS of ln(1 + rho/s) over all valid bins (Ali et al., eq. 6), "
                        "per cent",
             .digits = 3,
             .plannable = true},
    .terms = terms,
    .finish = gonio_i_relative_rms_percent,
    .proportion = gonio_i_independent,
    .loss = loss,
};
