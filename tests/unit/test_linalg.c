/* Linear algebra by certificates: residuals, orthogonality, known solutions. */
#include "../support.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/random.h"
#include "linalg/linalg.h"

enum { ROWS = 40, N = 6 };

static void fill(double *values, size_t count, uint64_t seed)
{
    gonio_i_random random;
    gonio_i_random_seed(&random, seed, 0);
    for (size_t k = 0; k < count; k++) {
        values[k] = gonio_i_random_normal(&random);
    }
}

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

/* (A'B)[i][j] of row-major matrices with rows `leading` values apart. */
static double inner(const double *a, size_t i, const double *b, size_t j, size_t rows,
                    size_t leading)
{
    double sum = 0.0;
    for (size_t r = 0; r < rows; r++) {
        sum += a[r * leading + i] * b[r * leading + j];
    }
    return sum;
}

static void test_least_squares_finds_a_known_solution(void **state)
{
    (void)state;
    double a[ROWS * N], x[2 * N], b[2 * ROWS], found[2 * N];
    size_t rank = 0;
    double condition = 0.0;
    fill(a, ROWS * N, 1);
    fill(x, 2 * N, 2);
    for (size_t column = 0; column < 2; column++) {
        for (size_t i = 0; i < ROWS; i++) {
            b[column * ROWS + i] = 0.0;
            for (size_t k = 0; k < N; k++) {
                b[column * ROWS + i] += a[i * N + k] * x[column * N + k];
            }
        }
    }
    assert_int_equal(gonio_i_least_squares(NULL, a, ROWS, N, b, 2, found, &rank, &condition),
                     GONIO_OK);
    assert_int_equal(rank, N);
    for (size_t k = 0; k < 2 * N; k++) {
        assert_close(found[k], x[k], 1e-13);
    }
}

/* The residual of a least-squares solution is orthogonal to the columns. */
static void test_least_squares_residual_is_orthogonal(void **state)
{
    (void)state;
    double a[ROWS * N], b[ROWS], x[N];
    size_t rank = 0;
    double condition = 0.0;
    fill(a, ROWS * N, 3);
    fill(b, ROWS, 4);
    assert_int_equal(gonio_i_least_squares(NULL, a, ROWS, N, b, 1, x, &rank, &condition), GONIO_OK);
    for (size_t j = 0; j < N; j++) {
        double sum = 0.0;
        for (size_t i = 0; i < ROWS; i++) {
            double residual = -b[i];
            for (size_t k = 0; k < N; k++) {
                residual += a[i * N + k] * x[k];
            }
            sum += a[i * N + j] * residual;
        }
        assert_close(sum, 0.0, 1e-12);
    }
}

static void test_condition_is_that_of_the_normal_matrix(void **state)
{
    (void)state;
    const double a[4 * 2] = {3.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0};
    const double b[4] = {3.0, 1.0, 9.0, 9.0};
    double x[2];
    size_t rank = 0;
    double condition = 0.0;
    assert_int_equal(gonio_i_least_squares(NULL, a, 4, 2, b, 1, x, &rank, &condition), GONIO_OK);
    assert_close(condition, 36.0, 1e-12);
    assert_close(x[0], 1.0, 1e-15);
    assert_close(x[1], 2.0, 1e-15);
}

static void test_rank_is_found(void **state)
{
    (void)state;
    double a[ROWS * N], b[ROWS], x[N] = {7.0};
    size_t rank = 99;
    double condition = 0.0;
    fill(a, ROWS * N, 5);
    fill(b, ROWS, 6);
    for (size_t i = 0; i < ROWS; i++) {
        a[i * N + 3] = a[i * N] - 2.0 * a[i * N + 5];
    }
    assert_int_equal(gonio_i_least_squares(NULL, a, ROWS, N, b, 1, x, &rank, &condition), GONIO_OK);
    assert_int_equal(rank, N - 1);
    assert_true(isinf(condition));
    assert_true(x[0] == 7.0);
    assert_int_equal(gonio_i_least_squares(NULL, a, 4, N, b, 1, x, &rank, &condition), GONIO_OK);
    assert_int_equal(rank, 4);
    memset(a, 0, sizeof a);
    assert_int_equal(gonio_i_least_squares(NULL, a, ROWS, N, b, 1, x, &rank, &condition), GONIO_OK);
    assert_int_equal(rank, 0);
}

