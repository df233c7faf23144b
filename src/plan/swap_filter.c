/* The filter of the condition-number search: see swap_filter.h. */
#include "swap_filter.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

static const double unit = FLT_EPSILON / 2.0; /* of rounding */

static bool allocate_scratch(gonio_i_swap_filter *f)
{
    f->scratch = gonio_i_allocate(f->problem->context, (size_t)f->threads, sizeof *f->scratch);
    bool failed = f->scratch == NULL;
    for (int t = 0; t < f->threads && !failed; t++) {
        f->scratch[t] = gonio_i_packed_rows_scratch(f->packed, &failed);
    }
    return !failed;
}

bool gonio_i_swap_filter_allocate(const gonio_i_selection_problem *problem,
                                  const gonio_i_packed_rows *packed, int threads,
                                  gonio_i_swap_filter *f)
{
    gonio_context *context = problem->context;
    const size_t k = problem->components;
    const size_t padded = packed->components;
    const size_t chunks = gonio_i_packed_rows_chunks(packed);
    *f = (gonio_i_swap_filter){.problem = problem, .packed = packed, .threads = threads};
    f->root = gonio_i_allocate(context, k * k, sizeof *f->root);
    f->t = gonio_i_allocate(context, padded * padded, sizeof *f->t);
    f->image = gonio_i_allocate(context, 2 * k, sizeof *f->image);
    f->columns = gonio_i_allocate(context, padded * GONIO_I_BATCH, sizeof *f->columns);
    f->gain = gonio_i_allocate(context, packed->rows, sizeof *f->gain);
    f->pass = gonio_i_allocate(context, GONIO_I_BATCH * packed->rows, 1);
    f->gain_is_set = gonio_i_allocate(context, chunks, sizeof *f->gain_is_set);
    f->batch_is_set = gonio_i_allocate(context, chunks, sizeof *f->batch_is_set);
    return allocate_scratch(f) && f->root != NULL && f->t != NULL && f->image != NULL &&
           f->columns != NULL && f->gain != NULL && f->pass != NULL && f->gain_is_set != NULL &&
           f->batch_is_set != NULL;
}

void gonio_i_swap_filter_free(gonio_i_swap_filter *f)
{
    for (int t = 0; f->scratch != NULL && t < f->threads; t++) {
        free(f->scratch[t]);
    }
    free(f->scratch);
    free(f->root);
    free(f->t);
    free(f->image);
    free(f->columns);
    free(f->gain);
    free(f->pass);
    free(f->gain_is_set);
    free(f->batch_is_set);
}

/* The error bound of a product u'c with |u| = |c| = 1: of the sum, and of rounding u and c. */
static double product_error(const gonio_i_swap_filter *f)
{
    return ((double)f->packed->components + 4.0) * unit * 1.001;
}

/* T = L^-1 of G - mu = L L', and its copy for the gains. */
void gonio_i_swap_filter_set(gonio_i_swap_filter *f, const double *gram, double mu,
                             double condition)
{
    const size_t k = f->problem->components;
    const size_t padded = f->packed->components;
    memcpy(f->root, gram, k * k * sizeof *f->root);
    for (size_t a = 0; a < k; a++) {
        f->root[a * k + a] -= mu;
    }
    f->relative = 8.0 * (double)k * DBL_EPSILON * condition;
    f->blind = !(f->relative < 0.1) || gonio_i_inverse_cholesky(NULL, f->root, k) != GONIO_OK;
    double squares = 0.0;
    for (size_t a = 0; a < k; a++) {
        for (size_t b = 0; b <= a; b++) {
            f->t[b * padded + a] = (float)f->root[a * k + b];
            squares += f->root[a * k + b] * f->root[a * k + b];
        }
    }
    f->gain_margin = (float)(product_error(f) * sqrt(squares));
    memset(f->gain_is_set, 0, gonio_i_packed_rows_chunks(f->packed) * sizeof *f->gain_is_set);
    f->batch = 0;
    f->next = 1;
}

/* Bv = T'(T v); returns v'Bv = |T v|^2. */
GONIO_I_VECTORISED static double apply(size_t k, const double *restrict root, const double *v,
                                       double *restrict tv, double *restrict bv)
{
    double squares = 0.0;
    memset(bv, 0, k * sizeof *bv);
    for (size_t a = 0; a < k; a++) {
        double sum = 0.0;
        for (size_t b = 0; b <= a; b++) {
            sum += root[a * k + b] * v[b];
        }
        tv[a] = sum;
        squares += sum * sum;
    }
    for (size_t a = 0; a < k; a++) {
        for (size_t b = 0; b <= a; b++) {
            bv[b] += root[a * k + b] * tv[a];
        }
    }
    return squares;
}

