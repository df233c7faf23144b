/* S^-1 of a fit, kept while it settles.
 *
 * Without a kept inverse, each round of gonio_i_fit_settle factorises S and inverts the factor. Of
 * many readings that takes most of the time, though only variances change, and of few readings.
 * With A the inverse of the first S, T its columns of the readings whose variances have grown
 * since, and D by how much,
 *
 *     S^-1 = A - T (D^-1 + A_changed)^-1 T'
 *
 * (Woodbury 1950). The rounds need its diagonal and the solution only. */
#ifndef GONIO_FIT_INVERSE_H
#define GONIO_FIT_INVERSE_H

#include "fit.h"

/* From now on the inverse is kept. For a fit without samples, before it is solved. Errors: _MEMORY.
 */
gonio_status gonio_i_fit_inverse_keep(gonio_i_fit *fit);

/* Solves the fit again after variances have changed, but for L and the evidence: by the inverse if
 * they are not smaller than when that was made. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_fit_inverse_solve(gonio_i_fit *fit);

/* Of a fit that was predicted from: puts the changes into the lower triangle of the inverse, which
 * is then that of S. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_fit_inverse_complete(gonio_i_fit *fit);

/* tr(S^-1 m) for a symmetric m[n][n], of a fit whose inverse was completed, after which its
 * variances do not change. */
double gonio_i_fit_inverse_trace(const gonio_i_fit *fit, const double *m);

#endif
