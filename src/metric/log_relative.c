/* The root mean square of the log ratio, weighted by the cosines: T = ln(rho w + e), w = clip(c,
 * 0.01, 1) (Nielsen et al. 2015). */
#include <string.h>

#include "../core/vector_math.h"
#include "metric.h"

static const double OFFSET = 0.001; /* e, 1/sr */

static void terms(const gonio_i_compared *v, double *difference, double *reference)
{
    for (size_t k = 0; k < v->count; k++) {
        const double w = gonio_i_clip_cosines(v->cosines[k]);
        difference[k] = (v->reference[k] * w + OFFSET) / (v->other[k] * w + OFFSET);
    }
    gonio_i_log(v->count, difference, difference);
    memset(reference, 0, v->count * sizeof *reference);
}

/* dT/dg = w (rho + s)/(rho w + e) */
static double loss(double rho, double scale, double cosines)
{
    const double w = gonio_i_clip_cosines(cosines);
    const double slope = w * (rho + scale) / (rho * w + OFFSET);
    return slope * slope;
}

const gonio_i_metric gonio_i_metric_log_relative = {
    .view = {.name = "log-relative",
             .key = "log_relative",
             .heading = "log-rel",
             .title = "log-relative",
             .unit = "",
             .summary = "RMS of the log ratio, cosine-weighted (Nielsen et al. 2015)",
             .digits = 4,
             .plannable = true},
    .terms = terms,
    .finish = gonio_i_rms,
    .loss = loss,
};
