/* The condition-number search against the plain algorithm: every swap decided by LAPACK. */
#include "../support.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/plan.h>
#include <lapacke.h>

#include "core/random.h"
#include "plan/exchange_eigenvalues.h"

/* kappa of X'X by LAPACK alone. */
static double plain_condition(const double *v, size_t k, const size_t *chosen, size_t n)
{
    double *g = calloc(k * k + k, sizeof *g);
    for (size_t j = 0; j < n; j++) {
        const double *x = v + chosen[j] * k;
        for (size_t a = 0; a < k; a++) {
            for (size_t b = 0; b < k; b++) {
                g[a * k + b] += x[a] * x[b];
            }
        }
    }
    assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', (int)k, g, (int)k, g + k * k), 0);
    const double kappa = g[k * k] > 0.0 ? g[k * k + k - 1] / g[k * k] : INFINITY;
    free(g);
    return kappa;
}

static bool holds(const size_t *chosen, size_t n, size_t row)
{
    for (size_t j = 0; j < n; j++) {
        if (chosen[j] == row) {
            return true;
        }
    }
    return false;
}

/* The lowest kappa that one swap reaches. */
static double best_single_swap(const double *v, size_t rows, size_t k, const size_t *chosen,
                               size_t n)
{
    size_t *trial = malloc(n * sizeof *trial);
    double best = INFINITY;
    memcpy(trial, chosen, n * sizeof *trial);
    for (size_t j = 0; j < n; j++) {
        for (size_t row = 0; row < rows; row++) {
            if (!holds(chosen, n, row)) {
                trial[j] = row;
                best = fmin(best, plain_condition(v, k, trial, n));
            }
        }
        trial[j] = chosen[j];
    }
    free(trial);
    return best;
}

/* Rows like a basis's: lengths over three decades, leading components stronger. */
static double *make_rows(size_t rows, size_t k, uint64_t seed)
{
    gonio_i_random random;
    gonio_i_random_seed(&random, seed, 1);
    double *v = malloc(rows * k * sizeof *v);
    for (size_t i = 0; i < rows; i++) {
        const double length = exp(-3.0 * gonio_i_random_uniform(&random));
        for (size_t j = 0; j < k; j++) {
            v[i * k + j] = length * gonio_i_random_normal(&random) / (1.0 + (double)j);
        }
    }
    return v;
}

static void test_local_optimum(void **state)
{
    (void)state;
    static const struct {
        size_t rows, k, n;
    } cases[] = {{60, 2, 2},   {60, 2, 5}, {120, 5, 5}, {120, 5, 12},
                 {200, 8, 20}, {90, 1, 3}, {12, 3, 12}, {110000, 3, 4}}; /* searched in rounds */
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        const bool one = cases[c].rows > 1000 || support_small();
        for (uint64_t seed = 0; seed < (one ? 1 : 4); seed++) {
            const size_t rows = cases[c].rows, k = cases[c].k, n = cases[c].n;
            double *v = make_rows(rows, k, seed);
            size_t chosen[32];
            gonio_selection_report report;
            gonio_plan_options options;
            gonio_plan_options_default(&options);
            options.count = n;
            options.restarts = 2;
            options.seed = seed;
            assert_int_equal(gonio_plan_select(NULL, v, rows, k, k, &options, chosen, &report),
                             GONIO_OK);
            const double kappa = report.condition_number;
            assert_true(fabs(kappa - plain_condition(v, k, chosen, n)) <= 1e-9 * kappa);
            assert_true(best_single_swap(v, rows, k, chosen, n) >= kappa * (1.0 - 1e-9));
            double lowest = INFINITY;
            for (size_t s = 0; s < report.steps; s++) {
                if (report.history[s].swap > 0) {
                    assert_true(report.history[s].condition_number <
                                report.history[s - 1].condition_number);
                }
                lowest = fmin(lowest, report.history[s].condition_number);
            }
            assert_true(lowest == kappa);
            free(report.history);
            free(v);
        }
    }
}

