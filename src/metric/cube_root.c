/* The relative root mean square error of the cube root, T = cbrt(rho c). It is close to what people
 * see (Fores et al. 2012). */
#include <math.h>

#include "../core/vector_math.h"
#include "metric.h"

static void terms(const gonio_i_compared *v, double *difference, double *reference)
{
    for (size_t k = 0; k < v->count; k++) {
        reference[k] = v->reference[k] * v->cosines[k];
        difference[k] = v->other[k] * v->cosines[k];
    }
    gonio_i_cbrt(v->count, reference, reference);
    gonio_i_cbrt(v->count, difference, difference);
    for (size_t k = 0; k < v->count; k++) {
        difference[k] = reference[k] - difference[k];
    }
}

/* dT/dg = cbrt(c) (rho + s) rho^(-2/3) / 3, without the constant, and with rho + s in place of rho
 * so that it is finite at rho = 0. */
static double loss(double rho, double scale, double cosines)
{
    return pow(cosines, 2.0 / 3.0) * pow(rho + scale, 2.0 / 3.0);
}

const gonio_i_metric gonio_i_metric_cube_root = {
    .view = {.name = "cube-root",
             .key = "cube_root_percent",
             .heading = "cbrt %",
             .title = "cube root",
             .unit = "%",
             .summary = "relative RMS of the cube root of rho cos cos (Fores et al. 2012)",
             .digits = 3,
             .plannable = true},
    .terms = terms,
    .finish = gonio_i_relative_rms_percent,
    .proportion = cbrt,
    .loss = loss,
};
