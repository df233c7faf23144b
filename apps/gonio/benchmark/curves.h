/* Curves of mean errors against directions, one figure a set. */
#ifndef GONIO_BENCHMARK_CURVES_H
#define GONIO_BENCHMARK_CURVES_H

#include "summary.h"

/* Whether there is more than one n, without which there are no curves. */
bool benchmark_has_curves(const benchmark_summary *summary);

/* figures/e6-K.png and its data, K the place of the set from 1. Errors: those of figure.h. */
gonio_status benchmark_draw_curves(gonio_context *context, const benchmark_summary *summary,
                                   const char *folder);

#endif