/* Bv of the j-th position of the batch as a column in single precision, with its loss and margin.
 */
static void fill_column(gonio_i_swap_filter *f, const double *v, size_t j)
{
    const size_t k = f->problem->components;
    gonio_i_test *test = &f->tests[j / GONIO_I_COLUMNS];
    const size_t column = j % GONIO_I_COLUMNS;
    float *c = f->columns + j / GONIO_I_COLUMNS * GONIO_I_COLUMNS * f->packed->components;
    double *bv = f->image + k;
    const double loss = apply(k, f->root, v, f->image, bv) - 1.0;
    double squares = 0.0;
    for (size_t a = 0; a < k; a++) {
        c[a * test->columns + column] = (float)bv[a];
        squares += bv[a] * bv[a];
    }
    test->c = c;
    const double least = loss - f->relative * (2.0 + loss);
    const double root = sqrt(fmax(least, 0.0)) - f->relative * sqrt(2.0 + loss);
    f->all_pass[j] = f->blind || loss < 1e-6 || root < 5e-4;
    test->loss[column] = (float)(root * root * (1.0 - f->relative) * (1.0 - 1e-6));
    test->margin[column] = (float)(product_error(f) * sqrt(squares));
}

void gonio_i_swap_filter_set_position(gonio_i_swap_filter *f, const double *x, size_t position)
{
    const size_t k = f->problem->components;
    if (position >= f->first && position < f->first + f->batch) {
        return;
    }
    const size_t rest = f->problem->count - position;
    const size_t columns = f->next == 1 ? 1 : GONIO_I_COLUMNS;
    f->first = position;
    f->batch = rest < f->next ? rest : f->next;
    /* With many chunks, loading them takes longer than tests that a swap makes useless. */
    const bool many = gonio_i_packed_rows_chunks(f->packed) >= 64;
    f->next = many && f->next > 1 ? GONIO_I_BATCH : GONIO_I_COLUMNS;
    memset(f->columns, 0, f->packed->components * GONIO_I_BATCH * sizeof *f->columns);
    for (size_t j = 0; j < f->batch; j += columns) {
        f->tests[j / GONIO_I_COLUMNS] = (gonio_i_test){.columns = columns};
    }
    for (size_t j = 0; j < f->batch; j++) {
        fill_column(f, x + (position + j) * k, j);
    }
    memset(f->batch_is_set, 0, gonio_i_packed_rows_chunks(f->packed) * sizeof *f->batch_is_set);
}

static void set_gain(gonio_i_swap_filter *f, const gonio_i_chunk *chunk, size_t index)
{
    if (!f->gain_is_set[index]) {
        gonio_i_chunk_gain(chunk, f->t, f->gain_margin, f->gain + chunk->first);
        f->gain_is_set[index] = true;
    }
}

void gonio_i_swap_filter_prepare(gonio_i_swap_filter *f, size_t index, int thread)
{
    const gonio_i_chunk chunk = gonio_i_packed_rows_chunk(f->packed, index, f->scratch[thread]);
    set_gain(f, &chunk, index);
}

/* Tests a chunk's rows at the positions of the batch, unless that is done. */
static void look_at(gonio_i_swap_filter *f, size_t index, int thread)
{
    if (f->blind || f->batch_is_set[index]) {
        return;
    }
    const gonio_i_chunk chunk = gonio_i_packed_rows_chunk(f->packed, index, f->scratch[thread]);
    set_gain(f, &chunk, index);
    for (size_t j = 0; j < f->batch; j += GONIO_I_COLUMNS) {
        gonio_i_test test = f->tests[j / GONIO_I_COLUMNS];
        test.gain = f->gain + chunk.first;
        gonio_i_chunk_mark(&chunk, &test, f->pass + j * f->packed->rows + chunk.first,
                           f->packed->rows);
    }
    f->batch_is_set[index] = true;
}

size_t gonio_i_swap_filter_survivors(gonio_i_swap_filter *f, size_t position, size_t first,
                                     size_t last, int thread, size_t *survivors)
{
    const size_t j = position - f->first;
    const unsigned char *pass = f->pass + j * f->packed->rows;
    size_t count = 0;
    look_at(f, first / GONIO_I_CHUNK, thread);
    for (size_t u = first; u < last; u++) {
        survivors[count] = u;
        count += f->all_pass[j] || pass[u];
    }
    return count;
}
