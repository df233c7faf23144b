/* Dense linear algebra over CBLAS and LAPACKE: see linalg.h. */
#include "linalg.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <cblas.h>

#include "lapack_library.h"

/* Every call of OpenBLAS begins with this. LAPACK counts in 32-bit integers. */
static gonio_status check_size(gonio_context *context, size_t rows, size_t columns)
{
    gonio_i_keep_blas_on_one_thread();
    if (rows > INT_MAX || columns > INT_MAX) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a matrix of %zu x %zu is more than LAPACK can index", rows, columns);
    }
    return gonio_i_lapack_load(context);
}

static gonio_status check_info(gonio_context *context, const char *routine, lapack_int info)
{
    if (info == LAPACK_WORK_MEMORY_ERROR || info == LAPACK_TRANSPOSE_MEMORY_ERROR) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory in %s", routine);
    }
    if (info != 0) {
        return gonio_i_fail(context, GONIO_ERROR_NUMERICAL, "%s failed (info = %d)", routine,
                            (int)info);
    }
    return GONIO_OK;
}

void gonio_i_mirror(double *c, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < i; j++) {
            c[i * n + j] = c[j * n + i];
        }
    }
}

GONIO_I_VECTORISED double gonio_i_dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

gonio_status gonio_i_add_gram_columns(gonio_context *context, const double *a, size_t rows,
                                      size_t n, double *c)
{
    const gonio_status status = check_size(context, rows, n);
    if (status == GONIO_OK) {
        /* Column-major (rows x n) is row-major (n x rows). */
        cblas_dsyrk(CblasRowMajor, CblasUpper, CblasNoTrans, (int)n, (int)rows, 1.0, a, (int)rows,
                    1.0, c, (int)n);
    }
    return status;
}

gonio_status gonio_i_add_gram_rows(gonio_context *context, const double *a, size_t rows, size_t n,
                                   double *c)
{
    const gonio_status status = check_size(context, rows, n);
    if (status == GONIO_OK) {
        cblas_dsyrk(CblasRowMajor, CblasUpper, CblasTrans, (int)n, (int)rows, 1.0, a, (int)n, 1.0,
                    c, (int)n);
    }
    return status;
}

gonio_status gonio_i_gram_rows(gonio_context *context, const double *a, size_t rows, size_t n,
                               size_t leading, double *c)
{
    const gonio_status status = check_size(context, rows, leading);
    if (status == GONIO_OK) {
        cblas_dsyrk(CblasRowMajor, CblasUpper, CblasTrans, (int)n, (int)rows, 1.0, a, (int)leading,
                    0.0, c, (int)n);
        gonio_i_mirror(c, n);
    }
    return status;
}

gonio_status gonio_i_product_columns(gonio_context *context, const double *a, size_t rows, size_t n,
                                     const double *b, size_t k, double *c)
{
    const gonio_status status = check_size(context, rows, n > k ? n : k);
    if (status == GONIO_OK) {
        cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, (int)rows, (int)k, (int)n, 1.0, a,
                    (int)rows, b, (int)k, 0.0, c, (int)k);
    }
    return status;
}

gonio_status gonio_i_product_transposed(gonio_context *context, const double *a, size_t rows,
                                        size_t k, const double *b, size_t n, double *c,
                                        size_t leading)
{
    const gonio_status status = check_size(context, rows, n > k ? n : k);
    if (status == GONIO_OK) {
        cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, (int)rows, (int)n, (int)k, 1.0, a,
                    (int)k, b, (int)k, 0.0, c, (int)leading);
    }
    return status;
}

gonio_status gonio_i_product_rows(gonio_context *context, const double *a, size_t rows, size_t k,
                                  size_t leading, const double *b, size_t n, double *c)
{
    const gonio_status status = check_size(context, rows, n > leading ? n : leading);
    if (status == GONIO_OK) {
        cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, (int)rows, (int)n, (int)k, 1.0, a,
                    (int)leading, b, (int)k, 0.0, c, (int)n);
    }
    return status;
}

