/* Plans of least expected error for an instrument: among what it reaches, in the order of least
 * time, for a number of readings or for a time. */
#ifndef GONIO_INSTRUMENT_PLAN_H
#define GONIO_INSTRUMENT_PLAN_H

#include "expected_error_plan.h"

/* As gonio_plan_create by expected-error, for options->instrument. known: NULL if nothing is. */
gonio_status gonio_i_instrument_plan(gonio_context *context, const gonio_basis *basis,
                                     const gonio_plan_options *options, const gonio_i_known *known,
                                     gonio_plan **plan);

#endif
