/* Rows in the eigenbasis of G: see rotated_rows.h. */
#include "rotated_rows.h"

#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

/* The most values that are kept: 32 MB. */
enum { MOST_KEPT = 1 << 22 };

/* Components of z that are summed together: as many as registers hold. */
enum { ROTATED = 32, VECTOR = 8 };

typedef enum extent { IN_PART, WHOLE } extent;

struct rotated {
    uint64_t basis; /* counted from 1 */
    extent extent;
};

static size_t stride_of(size_t k)
{
    return (k + VECTOR - 1) / VECTOR * VECTOR;
}

static double *aligned_doubles(gonio_context *context, size_t count)
{
    const size_t size = (count + VECTOR - 1) / VECTOR * VECTOR * sizeof(double);
    double *made = aligned_alloc(VECTOR * sizeof(double), size);
    if (made == NULL) {
        gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    return memset(made, 0, size);
}

bool gonio_i_rotated_rows_allocate(const gonio_i_selection_problem *problem,
                                   gonio_i_rotated_rows *t)
{
    const size_t k = problem->components;
    *t = (gonio_i_rotated_rows){.problem = problem, .stride = stride_of(k)};
    t->columns = aligned_doubles(problem->context, k * t->stride);
    t->leading = gonio_i_allocate(problem->context, k, sizeof *t->leading);
    const bool keep = problem->rows <= MOST_KEPT / k;
    if (keep) {
        t->kept = aligned_doubles(problem->context, problem->rows * t->stride);
        t->state = gonio_i_allocate(problem->context, problem->rows, sizeof *t->state);
    }
    return t->columns != NULL && t->leading != NULL &&
           (!keep || (t->kept != NULL && t->state != NULL));
}

void gonio_i_rotated_rows_free(gonio_i_rotated_rows *t)
{
    free(t->columns);
    free(t->leading);
    free(t->kept);
    free(t->state);
}

double *gonio_i_rotated_rows_scratch(const gonio_i_selection_problem *problem)
{
    return aligned_doubles(problem->context,
                           GONIO_I_ROTATED_TOGETHER * stride_of(problem->components));
}

void gonio_i_rotated_rows_set(gonio_i_rotated_rows *t, const double *q)
{
    const size_t k = t->problem->components;
    for (size_t j = 0; j < k; j++) {
        for (size_t a = 0; a < k; a++) {
            t->columns[a * t->stride + j] = q[j * k + a];
        }
    }
    memcpy(t->leading, q + (k - 1) * k, k * sizeof *q);
    t->bases++;
}

/* ---- products ---- */

/* ROTATED components of z = Q'u, at z and q; rows of q are `stride` apart. */
GONIO_I_VECTORISED static void rotate_many(size_t k, size_t stride, const double *q,
                                           const double *u, double *z)
{
    double sum[ROTATED] = {0.0};
    for (size_t a = 0; a < k; a++) {
        for (size_t j = 0; j < ROTATED; j++) {
            sum[j] += u[a] * q[a * stride + j];
        }
    }
    memcpy(z, sum, sizeof sum);
}

/* The same for two rows, so that q is loaded once. */
GONIO_I_VECTORISED static void rotate_two(size_t k, size_t stride, const double *q, const double *u,
                                          const double *v, double *y, double *z)
{
    double sum[ROTATED] = {0.0};
    double other[ROTATED] = {0.0};
    for (size_t a = 0; a < k; a++) {
        for (size_t j = 0; j < ROTATED; j++) {
            sum[j] += u[a] * q[a * stride + j];
            other[j] += v[a] * q[a * stride + j];
        }
    }
    memcpy(y, sum, sizeof sum);
    memcpy(z, other, sizeof other);
}

/* All of z = Q'u for fewer than ROTATED components. */
GONIO_I_VECTORISED static void rotate_few(size_t k, size_t stride, const double *restrict q,
                                          const double *u, double *restrict z)
{
    memset(z, 0, stride * sizeof *z);
    for (size_t a = 0; a < k; a++) {
        for (size_t j = 0; j < stride; j++) {
            z[j] += u[a] * q[a * stride + j];
        }
    }
}

/* The components of z from `from` on (0 or ROTATED). The last block overlaps the one before; the
 * common components are computed twice, with the same result. */
static void rotate(const gonio_i_rotated_rows *t, size_t row, size_t from, double *z)
{
    const size_t k = t->problem->components;
    const double *u = gonio_i_row(t->problem, row);
    if (t->stride < ROTATED) {
        rotate_few(k, t->stride, t->columns, u, z);
        return;
    }
    for (size_t j = from; j < t->stride; j += ROTATED) {
        const size_t first = j + ROTATED < t->stride ? j : t->stride - ROTATED;
        rotate_many(k, t->stride, t->columns + first, u, z + first);
    }
}

/* ---- rows ---- */

static double *place_of(const gonio_i_rotated_rows *t, size_t row, double *z)
{
    return t->kept != NULL ? t->kept + row * t->stride : z;
}

static bool is_there(const gonio_i_rotated_rows *t, size_t row, extent much)
{
    return t->kept != NULL && t->state[row].basis == t->bases && t->state[row].extent >= much;
}

static void mark(const gonio_i_rotated_rows *t, size_t row, extent much)
{
    if (t->kept != NULL) {
        t->state[row] = (struct rotated){t->bases, much};
    }
}

const double *gonio_i_rotated_row(const gonio_i_rotated_rows *t, size_t row, double *z)
{
    double *made = place_of(t, row, z);
    if (!is_there(t, row, WHOLE)) {
        rotate(t, row, is_there(t, row, IN_PART) && t->stride > ROTATED ? ROTATED : 0, made);
        mark(t, row, WHOLE);
    }
    return made;
}

void gonio_i_rotated_rows_begin(const gonio_i_rotated_rows *t, const size_t *rows, size_t count,
                                double *scratch, gonio_i_rotated_rows_candidate *candidates)
{
    const size_t k = t->problem->components;
    const bool whole = t->stride <= ROTATED;
    const gonio_i_rotated_rows_candidate *missing[GONIO_I_ROTATED_TOGETHER];
    size_t wanted = 0;
    for (size_t i = 0; i < count; i++) {
        double *z = place_of(t, rows[i], scratch + i * t->stride);
        candidates[i] = (gonio_i_rotated_rows_candidate){rows[i], whole ? k : ROTATED, z};
        if (whole) {
            gonio_i_rotated_row(t, rows[i], z);
        } else if (!is_there(t, rows[i], IN_PART)) {
            z[k - 1] = gonio_i_dot(t->leading, gonio_i_row(t->problem, rows[i]), k);
            mark(t, rows[i], IN_PART);
            missing[wanted++] = &candidates[i];
        }
    }
    const gonio_i_selection_problem *p = t->problem;
    if (wanted == GONIO_I_ROTATED_TOGETHER) {
        rotate_two(k, t->stride, t->columns, gonio_i_row(p, missing[0]->row),
                   gonio_i_row(p, missing[1]->row), missing[0]->z, missing[1]->z);
    } else if (wanted == 1) {
        rotate_many(k, t->stride, t->columns, gonio_i_row(p, missing[0]->row), missing[0]->z);
    }
}
