/* Plans of least expected error for a basis: expected_error.h over its rows or over candidates. */
#ifndef GONIO_DESIGN_H
#define GONIO_DESIGN_H

#include <gonio/plan.h>

#include "../basis/prior.h"

/* As gonio_plan_create for the method expected-error. */
gonio_status gonio_i_design_plan(gonio_context *context, const gonio_basis *basis,
                                 const gonio_plan_options *options, gonio_plan **plan);

/* What plan.c and design.c share: a plan with room for its entries, NULL after a message; and where
 * to measure a cell. */
gonio_plan *gonio_i_allocate_plan(gonio_context *context, size_t count);
gonio_pair gonio_i_pair_of(const gonio_basis_view *basis, int32_t cell, double phi_d);

#endif
