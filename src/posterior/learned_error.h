/* The error to expect, learned from the database.
 *
 * How far off a reconstruction is shows in its readings, to a degree: in how much they contradict
 * each other and the prior, how bright they are and how much they differ. How that shows, the
 * database tells. A tenth of its materials at a time is left out, with every mixture made of one;
 * their columns are read at the same directions with noise of the same variance (but of readings
 * that have no say) and reconstructed from the other columns by their Gaussian (posterior.h with h
 * = 1 and alpha = 0). Ridge regression (Hoerl and Kennard 1970) of the logarithm of the error's
 * mean square on four features of the readings says what to expect of the new material; from
 * logarithms of errors back by Duan's smearing (1983), so that it is the error expected on average.
 */
#ifndef GONIO_LEARNED_ERROR_H
#define GONIO_LEARNED_ERROR_H

#include "fit.h"

typedef struct gonio_i_learned_error gonio_i_learned_error;

/* *learned is NULL if the database cannot tell: a basis without loadings, of few materials, or of
 * mixtures that nobody knows the parents of. The prior must outlive it. Errors: _MEMORY. */
gonio_status gonio_i_learned_error_create(gonio_context *context, const gonio_i_prior *prior,
                                          gonio_i_learned_error **learned);
void gonio_i_learned_error_free(gonio_i_learned_error **learned);

/* Readings of a column from which on _find takes long; fewer can be had by merging (merge.h). */
enum { GONIO_I_LEARNED_ERROR_MOST = 400 };

/* The database, a tenth left out at a time, as it is seen at some sites: made once for all columns
 * of these sites and not changed, so that any number of threads may use it. Both must outlive it.
 * Errors: _MEMORY. */
typedef struct gonio_i_folds gonio_i_folds;

gonio_status gonio_i_folds_create(gonio_context *context, const gonio_i_learned_error *learned,
                                  const gonio_i_sites *sites, gonio_i_folds **folds);
void gonio_i_folds_free(gonio_i_folds **folds);

/* The square of the root mean square over the bins of the grid of the error of g that is expected
 * on average, for a fit over the same sites (settled: its variances are what is believed of them).
 * Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_learned_error_find(const gonio_i_folds *folds, const gonio_i_fit *fit,
                                        double *square);

#endif
