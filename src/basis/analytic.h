/* Analytic columns: random analytic materials (gonio/atlas.h) that a basis learns from beside the
 * materials of the database, with a small weight. The basis then spans materials unlike those of
 * the database, too. */
#ifndef GONIO_ANALYTIC_H
#define GONIO_ANALYTIC_H

#include "basis.h"

/* The share of the analytic columns in a basis (docs/experiments.md). */
#define GONIO_I_ANALYTIC_SHARE 0.05

/* The standard deviation of ln r. */
#define GONIO_I_ELONGATION 0.7

/* The first `materials` random materials on the rows of a database, each elongated (elongation.h)
 * by a ratio of its own, whose logarithm is normal with the deviation of GONIO_I_ELONGATION:
 * values[column][rows], columns as those of a database's own materials. The caller frees *values.
 * `basis` has its cells and their map set.
 * Errors: _MEMORY, _CANCELLED. */
gonio_status gonio_i_analytic_columns(gonio_context *context, const gonio_basis *basis,
                                      const gonio_database *database, size_t materials,
                                      float **values);

#endif
