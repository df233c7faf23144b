/* Plans of least expected error for a basis: expected_error_search.h over its rows or over
 * candidates. */
#ifndef GONIO_EXPECTED_ERROR_PLAN_H
#define GONIO_EXPECTED_ERROR_PLAN_H

#include <gonio/plan.h>

#include "../prior/prior.h"
#include "../prior/stretch.h"

/* The name of the method. */
#define GONIO_I_EXPECTED_ERROR "expected-error"

/* What is known of a material after some readings. */
typedef struct gonio_i_known {
    const double *covariance;          /* [K][K]: of z */
    const gonio_half_difference *read; /* [count]: directions to exclude */
    size_t count;
    bool goes_on;    /* among candidates: as a plan that goes on, with */
    double alpha;    /* alpha and */
    double peak;     /* peak of the remainder in the models that the readings chose */
    double expected; /* the expected E6 without another reading, per cent */
    double variance; /* the same from the covariance alone */
    double norm; /* root of the sum of g^2 over the bins of the grid, which E6 is relative to; of
                  * anisotropic materials over the choices */
    /* Of anisotropic materials, without covariance and read: */
    const gonio_pair *pair;         /* [count]: what was read */
    const gonio_i_stretch *stretch; /* [stretches]: how the isotropic prior is stretched, */
    const double *stretch_weight;   /* [stretches]: which add up to 1 */
    size_t stretches;
} gonio_i_known;

enum { GONIO_I_USUAL_NEXT = 5 }; /* the default number of next readings, if there are as many */

/* As gonio_plan_create by expected-error, for a material of which something is known:
 * options->count further readings. The plan's expected[] is for this material, per cent. */
gonio_status gonio_i_expected_error_next(gonio_context *context, const gonio_basis *basis,
                                         const gonio_plan_options *options,
                                         const gonio_i_known *known, gonio_plan **plan);

#endif
