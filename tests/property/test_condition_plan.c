/* The condition-number search against the plain algorithm: every swap decided by LAPACK. */
#include "../support.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/plan.h>
#include <lapacke.h>

#include "core/random.h"
#include "plan/inertia.h"

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
                 {200, 8, 20}, {90, 1, 3}, {12, 3, 12}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        for (uint64_t seed = 0; seed < 4; seed++) {
            const size_t rows = cases[c].rows, k = cases[c].k, n = cases[c].n;
            double *v = make_rows(rows, k, seed);
            size_t chosen[32];
            double kappa = 0.0;
            gonio_plan_step *history = NULL;
            size_t steps = 0;
            gonio_plan_options options;
            gonio_plan_options_default(&options);
            options.count = n;
            options.restarts = 2;
            options.seed = seed;
            assert_int_equal(
                gonio_plan_select(NULL, v, rows, k, &options, chosen, &kappa, &history, &steps),
                GONIO_OK);
            assert_true(fabs(kappa - plain_condition(v, k, chosen, n)) <= 1e-9 * kappa);
            assert_true(best_single_swap(v, rows, k, chosen, n) >= kappa * (1.0 - 1e-9));
            double lowest = INFINITY;
            for (size_t s = 0; s < steps; s++) {
                if (history[s].swap > 0) {
                    assert_true(history[s].condition_number < history[s - 1].condition_number);
                }
                lowest = fmin(lowest, history[s].condition_number);
            }
            assert_true(lowest == kappa);
            free(history);
            free(v);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_local_optimum),
    };
    return cmocka_run_group_tests_name("condition plan", tests, NULL, NULL);
}
