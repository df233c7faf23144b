/* The remainder's covariance as a product of few columns: see remainder.h. */
#include "remainder.h"

#include <math.h>
#include <stdlib.h>

#include "../linalg/linalg.h"

/* Variance that is not looked at any more: single precision would make it up. */
static const double NEGLIGIBLE = 1e-6;

typedef struct factor {
    gonio_context *context;
    const gonio_i_remainder_size *size;
    size_t rows;
    size_t leading;
    float *g;
    gonio_i_place *place; /* [rows] */
    double *left;         /* [rows]: variance that the columns so far leave */
} factor;

GONIO_I_VECTORISED static double dot(const float *a, const float *b, size_t n)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++) {
        sum += (double)a[i] * (double)b[i];
    }
    return sum;
}

static double covariance(const gonio_i_remainder_size *size, const gonio_i_place *a,
                         const gonio_i_place *b)
{
    return size->deviation * size->deviation * gonio_i_remainder(a, b, size->peak);
}

static size_t largest(const double *value, size_t count)
{
    size_t at = 0;
    for (size_t i = 1; i < count; i++) {
        at = value[i] > value[at] ? i : at;
    }
    return at;
}

/* The next column: the covariance with the row that is known least, without what the columns before
 * have of it. */
static void fill_column(factor *f, size_t column)
{
    const size_t pivot = largest(f->left, f->rows);
    const double variance = f->left[pivot];
    const float *at_pivot = f->g + pivot * f->leading;
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(f->context))
    for (size_t i = 0; i < f->rows; i++) {
        float *g = f->g + i * f->leading;
        g[column] = 0.0f;
        if (f->left[i] > NEGLIGIBLE) {
            const double rest =
                covariance(f->size, &f->place[i], &f->place[pivot]) - dot(g, at_pivot, column);
            g[column] = (float)(rest / sqrt(variance));
            f->left[i] = i == pivot ? 0.0 : fmax(f->left[i] - rest * rest / variance, 0.0);
        }
    }
}

gonio_status gonio_i_remainder_columns(gonio_context *context, const gonio_i_remainder_size *size,
                                       const gonio_half_difference *at, const bool *allowed,
                                       size_t rows, size_t leading, float *g)
{
    factor f = {.context = context,
                .size = size,
                .rows = rows,
                .leading = leading,
                .g = g,
                .place = gonio_i_allocate(context, rows, sizeof *f.place),
                .left = gonio_i_allocate(context, rows, sizeof *f.left)};
    const bool done = f.place != NULL && f.left != NULL;
    for (size_t i = 0; i < rows && done; i++) {
        f.place[i] = gonio_i_place_of(at[i]);
        f.left[i] = allowed[i] ? covariance(size, &f.place[i], &f.place[i]) : 0.0;
    }
    for (size_t column = 0; column < size->columns && done; column++) {
        fill_column(&f, column);
    }
    free(f.place);
    free(f.left);
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}
