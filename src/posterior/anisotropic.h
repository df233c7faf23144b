/* The posterior of an anisotropic material, given its readings.
 *
 * The posterior of posterior.h under the hypotheses of stretches.h: a mean over them, at any pair
 * of directions. Its variance is the mean of theirs plus that of their differences. */
#ifndef GONIO_ANISOTROPIC_H
#define GONIO_ANISOTROPIC_H

#include "stretches.h"

typedef struct gonio_i_anisotropic gonio_i_anisotropic;

/* The most readings of each of `columns` columns that an estimate is made of. */
size_t gonio_i_anisotropic_most_readings(size_t columns);

/* Solves for all columns. columns->prior must outlive the estimate; its other arrays need not.
 * Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_anisotropic_find(gonio_context *context,
                                      const gonio_i_oriented_columns *columns,
                                      gonio_i_anisotropic **estimate);
void gonio_i_anisotropic_free(gonio_i_anisotropic **estimate);

/* What was weighed. */
const gonio_i_stretches *gonio_i_anisotropic_stretches(const gonio_i_anisotropic *estimate);

/* Readings that the others contradict, of all columns. */
size_t gonio_i_anisotropic_outlying(const gonio_i_anisotropic *estimate);

/* g[columns] and, unless NULL, variance[columns] of the Gaussian and of what hypotheses differ by,
 * at a place. scratch: gonio_i_anisotropic_scratch values. Any number of threads. */
size_t gonio_i_anisotropic_scratch(const gonio_i_anisotropic *estimate);
void gonio_i_anisotropic_at(const gonio_i_anisotropic *estimate, gonio_i_oriented here,
                            double *scratch, double *g, double *variance);

/* Standard deviations of bands that hold 95 % of the true values within 1.96 of them, and the
 * expected square of an error, of a variance. */
double gonio_i_anisotropic_band(double variance);
double gonio_i_anisotropic_square(double variance);

/* The expected E6, per cent, by a sample of the grid at all azimuths; and the root of the mean over
 * columns and the sample of g^2 plus its variance. Errors: _MEMORY. */
gonio_status gonio_i_anisotropic_expect(gonio_context *context, const gonio_i_anisotropic *estimate,
                                        double *e6, double *norm);

#endif
