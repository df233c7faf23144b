/* Elementary functions of whole arrays. This file alone is compiled with -ffast-math, which lets
 * the compiler call glibc's vector functions (within 4 units in the last place). So arguments must
 * not be infinite or NaN. */
#include "vector_math.h"

#include <math.h>

#include "core.h"

GONIO_I_VECTORISED void gonio_i_log1p(size_t n, const double *x, double *y)
{
#pragma omp simd
    for (size_t k = 0; k < n; k++) {
        y[k] = log1p(x[k]);
    }
}

GONIO_I_VECTORISED void gonio_i_expm1(size_t n, const double *x, double *y)
{
#pragma omp simd
    for (size_t k = 0; k < n; k++) {
        y[k] = expm1(x[k]);
    }
}

GONIO_I_VECTORISED void gonio_i_log(size_t n, const double *x, double *y)
{
#pragma omp simd
    for (size_t k = 0; k < n; k++) {
        y[k] = log(x[k]);
    }
}

GONIO_I_VECTORISED void gonio_i_cbrt(size_t n, const double *x, double *y)
{
#pragma omp simd
    for (size_t k = 0; k < n; k++) {
        y[k] = cbrt(x[k]);
    }
}