static void test_eigenvectors(void **state)
{
    (void)state;
    double a[ROWS * N], c[N * N], v[N * N], values[N], alone[N];
    fill(a, ROWS * N, 7);
    assert_int_equal(gonio_i_gram_rows(NULL, a, ROWS, N, N, c), GONIO_OK);
    memcpy(v, c, sizeof v);
    assert_int_equal(gonio_i_eigen(NULL, v, N, true, values), GONIO_OK);
    for (size_t j = 0; j < N; j++) {
        assert_true(j == 0 || values[j] >= values[j - 1]);
        for (size_t i = 0; i < N; i++) {
            double product = 0.0;
            double overlap = 0.0;
            for (size_t k = 0; k < N; k++) {
                product += c[i * N + k] * v[j * N + k];
                overlap += v[i * N + k] * v[j * N + k];
            }
            assert_close(product, values[j] * v[j * N + i], 1e-12 * values[N - 1]);
            assert_close(overlap, i == j ? 1.0 : 0.0, 1e-14);
        }
    }
    assert_int_equal(gonio_i_eigen(NULL, c, N, false, alone), GONIO_OK);
    for (size_t j = 0; j < N; j++) {
        assert_close(alone[j], values[j], 1e-12 * values[N - 1]);
    }
}

static void test_products(void **state)
{
    (void)state;
    enum { LEADING = N + 2 };
    double a[ROWS * LEADING], gram[N * N], columns[N * ROWS], same[N * N];
    double b[N * 2], product[ROWS * 2], wide[ROWS * LEADING];
    fill(a, ROWS * LEADING, 8);
    fill(b, N * 2, 9);
    for (size_t i = 0; i < ROWS; i++) {
        for (size_t j = 0; j < N; j++) {
            columns[j * ROWS + i] = a[i * LEADING + j];
        }
    }
    assert_int_equal(gonio_i_gram_rows(NULL, a, ROWS, N, LEADING, gram), GONIO_OK);
    memset(same, 0, sizeof same);
    assert_int_equal(gonio_i_add_gram_columns(NULL, columns, ROWS, N, same), GONIO_OK);
    assert_int_equal(gonio_i_add_gram_columns(NULL, columns, ROWS, N, same), GONIO_OK);
    gonio_i_mirror(same, N);
    for (size_t k = 0; k < (size_t)N * N; k++) {
        assert_close(gram[k], inner(a, k / N, a, k % N, ROWS, LEADING), 1e-12);
        assert_close(same[k], 2.0 * gram[k], 1e-12);
    }
    assert_int_equal(gonio_i_product_columns(NULL, columns, ROWS, N, b, 2, product), GONIO_OK);
    memset(wide, 0, sizeof wide);
    assert_int_equal(gonio_i_product_transposed(NULL, product, ROWS, 2, b, N, wide, LEADING),
                     GONIO_OK);
    for (size_t i = 0; i < ROWS; i++) {
        for (size_t j = 0; j < 2; j++) {
            double sum = 0.0;
            for (size_t k = 0; k < N; k++) {
                sum += a[i * LEADING + k] * b[k * 2 + j];
            }
            assert_close(product[i * 2 + j], sum, 1e-13);
        }
        for (size_t j = 0; j < N; j++) {
            const double sum = product[i * 2] * b[j * 2] + product[i * 2 + 1] * b[j * 2 + 1];
            assert_close(wide[i * LEADING + j], sum, 1e-13);
        }
        assert_true(wide[i * LEADING + N] == 0.0);
    }
    /* Rows that lie further apart than they are long. */
    double turned[2 * N], again[ROWS * 2];
    for (size_t k = 0; k < 2 * N; k++) {
        turned[k] = b[k % N * 2 + k / N];
    }
    assert_int_equal(gonio_i_product_rows(NULL, a, ROWS, N, LEADING, turned, 2, again), GONIO_OK);
    for (size_t k = 0; k < ROWS * 2; k++) {
        assert_close(again[k], product[k], 1e-13);
    }
}

