/* A plan in memory, for the methods that make one. */
#ifndef GONIO_PLAN_INTERNAL_H
#define GONIO_PLAN_INTERNAL_H

#include <gonio/plan.h>

#include "../basis/basis.h"

/* A plan by a method, with space for its entries; NULL after a message. */
gonio_plan *gonio_i_allocate_plan(gonio_context *context, const gonio_basis_view *basis,
                                  const char *method, size_t components, size_t count);

/* The entry that reads a row of the basis, at phi_d if the basis is bivariate. */
gonio_plan_entry gonio_i_plan_entry(const gonio_basis_view *basis, size_t row, double phi_d);

#endif
