/* The covariance after readings: see after_readings.h. */
#include "after_readings.h"

#include <stdlib.h>

#include "../linalg/linalg.h"

/* b = f' L'^-1 [k][n], L L' = f f' + variance I; s: scratch, [n][n]. */
static gonio_status explain(gonio_context *context, const double *f, size_t n, size_t k,
                            double variance, double *s, double *b)
{
    gonio_status status = gonio_i_product_transposed(context, f, n, k, f, n, s, n);
    for (size_t i = 0; i < n; i++) {
        s[i * n + i] += variance;
        for (size_t j = 0; j < k; j++) {
            b[j * n + i] = f[i * k + j];
        }
    }
    if (status == GONIO_OK) {
        status = gonio_i_cholesky(context, s, n);
    }
    if (status == GONIO_OK) {
        gonio_i_divide_triangle(b, k, n, s);
    }
    return status;
}

gonio_status gonio_i_covariance_after(gonio_context *context, const double *f, size_t n, size_t k,
                                      double variance, double *covariance)
{
    double *s = gonio_i_allocate(context, n * n, sizeof *s);
    double *b = gonio_i_allocate(context, k * n, sizeof *b);
    gonio_status status =
        s == NULL || b == NULL ? GONIO_ERROR_MEMORY : explain(context, f, n, k, variance, s, b);
    if (status == GONIO_OK) {
        status = gonio_i_product_transposed(context, b, k, n, b, k, covariance, k);
    }
    for (size_t i = 0; i < k * k && status == GONIO_OK; i++) {
        covariance[i] = (i % (k + 1) == 0 ? 1.0 : 0.0) - covariance[i];
    }
    free(s);
    free(b);
    return status;
}
