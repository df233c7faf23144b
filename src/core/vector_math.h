/* Elementary functions of whole arrays, vectorised. All arguments must be finite. */
#ifndef GONIO_VECTOR_MATH_H
#define GONIO_VECTOR_MATH_H

#include <stddef.h>

void gonio_i_log1p(size_t n, const double *x, double *y);
void gonio_i_expm1(size_t n, const double *x, double *y);
void gonio_i_log(size_t n, const double *x, double *y);
void gonio_i_cbrt(size_t n, const double *x, double *y);

#endif