gonio_status gonio_i_eigen(gonio_context *context, double *a, size_t n, bool vectors,
                           double *values)
{
    const gonio_status status = check_size(context, n, n);
    if (status != GONIO_OK) {
        return status;
    }
    /* Column-major on a symmetric matrix: the eigenvectors come out as rows of `a`. */
    const lapack_int info =
        LAPACKE_dsyevd(LAPACK_COL_MAJOR, vectors ? 'V' : 'N', 'U', (int)n, a, (int)n, values);
    return check_info(context, "dsyevd", info);
}

gonio_status gonio_i_product(gonio_context *context, const double *a, size_t rows, size_t k,
                             const double *b, size_t n, double *c)
{
    const gonio_status status = check_size(context, rows, n > k ? n : k);
    if (status == GONIO_OK) {
        cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, (int)rows, (int)n, (int)k, 1.0, a,
                    (int)k, b, (int)n, 0.0, c, (int)n);
    }
    return status;
}

gonio_status gonio_i_cholesky(gonio_context *context, double *c, size_t n)
{
    gonio_status status = check_size(context, n, n);
    if (status == GONIO_OK) {
        /* Upper in column-major is lower in row-major; so LAPACKE has nothing to transpose. */
        status =
            check_info(context, "dpotrf", LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'U', (int)n, c, (int)n));
    }
    for (size_t i = 0; i < n; i++) {
        memset(c + i * n + i + 1, 0, (n - 1 - i) * sizeof *c);
    }
    return status;
}

gonio_status gonio_i_inverse_cholesky(gonio_context *context, double *c, size_t n)
{
    gonio_status status = gonio_i_cholesky(context, c, n);
    if (status == GONIO_OK) {
        status = check_info(context, "dtrtri",
                            LAPACKE_dtrtri(LAPACK_COL_MAJOR, 'U', 'N', (int)n, c, (int)n));
    }
    return status;
}

gonio_status gonio_i_inverse_gram(gonio_context *context, const double *v, size_t leading, size_t n,
                                  const size_t *rows, size_t count, double *inverse)
{
    double *x = gonio_i_allocate(context, count * n, sizeof *x);
    if (x == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t j = 0; j < count; j++) {
        memcpy(x + j * n, v + rows[j] * leading, n * sizeof *x);
    }
    gonio_status status = gonio_i_gram_rows(context, x, count, n, n, inverse);
    free(x);
    if (status == GONIO_OK) {
        status = gonio_i_cholesky(context, inverse, n);
    }
    if (status == GONIO_OK) {
        status = check_info(context, "dpotri",
                            LAPACKE_dpotri(LAPACK_COL_MAJOR, 'U', (int)n, inverse, (int)n));
    }
    /* The upper triangle in column-major is the lower one in row-major. */
    for (size_t i = 0; i < n; i++) {
        for (size_t j = i + 1; j < n; j++) {
            inverse[i * n + j] = inverse[j * n + i];
        }
    }
    return status;
}

void gonio_i_divide_lower(double *b, size_t columns, size_t n, const double *l)
{
    gonio_i_keep_blas_on_one_thread();
    cblas_dtrsm(CblasRowMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, (int)columns,
                (int)n, 1.0, l, (int)n, b, (int)n);
}

void gonio_i_divide_triangle(double *a, size_t rows, size_t n, const double *l)
{
    gonio_i_keep_blas_on_one_thread();
    cblas_dtrsm(CblasRowMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, (int)rows, (int)n,
                1.0, l, (int)n, a, (int)n);
}