/* The paper's algorithm with LAPACK for every test, in the order that condition.c documents.
 * Returns the number of swaps; kappas[swap] as they went. */
static size_t plain_search(const double *v, size_t rows, size_t k, size_t n, uint64_t seed,
                           size_t *chosen, double *kappas, size_t most)
{
    gonio_i_random random;
    unsigned char *used = calloc(rows, 1);
    gonio_i_random_seed(&random, seed, 0);
    gonio_i_random_subset(&random, rows, n, used, chosen);
    free(used);
    gonio_i_random_seed(&random, seed, 1);
    size_t swaps = 0;
    kappas[0] = plain_condition(v, k, chosen, n);
    for (size_t idle = 0, position = 0; idle < n || position != 0; position = (position + 1) % n) {
        idle = position == 0 ? 0 : idle; /* turns are counted whole */
        const size_t from = (size_t)gonio_i_random_below(&random, rows);
        const size_t old = chosen[position];
        bool won = false;
        for (size_t j = 0; j < rows && !won; j++) {
            const size_t row = (from + j) % rows;
            if (!holds(chosen, n, row)) {
                chosen[position] = row;
                const double kappa = plain_condition(v, k, chosen, n);
                won = kappa < kappas[swaps] * (1.0 - 1e-10);
                if (won) {
                    assert_true(swaps + 1 < most);
                    kappas[++swaps] = kappa;
                } else {
                    chosen[position] = old;
                }
            }
        }
        idle += won ? 0 : 1;
    }
    return swaps;
}

static int compare_rows(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a;
    const size_t y = *(const size_t *)b;
    return (x > y) - (x < y);
}

/* The fast search makes the very swaps of the plain one. */
static void test_same_swaps(void **state)
{
    (void)state;
    static const struct {
        size_t rows, k, n;
    } cases[] = {{100, 2, 4}, {150, 4, 6}, {150, 6, 6}, {300, 7, 16}, {200, 12, 24}};
    enum { MOST = 2000 };
    double *kappas = malloc(MOST * sizeof *kappas);
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        for (uint64_t seed = 10; seed < (support_small() ? 11 : 14); seed++) {
            const size_t rows = cases[c].rows, k = cases[c].k, n = cases[c].n;
            double *v = make_rows(rows, k, seed);
            size_t plain[32];
            size_t fast[32];
            const size_t swaps = plain_search(v, rows, k, n, seed, plain, kappas, MOST);
            gonio_selection_report report;
            gonio_plan_options options;
            gonio_plan_options_default(&options);
            options.count = n;
            options.restarts = 1;
            options.seed = seed;
            assert_int_equal(gonio_plan_select(NULL, v, rows, k, k, &options, fast, &report),
                             GONIO_OK);
            assert_int_equal(report.steps, swaps + 1);
            for (size_t s = 0; s < report.steps; s++) {
                assert_true(fabs(report.history[s].condition_number - kappas[s]) <=
                            1e-8 * kappas[s]);
            }
            qsort(plain, n, sizeof *plain, compare_rows);
            assert_memory_equal(plain, fast, n * sizeof *plain);
            free(report.history);
            free(v);
        }
    }
    free(kappas);
}

/* Rows whose components differ by many orders of magnitude: next to singular, and no reason to
 * fail. */
static void test_nearly_singular(void **state)
{
    (void)state;
    enum { ROWS = 80, K = 6, N = 7 };
    static const double decades[] = {1.0, 2.0, 2.4};
    for (size_t d = 0; d < sizeof decades / sizeof *decades; d++) {
        double *v = make_rows(ROWS, K, 21);
        for (size_t i = 0; i < (size_t)ROWS * K; i++) {
            v[i] *= pow(10.0, -0.5 * decades[d] * (double)(i % K));
        }
        size_t chosen[N];
        gonio_selection_report report;
        gonio_plan_options options;
        gonio_plan_options_default(&options);
        options.count = N;
        assert_int_equal(gonio_plan_select(NULL, v, ROWS, K, K, &options, chosen, &report),
                         GONIO_OK);
        assert_true(isfinite(report.condition_number));
        free(report.history);
        free(v);
    }
}

