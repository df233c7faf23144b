/* Bias: the mean signed error in log space. Above 0 the other is too bright. T = g. */
#include <string.h>

#include "metric.h"

static void terms(const gonio_i_compared *v, double *difference, double *reference)
{
    gonio_i_log_terms(v, difference, reference);
    memset(reference, 0, v->count * sizeof *reference);
}

/* The mean of g' - g, of which d is the negative; 0.0 - x is 0, not -0, for equal values. */
static double finish(const gonio_i_metric_sums *sums, double values)
{
    return 100.0 * (0.0 - sums->difference) / values;
}

const gonio_i_metric gonio_i_metric_bias = {
    .view = {.name = "bias",
             .key = "bias_percent",
             .heading = "bias %",
             .title = "bias",
             .unit = "%",
             .summary = "mean error of ln(1 + rho/s), times 100; above 0 it is too bright",
             .digits = 3,
             .plannable = false},
    .terms = terms,
    .finish = finish,
    .proportion = gonio_i_independent,
};