gonio_status gonio_i_inverse_diagonal(gonio_context *context, const double *l, size_t n,
                                      double *diagonal)
{
    double *inverse = gonio_i_allocate(context, n * n, sizeof *inverse);
    if (inverse == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        inverse[i * n + i] = 1.0;
    }
    gonio_i_divide_triangle(inverse, n, n, l);
    for (size_t i = 0; i < n; i++) {
        diagonal[i] = gonio_i_dot(inverse + i * n, inverse + i * n, n);
    }
    free(inverse);
    return GONIO_OK;
}

/* Copies the lower triangle to the upper one, square after square: columns of large matrices lie in
 * as many pages of memory as they have elements. */
static void mirror_lower(double *a, size_t n)
{
    enum { SQUARE = 32 };
    for (size_t k = 0; k < n * ((n + SQUARE - 1) / SQUARE); k++) {
        const size_t i = k % n;
        const size_t left = k / n * SQUARE;
        for (size_t j = left; j < i && j < left + SQUARE; j++) {
            a[j * n + i] = a[i * n + j];
        }
    }
}

gonio_status gonio_i_inverse_of_factor(gonio_context *context, const double *l, size_t n,
                                       double *inverse)
{
    const gonio_status status = check_size(context, n, n);
    if (status != GONIO_OK) {
        return status;
    }
    memcpy(inverse, l, n * n * sizeof *inverse);
    const lapack_int info = LAPACKE_dpotri(LAPACK_COL_MAJOR, 'U', (int)n, inverse, (int)n);
    mirror_lower(inverse, n);
    return check_info(context, "dpotri", info);
}

gonio_status gonio_i_subtract_gram(gonio_context *context, const double *a, size_t n, size_t k,
                                   double *c)
{
    const gonio_status status = check_size(context, n, k);
    if (status == GONIO_OK) {
        cblas_dsyrk(CblasRowMajor, CblasLower, CblasNoTrans, (int)n, (int)k, -1.0, a, (int)k, 1.0,
                    c, (int)n);
    }
    return status;
}

void gonio_i_multiply_symmetric(const double *c, size_t n, const double *x, double *y)
{
    gonio_i_keep_blas_on_one_thread();
    cblas_dsymv(CblasRowMajor, CblasLower, (int)n, 1.0, c, (int)n, x, 1, 0.0, y, 1);
}

void gonio_i_multiply_lower(double *a, size_t rows, size_t n, const double *l)
{
    gonio_i_keep_blas_on_one_thread();
    cblas_dtrmm(CblasRowMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, (int)rows,
                (int)n, 1.0, l, (int)n, a, (int)n);
}

/* The numerical rank from the diagonal of R, which pivoting leaves in falling order. */
static size_t rank_of(const double *r, size_t rows, size_t n)
{
    const size_t most = rows < n ? rows : n;
    const double size = (double)(rows > n ? rows : n);
    const double tolerance = most > 0 ? fabs(r[0]) * size * DBL_EPSILON : 0.0;
    size_t rank = 0;
    while (rank < most && fabs(r[rank + rank * rows]) > tolerance) {
        rank++;
    }
    return rank;
}

/* (largest/smallest singular value)^2 of the n x n triangle of a factorised column-major matrix. */
static gonio_status triangle_condition(gonio_context *context, const double *r, size_t rows,
                                       size_t n, double *condition)
{
    double *copy = gonio_i_allocate(context, n * n + 2 * n, sizeof *copy);
    if (copy == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    double *singular = copy + n * n;
    for (size_t j = 0; j < n; j++) {
        memcpy(copy + j * n, r + j * rows, (j + 1) * sizeof *copy);
    }
    const gonio_status status =
        check_info(context, "dgesvd",
                   LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'N', 'N', (int)n, (int)n, copy, (int)n,
                                  singular, NULL, 1, NULL, 1, singular + n));
    if (status == GONIO_OK) {
        const double ratio = singular[0] / singular[n - 1];
        *condition = ratio * ratio;
    }
    free(copy);
    return status;
}

