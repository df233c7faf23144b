/* LAPACKE, loaded when it is used. After gonio_i_lapack_load has succeeded, its
 * functions are called as if it were linked: see core/on_demand.h. */
#ifndef GONIO_LAPACK_LIBRARY_H
#define GONIO_LAPACK_LIBRARY_H

#include <lapacke.h>

#include "../core/on_demand.h"

#define GONIO_I_LAPACK_SYMBOLS(X)                                                                  \
    X(LAPACKE_dgeqp3)                                                                              \
    X(LAPACKE_dgesvd)                                                                              \
    X(LAPACKE_dormqr) X(LAPACKE_dpotrf) X(LAPACKE_dpotri) X(LAPACKE_dsyevd) X(LAPACKE_dtrtri)

struct gonio_i_lapack {
    GONIO_I_LAPACK_SYMBOLS(GONIO_I_SYMBOL_POINTER)
};

extern struct gonio_i_lapack gonio_i_lapack;

gonio_status gonio_i_lapack_load(gonio_context *context);

#ifndef GONIO_I_LAPACK_ITSELF
#define LAPACKE_dgeqp3 (*gonio_i_lapack.LAPACKE_dgeqp3)
#define LAPACKE_dgesvd (*gonio_i_lapack.LAPACKE_dgesvd)
#define LAPACKE_dormqr (*gonio_i_lapack.LAPACKE_dormqr)
#define LAPACKE_dpotrf (*gonio_i_lapack.LAPACKE_dpotrf)
#define LAPACKE_dpotri (*gonio_i_lapack.LAPACKE_dpotri)
#define LAPACKE_dsyevd (*gonio_i_lapack.LAPACKE_dsyevd)
#define LAPACKE_dtrtri (*gonio_i_lapack.LAPACKE_dtrtri)
#endif

#endif
