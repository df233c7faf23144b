/* Planning, against an eigenvalue solve for every swap; and the starts. */
#include "plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cblas.h>
#include <lapacke.h>

#include "core/random.h"

/* Seconds for one test of the plain algorithm: exchange two rows in G and solve for its
 * eigenvalues. */
static double plain_test_seconds(const gonio_basis *basis, size_t k, size_t n)
{
    enum { SOLVES = 20000 };
    const size_t rows = gonio_basis_describe(basis)->rows;
    double *v = calloc(rows * k, sizeof *v);
    check(gonio_basis_rows(NULL, basis, 0, rows, k, v) == GONIO_OK, "rows");
    double *g = calloc(2 * k * k + k, sizeof *g);
    double *h = g + k * k;
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, 1);
    for (size_t j = 0; j < n; j++) {
        const double *x = v + gonio_i_random_below(&random, rows) * k;
        cblas_dsyr(CblasRowMajor, CblasUpper, (int)k, 1.0, x, 1, g, (int)k);
    }
    const double *old = v;
    double sum = 0.0;
    const double start = now();
    for (int solve = 0; solve < SOLVES; solve++) {
        const double *u = v + gonio_i_random_below(&random, rows) * k;
        memcpy(h, g, k * k * sizeof *h);
        cblas_dsyr(CblasRowMajor, CblasUpper, (int)k, -1.0, old, 1, h, (int)k);
        cblas_dsyr(CblasRowMajor, CblasUpper, (int)k, 1.0, u, 1, h, (int)k);
        check(LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'N', 'L', (int)k, h, (int)k, h + k * k) == 0,
              "dsyevd");
        sum += h[k * k];
    }
    const double seconds = (now() - start) / SOLVES;
    check(isfinite(sum), "solving");
    free(g);
    free(v);
    return seconds;
}

planned plan_once(const gonio_basis *basis, gonio_context *context, size_t k, size_t n,
                  uint64_t seed, int restarts, const char *start)
{
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    options.components = k;
    options.count = n;
    options.seed = seed;
    options.restarts = restarts;
    options.start = start;
    gonio_plan *plan = NULL;
    const double from = now();
    check(gonio_plan_create(context, basis, &options, &plan) == GONIO_OK, "planning");
    const planned result = {now() - from, (double)plan->tests, plan->condition_number};
    gonio_plan_free(&plan);
    return result;
}

static void bench_plan_size(bench *b, const gonio_basis *basis, size_t k, size_t n)
{
    char name[128];
    gonio_context *one = make_context(1);
    gonio_context *all = make_context(0);
    double ratio[RUNS];
    double seconds[RUNS];
    double speedup[RUNS];
    for (int run = 0; run < RUNS; run++) {
        const double test = plain_test_seconds(basis, k, n);
        const planned single = plan_once(basis, one, k, n, (uint64_t)run, 1, "random");
        const planned multiple = plan_once(basis, all, k, n, (uint64_t)run, 1, "random");
        seconds[run] = single.seconds;
        ratio[run] = single.tests * test / single.seconds;
        speedup[run] = single.seconds / multiple.seconds;
        if (run == 0) {
            snprintf(name, sizeof name, "plan (%zu, %zu): one eigenvalue solve", k, n);
            report(b, name, 1e6 * test, "us");
        }
    }
    snprintf(name, sizeof name, "plan (%zu, %zu): one start, one thread", k, n);
    report(b, name, median(seconds, RUNS), "s");
    snprintf(name, sizeof name, "plan (%zu, %zu): times faster than the solves", k, n);
    report(b, name, median(ratio, RUNS), "x");
    snprintf(name, sizeof name, "plan (%zu, %zu): %d threads over one", k, n, b->processors);
    report(b, name, median(speedup, RUNS), "x");
    gonio_context_free(&one);
    gonio_context_free(&all);
}

void bench_plan(bench *b)
{
    gonio_context *all = make_context(0);
    gonio_basis *basis = learn_paper(all, b->paths, BASIS_MATERIALS, 45);
    bench_plan_size(b, basis, 35, 80);
    bench_plan_size(b, basis, 45, 170);
    double seconds[RUNS];
    for (int run = 0; run < RUNS; run++) {
        seconds[run] = plan_once(basis, all, 35, 80, (uint64_t)run, 10, "random").seconds;
    }
    report(b, "plan (35, 80): ten starts, all threads", median(seconds, RUNS), "s");
    gonio_basis_free(&basis);
    gonio_context_free(&all);
}

void bench_starts(bench *b)
{
    enum { SEEDS = 20 };
    char name[128];
    gonio_context *all = make_context(0);
    gonio_basis *basis = learn_paper(all, b->paths, BASIS_MATERIALS, 35);
    for (int start = 0; gonio_plan_start_name(start) != NULL; start++) {
        static const int restarts[] = {1, 5, 20};
        for (size_t r = 0; r < sizeof restarts / sizeof *restarts; r++) {
            const int seeds = SEEDS / restarts[r];
            double kappa = 0.0;
            double seconds = 0.0;
            for (int seed = 0; seed < seeds; seed++) {
                const planned p = plan_once(basis, all, 35, 80, (uint64_t)seed, restarts[r],
                                            gonio_plan_start_name(start));
                kappa += p.condition_number / seeds;
                seconds += p.seconds / seeds;
            }
            snprintf(name, sizeof name, "start %s, %d of them: condition number",
                     gonio_plan_start_name(start), restarts[r]);
            report(b, name, kappa, "");
            snprintf(name, sizeof name, "start %s, %d of them: time", gonio_plan_start_name(start),
                     restarts[r]);
            report(b, name, seconds, "s");
        }
    }
    gonio_basis_free(&basis);
    gonio_context_free(&all);
}