/* x = P R^-1 Q'b for one right-hand side; work holds `rows` values. */
static gonio_status back_substitute(gonio_context *context, const double *factors,
                                    const double *reflectors, const lapack_int *pivots, size_t rows,
                                    size_t n, const double *b, double *work, double *x)
{
    memcpy(work, b, rows * sizeof *work);
    const gonio_status status =
        check_info(context, "dormqr",
                   LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'T', (int)rows, 1, (int)n, factors,
                                  (int)rows, reflectors, work, (int)rows));
    if (status == GONIO_OK) {
        cblas_dtrsv(CblasColMajor, CblasUpper, CblasNoTrans, CblasNonUnit, (int)n, factors,
                    (int)rows, work, 1);
        for (size_t k = 0; k < n; k++) {
            x[(size_t)pivots[k] - 1] = work[k];
        }
    }
    return status;
}

static gonio_status solve(gonio_context *context, double *factors, size_t rows, size_t n,
                          double *reflectors, lapack_int *pivots, double *work, const double *b,
                          size_t columns, double *x, size_t *rank, double *condition)
{
    gonio_status status = check_info(context, "dgeqp3",
                                     LAPACKE_dgeqp3(LAPACK_COL_MAJOR, (int)rows, (int)n, factors,
                                                    (int)rows, pivots, reflectors));
    if (status != GONIO_OK) {
        return status;
    }
    *rank = rank_of(factors, rows, n);
    *condition = INFINITY;
    if (*rank < n) {
        return GONIO_OK;
    }
    status = triangle_condition(context, factors, rows, n, condition);
    for (size_t k = 0; k < columns && status == GONIO_OK; k++) {
        status = back_substitute(context, factors, reflectors, pivots, rows, n, b + k * rows, work,
                                 x + k * n);
    }
    return status;
}

gonio_status gonio_i_least_squares(gonio_context *context, const double *a, size_t rows, size_t n,
                                   const double *b, size_t columns, double *x, size_t *rank,
                                   double *condition)
{
    gonio_status status = check_size(context, rows, n);
    if (status != GONIO_OK) {
        return status;
    }
    double *memory = gonio_i_allocate(context, rows * n + n + rows, sizeof *memory);
    lapack_int *pivots = gonio_i_allocate(context, n, sizeof *pivots);
    if (memory == NULL || pivots == NULL) {
        status = GONIO_ERROR_MEMORY;
    } else {
        for (size_t i = 0; i < rows; i++) {
            for (size_t j = 0; j < n; j++) {
                memory[i + j * rows] = a[i * n + j];
            }
        }
        status = solve(context, memory, rows, n, memory + rows * n, pivots, memory + rows * n + n,
                       b, columns, x, rank, condition);
    }
    free(pivots);
    free(memory);
    return status;
}

gonio_status gonio_i_take_farthest(gonio_context *context, double *a, size_t rows, size_t n,
                                   size_t step, size_t *farthest)
{
    const gonio_status status = check_size(context, rows, n);
    if (status != GONIO_OK) {
        return status;
    }
    double longest = 0.0;
    for (size_t i = 0; i < rows; i++) {
        const double length = cblas_dnrm2((int)n, a + i * n, 1);
        if (length > longest) {
            longest = length;
            *farthest = i;
        }
    }
    double *direction = gonio_i_allocate(context, n, sizeof *direction);
    if (direction == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    if (longest < 1e-14) {
        free(direction);
        return gonio_i_fail(context, GONIO_ERROR_DATA,
                            "the rows of the basis span only %zu of %zu dimensions", step, n);
    }
    for (size_t j = 0; j < n; j++) {
        direction[j] = a[*farthest * n + j] / longest;
    }
    for (size_t i = 0; i < rows; i++) {
        const double along = cblas_ddot((int)n, a + i * n, 1, direction, 1);
        cblas_daxpy((int)n, -along, direction, 1, a + i * n, 1);
    }
    free(direction);
    return GONIO_OK;
}
