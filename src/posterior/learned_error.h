/* The expected error, learned from the database.
 *
 * The readings of a material partly predict the error of its reconstruction: by how much they
 * contradict each other and the prior, how bright they are, and how much they differ. The relation
 * is learned from the database. A tenth of its materials is left out at a time, with every mixture
 * made of them. Their columns are read at the same directions, with noise of the same variance
 * (except at readings without weight), and reconstructed from the other columns by a Gaussian
 * (posterior.h with h = 1 and alpha = 0). The logarithm of the mean squared error is fitted to four
 * features of the readings by ridge regression (Hoerl and Kennard 1970). Duan's smearing (1983)
 * transforms logarithms of errors back, so that the result is the mean error. */
#ifndef GONIO_LEARNED_ERROR_H
#define GONIO_LEARNED_ERROR_H

#include "fit.h"
#include "targets.h"

typedef struct gonio_i_learned_error gonio_i_learned_error;

/* Of the error over the targets. *learned is NULL if the basis does not allow it: without loadings,
 * of too few materials, or with mixtures whose parents are unknown. The prior must outlive it, the
 * targets need not. Errors: _MEMORY. */
gonio_status gonio_i_learned_error_create(gonio_context *context, const gonio_i_prior *prior,
                                          const gonio_i_targets *targets,
                                          gonio_i_learned_error **learned);
void gonio_i_learned_error_free(gonio_i_learned_error **learned);

/* Prepares for many folds at many sites: their covariances are then made of those of z, in place of
 * every column of the database. Errors: _MEMORY. */
gonio_status gonio_i_learned_error_prepare(gonio_context *context, gonio_i_learned_error *learned);

/* Readings of a column from which on _find takes long; fewer can be had by merging (merge.h). */
enum { GONIO_I_LEARNED_ERROR_MOST = 400 };

/* The database, a tenth left out at a time, as it is seen at some sites: made once for all columns
 * of these sites and not changed, so that any number of threads may use it. Both must outlive it.
 * Errors: _MEMORY. */
typedef struct gonio_i_folds gonio_i_folds;

gonio_status gonio_i_folds_create(gonio_context *context, const gonio_i_learned_error *learned,
                                  const gonio_i_sites *sites, gonio_i_folds **folds);
void gonio_i_folds_free(gonio_i_folds **folds);

/* The square of the root mean square over the targets of the error of g that is expected
 * on average, for a fit over the same sites (settled: its variances are what is believed of them).
 * Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_learned_error_find(const gonio_i_folds *folds, const gonio_i_fit *fit,
                                        double *square);

#endif