static void test_dividing_by_cholesky_makes_columns_orthonormal(void **state)
{
    (void)state;
    double a[ROWS * N], c[N * N] = {0.0};
    fill(a, ROWS * N, 10);
    assert_int_equal(gonio_i_add_gram_rows(NULL, a, ROWS, N, c), GONIO_OK);
    gonio_i_mirror(c, N);
    assert_int_equal(gonio_i_cholesky(NULL, c, N), GONIO_OK);
    gonio_i_divide_triangle(a, ROWS, N, c);
    for (size_t k = 0; k < (size_t)N * N; k++) {
        assert_close(inner(a, k / N, a, k % N, ROWS, N), k % (N + 1) == 0 ? 1.0 : 0.0, 1e-14);
    }
}

static void test_a_matrix_that_is_not_positive_is_an_error(void **state)
{
    (void)state;
    double c[4] = {1.0, 2.0, 2.0, 1.0};
    gonio_context *context = support_context();
    assert_int_equal(gonio_i_cholesky(context, c, 2), GONIO_ERROR_NUMERICAL);
    assert_non_null(strstr(support_message(), "dpotrf"));
    gonio_context_free(&context);
}

static void test_farthest_rows_span_the_space(void **state)
{
    (void)state;
    double a[ROWS * N];
    size_t farthest[N] = {0};
    fill(a, ROWS * N, 11);
    for (size_t i = 0; i < ROWS; i++) {
        a[i * N + N - 1] = a[i * N]; /* one dimension less */
    }
    for (size_t step = 0; step < N - 1; step++) {
        assert_int_equal(gonio_i_take_farthest(NULL, a, ROWS, N, step, &farthest[step]), GONIO_OK);
        assert_close(inner(a + farthest[step] * N, 0, a + farthest[step] * N, 0, 1, N), 0.0, 1e-28);
        for (size_t k = 0; k < step; k++) {
            assert_int_not_equal(farthest[k], farthest[step]);
        }
    }
    gonio_context *context = support_context();
    assert_int_equal(gonio_i_take_farthest(context, a, ROWS, N, N - 1, &farthest[N - 1]),
                     GONIO_ERROR_DATA);
    gonio_context_free(&context);
}

/* What is above the diagonal has no say. */
static void test_multiplying_by_a_lower_triangle(void **state)
{
    (void)state;
    const double l[] = {2.0, NAN, NAN, -1.0, 3.0, NAN, 0.5, 4.0, -2.0};
    double a[] = {1.0, 2.0, 3.0, -4.0, 0.0, 2.0};
    const double product[] = {1.5, 18.0, -6.0, -7.0, 8.0, -4.0};
    gonio_i_multiply_lower(a, 2, 3, l);
    for (int i = 0; i < 6; i++) {
        assert_true(fabs(a[i] - product[i]) < 1e-15);
    }
}

static void test_the_diagonal_of_an_inverse(void **state)
{
    (void)state;
    const double l[] = {2.0, 0.0, 1.0, 3.0}; /* of (4 2; 2 10) */
    double diagonal[2];
    assert_int_equal(gonio_i_inverse_diagonal(NULL, l, 2, diagonal), GONIO_OK);
    assert_true(fabs(diagonal[0] - 10.0 / 36.0) < 1e-15);
    assert_true(fabs(diagonal[1] - 4.0 / 36.0) < 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_least_squares_finds_a_known_solution),
        cmocka_unit_test(test_least_squares_residual_is_orthogonal),
        cmocka_unit_test(test_condition_is_that_of_the_normal_matrix),
        cmocka_unit_test(test_rank_is_found),
        cmocka_unit_test(test_eigenvectors),
        cmocka_unit_test(test_products),
        cmocka_unit_test(test_dividing_by_cholesky_makes_columns_orthonormal),
        cmocka_unit_test(test_multiplying_by_a_lower_triangle),
        cmocka_unit_test(test_the_diagonal_of_an_inverse),
        cmocka_unit_test(test_a_matrix_that_is_not_positive_is_an_error),
        cmocka_unit_test(test_farthest_rows_span_the_space),
    };
    return cmocka_run_group_tests_name("linalg", tests, NULL, NULL);
}
