/* Plans of least expected error for a basis: expected_error_search.h over its rows or over
 * candidates. */
#ifndef GONIO_EXPECTED_ERROR_PLAN_H
#define GONIO_EXPECTED_ERROR_PLAN_H

#include <gonio/plan.h>

#include "../prior/prior.h"

/* What is known of a material already, for the readings that come next. */
typedef struct gonio_i_known {
    const double *covariance;          /* [K][K]: of z */
    const gonio_half_difference *read; /* [count]: directions that are not to be read again */
    size_t count;
    double expected; /* the E6 to expect without another reading, per cent; */
    double variance; /* and by the covariance alone */
    double norm;     /* root of the sum of g^2 over the bins of the grid, which E6 is relative to */
} gonio_i_known;

enum { GONIO_I_USUAL_NEXT = 5 }; /* readings that come next, or as many as there are */

/* As gonio_plan_create by expected-error, for a material of which something is known;
 * options->count readings of those that were not made. The plan's expected[] are per cent of the
 * material itself. */
gonio_status gonio_i_expected_error_next(gonio_context *context, const gonio_basis *basis,
                                         const gonio_plan_options *options,
                                         const gonio_i_known *known, gonio_plan **plan);

#endif
