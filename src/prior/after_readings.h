/* The covariance of a Gaussian prior after readings. */
#ifndef GONIO_AFTER_READINGS_H
#define GONIO_AFTER_READINGS_H

#include "../core/core.h"

/* covariance[k][k] = I - f' (f f' + variance I)^-1 f: of z, whose prior is N(0, I), after n
 * readings f[n][k] z + noise of this variance. It does not depend on their values (Rasmussen and
 * Williams 2006, sec. 2.1). Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_covariance_after(gonio_context *context, const double *f, size_t n, size_t k,
                                      double variance, double *covariance);

#endif
