/* What the errors of evaluate.h are made of: sums over bins, and ratios of these. */
#ifndef GONIO_METRICS_H
#define GONIO_METRICS_H

#include <math.h>

#include <gonio/evaluate.h>

/* Sums over bins; the errors are ratios of these. */
typedef struct gonio_i_error_sums {
    double log_difference, log_reference;   /* squares of g - g', g */
    double cube_difference, cube_reference; /* squares of r - r', r */
    double ratio;                           /* squares of the log ratio */
} gonio_i_error_sums;

void gonio_i_error_add(gonio_i_error_sums *total, const gonio_i_error_sums *part);

/* The errors over so many values (bins x channels). */
gonio_error gonio_i_error_of(const gonio_i_error_sums *sums, double values);

/* e of the log-relative error. */
#define GONIO_I_RATIO_OFFSET 0.001

/* w of the log-relative error, given c_i c_o. */
static inline double gonio_i_ratio_weight(double cosines)
{
    const double least = cosines > 0.01 ? cosines : 0.01;
    return least < 1.0 ? least : 1.0;
}

#endif