/* The same plan on any number of threads: several starts, one, and one in rounds. */
static void test_any_number_of_threads(void **state)
{
    (void)state;
    enum { K = 10, N = 24 };
    static const struct {
        size_t rows;
        int restarts;
    } cases[] = {{3000, 3}, {20000, 1}, {110000, 1}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        double *v = make_rows(cases[c].rows, K, 5);
        size_t first[N] = {0};
        gonio_plan_options options;
        gonio_plan_options_default(&options);
        options.count = N;
        options.restarts = cases[c].restarts;
        for (int threads = 1; threads <= (support_small() ? 2 : 4); threads++) {
            gonio_context *context = NULL;
            const gonio_context_options settings = {.size = sizeof settings, .threads = threads};
            size_t chosen[N];
            gonio_selection_report report;
            assert_int_equal(gonio_context_create(&context, &settings), GONIO_OK);
            assert_int_equal(gonio_plan_select(context, v, cases[c].rows, K, K, &options,
                                               threads == 1 ? first : chosen, &report),
                             GONIO_OK);
            if (threads > 1) {
                assert_memory_equal(first, chosen, sizeof first);
            }
            free(report.history);
            gonio_context_free(&context);
        }
        free(v);
    }
}

/* The count of eigenvalues above x after an exchange, against LAPACK. */
static void test_inertia(void **state)
{
    (void)state;
    enum { K = 9 };
    gonio_i_random random;
    gonio_i_random_seed(&random, 3, 0);
    int refused = 0;
    for (int trial = 0; trial < 200; trial++) {
        double d[K], y[K], z[K], h[K * K], values[K];
        double level = 0.0;
        for (int k = 0; k < K; k++) {
            level += gonio_i_random_uniform(&random);
            d[k] = level;
            y[k] = 0.3 * gonio_i_random_normal(&random);
            z[k] = 0.5 * gonio_i_random_normal(&random);
        }
        for (int a = 0; a < K; a++) {
            for (int b = 0; b < K; b++) {
                h[a * K + b] = (a == b ? d[a] : 0.0) - y[a] * y[b] + z[a] * z[b];
            }
        }
        assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', K, h, K, values), 0);
        const gonio_i_exchange exchange = {d, y, z, K};
        for (int step = -2; step < 80; step++) {
            const double x = 0.1 * step + 1e-3;
            int above = 0;
            for (int k = 0; k < K; k++) {
                above += values[k] > x;
            }
            assert_int_equal(gonio_i_exchange_count_above(&exchange, x), above);
        }
        for (size_t k = 0; k < K && values[0] > 0.0; k++) {
            const double found = gonio_i_exchange_eigenvalue(&exchange, k);
            assert_true(found <= values[k] * (1.0 + 1e-12));
            assert_true(found >= values[k] * (1.0 - 1e-9));
        }
        if (values[0] > 0.0) {
            const double kappa = values[K - 1] / values[0];
            /* A part may leave it open, but never refuses what wins. */
            for (size_t part = 1; part < K; part++) {
                assert_true(gonio_i_exchange_may_beat(&exchange, part, kappa * (1.0 + 1e-9)));
            }
            refused += !gonio_i_exchange_may_beat(&exchange, K - 1, 0.9 * kappa);
            assert_true(gonio_i_exchange_beats(&exchange, kappa * (1.0 + 1e-9)));
            assert_false(gonio_i_exchange_beats(&exchange, kappa * (1.0 - 1e-9)));
        }
    }
    assert_true(refused > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inertia),
        cmocka_unit_test(test_local_optimum),
        cmocka_unit_test(test_same_swaps),
        cmocka_unit_test(test_nearly_singular),
        cmocka_unit_test(test_any_number_of_threads),
    };
    return cmocka_run_group_tests_name("condition plan", tests, NULL, NULL);
}
