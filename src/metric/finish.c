/* From sums to an error, and the slope of terms: what several metrics share. */
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
