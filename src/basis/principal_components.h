/* The principal components of a centred observation matrix, out of core. */
#ifndef GONIO_PRINCIPAL_COMPONENTS_H
#define GONIO_PRINCIPAL_COMPONENTS_H

#include "learner.h"

/* Fills in the mean, the variances and the loadings of l->basis, and l->vectors. Lowers the number
 * of components to the rank if l->any_rank. Errors: _DATA if the rank is too low, _MEMORY, _IO,
 * _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_find_components(const gonio_i_learner *l);

#endif
