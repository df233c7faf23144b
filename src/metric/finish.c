/* Functions that several metrics share: from sums to an error, and the slope of terms. */
#include "../core/vector_math.h"
#include "metric.h"

#include <math.h>

double gonio_i_relative_rms_percent(const gonio_i_metric_sums *sums, double values)
{
    (void)values;
    return 100.0 * sqrt(sums->square / sums->reference);
}

double gonio_i_rms(const gonio_i_metric_sums *sums, double values)
{
    return sqrt(sums->square / values);
}

double gonio_i_independent(double cosines)
{
    (void)cosines;
    return 1.0;
}

void gonio_i_log_terms(const gonio_i_compared *v, double *difference, double *reference)
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
