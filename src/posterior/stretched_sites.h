/* Sites (sites.h) of readings under the prior of anisotropic materials (prior/stretch.h). */
#ifndef GONIO_STRETCHED_SITES_H
#define GONIO_STRETCHED_SITES_H

#include "../prior/stretch.h"
#include "sites.h"

/* A column's observations as those of the isotropic material: where the stretch takes the half
 * vectors, less the factor of the values. The caller frees there->observation. pair: of all
 * readings, by gonio_i_observation.reading. Errors: _MEMORY. */
gonio_status gonio_i_stretched_column(gonio_context *context, const gonio_i_column *column,
                                      const gonio_pair *pair, const gonio_i_stretch *stretch,
                                      gonio_i_column *there);

/* The derivative of what an observation becomes by what it is. */
double gonio_i_stretched_slope(const gonio_i_observation *observation, const gonio_pair *pair,
                               const gonio_i_stretch *stretch);

/* Sites of a column: the isotropic prior where the stretch takes the half vectors, with covariances
 * that depend on their azimuth. The prior must outlive them. Errors: _MEMORY. */
gonio_status gonio_i_stretched_sites_create(gonio_context *context, const gonio_i_prior *prior,
                                            const gonio_i_column *column, const gonio_pair *pair,
                                            const gonio_i_stretch *stretch, gonio_i_sites **sites);

/* Whether two columns have the same readings, so that sites of one are those of the other. */
bool gonio_i_columns_are_same(const gonio_i_column *a, const gonio_i_column *b);

#endif
