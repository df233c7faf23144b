/* Eigenvalues after an exchange of rows: H = diag(d) - y y' + z z', d ascending.
 *
 * By Sylvester's law of inertia on the bordered matrix, the number of eigenvalues of H above x is
 *   #(d_k > x) + n_plus(T) - 1,   T = [ 1 - sum y^2/(d - x)    - sum y z/(d - x)  ]
 *                                     [  - sum y z/(d - x)   -1 - sum z^2/(d - x) ]
 * with n_plus the number of positive eigenvalues of T. */
#ifndef GONIO_EXCHANGE_EIGENVALUES_H
#define GONIO_EXCHANGE_EIGENVALUES_H

#include <stdbool.h>
#include <stddef.h>

typedef struct gonio_i_exchange {
    const double *d; /* [n], ascending, all > 0 */
    const double *y; /* [n], the removed row */
    const double *z; /* [n], the added row */
    size_t n;        /* at least 2 */
} gonio_i_exchange;

/* The number of eigenvalues of H above x. */
int gonio_i_exchange_count_above(const gonio_i_exchange *exchange, double x);

/* Whether lambda_max(H)/lambda_min(H) < limit. */
bool gonio_i_exchange_beats(const gonio_i_exchange *exchange, double limit);

/* A test that uses only the first `part` values of z and its last one. False only if H does not
 * beat the limit: by Cauchy's interlacing, lambda_min of a principal submatrix is no less than H's.
 */
bool gonio_i_exchange_may_beat(const gonio_i_exchange *exchange, size_t part, double limit);

/* The k-th eigenvalue of H (from 0, ascending), less at most a relative 1e-10. */
double gonio_i_exchange_eigenvalue(const gonio_i_exchange *exchange, size_t k);

#endif
