/* Dense linear algebra: the only callers of BLAS and LAPACK. Sizes are checked against LAPACK's
 * 32-bit integers, `info` becomes a status. Matrices are row-major with the row length as leading
 * dimension unless said otherwise. */
#ifndef GONIO_LINALG_H
#define GONIO_LINALG_H

#include <stddef.h>

#include "../core/core.h"

/* a'b of n values. */
double gonio_i_dot(const double *a, const double *b, size_t n);

/* A'A for A (n columns of `rows` values, column-major) added to the upper triangle of C (n x n). */
gonio_status gonio_i_add_gram_columns(gonio_context *context, const double *a, size_t rows,
                                      size_t n, double *c);

/* Copies the upper triangle of C (n x n) to the lower one. */
void gonio_i_mirror(double *c, size_t n);

/* A'A for A (rows x n, row-major) added to the upper triangle of C (n x n). */
gonio_status gonio_i_add_gram_rows(gonio_context *context, const double *a, size_t rows, size_t n,
                                   double *c);

/* C (n x n, both triangles) = A'A for A (rows x n, row-major, `leading` values apart). */
gonio_status gonio_i_gram_rows(gonio_context *context, const double *a, size_t rows, size_t n,
                               size_t leading, double *c);

/* C (rows x k) = A (column-major, rows x n) B (n x k, row-major). */
gonio_status gonio_i_product_columns(gonio_context *context, const double *a, size_t rows, size_t n,
                                     const double *b, size_t k, double *c);

/* C (rows x n, `leading` values apart) = A B' for A (rows x k) and B (n x k), row-major. */
gonio_status gonio_i_product_transposed(gonio_context *context, const double *a, size_t rows,
                                        size_t k, const double *b, size_t n, double *c,
                                        size_t leading);

/* C (rows x n) = A B' for A (rows x k, `leading` values apart) and B (n x k), row-major. */
gonio_status gonio_i_product_rows(gonio_context *context, const double *a, size_t rows, size_t k,
                                  size_t leading, const double *b, size_t n, double *c);

/* C (rows x n) = A B for A (rows x k) and B (k x n), row-major. */
gonio_status gonio_i_product(gonio_context *context, const double *a, size_t rows, size_t k,
                             const double *b, size_t n, double *c);

/* Eigenvalues (ascending) of a symmetric n x n matrix, and with `vectors` its eigenvectors: on
 * return row j of a is the eigenvector of the j-th value. a is overwritten in any case. */
gonio_status gonio_i_eigen(gonio_context *context, double *a, size_t n, bool vectors,
                           double *values);

/* The lower triangular L of C = L L', in place of a symmetric positive definite C (n x n); zeros
 * above the diagonal. */
gonio_status gonio_i_cholesky(gonio_context *context, double *c, size_t n);

/* L^-1 for the lower triangular L of C = L L', in place of a symmetric positive definite C (n x n);
 * zeros above the diagonal. A C that is not positive definite is GONIO_ERROR_DATA without a message
 * if the context is NULL. */
gonio_status gonio_i_inverse_cholesky(gonio_context *context, double *c, size_t n);

/* (X'X)^-1 (n x n, both triangles) of `count` rows of V (n values each, `leading` apart). */
gonio_status gonio_i_inverse_gram(gonio_context *context, const double *v, size_t leading, size_t n,
                                  const size_t *rows, size_t count, double *inverse);

/* b (columns x n) becomes b L^-1: with b = x L'^-1 that is x C^-1 for C = L L'. The same limits. */
void gonio_i_divide_lower(double *b, size_t columns, size_t n, const double *l);

/* A (rows x n, row-major) becomes A L'^-1 for a lower triangular L (n x n), of a matrix that fits
 * LAPACK's integers. */
void gonio_i_divide_triangle(double *a, size_t rows, size_t n, const double *l);

/* diagonal[n]: of (L L')^-1. */
gonio_status gonio_i_inverse_diagonal(gonio_context *context, const double *l, size_t n,
                                      double *diagonal);

/* inverse[n][n]: (L L')^-1. */
gonio_status gonio_i_inverse_of_factor(gonio_context *context, const double *l, size_t n,
                                       double *inverse);

/* A A' for A (n x k, row-major) subtracted from the lower triangle of C (n x n). */
gonio_status gonio_i_subtract_gram(gonio_context *context, const double *a, size_t n, size_t k,
                                   double *c);

/* y = C x for a symmetric C (n x n, what is above its diagonal is not read). */
void gonio_i_multiply_symmetric(const double *c, size_t n, const double *x, double *y);

/* A (rows x n, row-major) becomes A L for a lower triangular L (n x n, what is above its diagonal
 * is not read), of a matrix that fits BLAS' integers. Half the work of a product. */
void gonio_i_multiply_lower(double *a, size_t rows, size_t n, const double *l);

/* argmin |A x - b| by QR with column pivoting. A: rows x n, row-major; b: `columns`
 * right-hand sides of `rows` values each; x: [columns][n]. rank: of A to working precision; if it
 * is less than n, x is not written. condition: (largest/smallest singular value of A)^2. */
gonio_status gonio_i_least_squares(gonio_context *context, const double *a, size_t rows, size_t n,
                                   const double *b, size_t columns, double *x, size_t *rank,
                                   double *condition);

/* One step of QR with row pivoting: finds the longest of the rows (rows x n, row-major) and
 * projects all rows onto the complement of its direction. `step` is the number of steps made
 * before. GONIO_ERROR_DATA if all rows are 0 to rounding. */
gonio_status gonio_i_take_farthest(gonio_context *context, double *a, size_t rows, size_t n,
                                   size_t step, size_t *farthest);

#endif
