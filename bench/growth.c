/* How the times of planning and of learning grow with the sizes. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "core/random.h"

/* Rows like a basis's: lengths over three decades, leading components stronger. */
static double *synthetic_rows(size_t rows, size_t k)
{
    gonio_i_random random;
    gonio_i_random_seed(&random, 7, 7);
    double *v = malloc(rows * k * sizeof *v);
    check(v != NULL, "memory");
    for (size_t i = 0; i < rows; i++) {
        const double length = exp(-3.0 * gonio_i_random_uniform(&random));
        for (size_t j = 0; j < k; j++) {
            v[i * k + j] = length * gonio_i_random_normal(&random) / sqrt(1.0 + (double)j);
        }
    }
    return v;
}

static double synthetic_plan_seconds(size_t rows, size_t k, size_t n)
{
    gonio_context *one = make_context(1);
    double *v = synthetic_rows(rows, k);
    size_t *chosen = malloc(n * sizeof *chosen);
    double seconds[3];
    for (int run = 0; run < 3; run++) {
        gonio_plan_options options;
        gonio_selection_report found;
        gonio_plan_options_default(&options);
        options.count = n;
        options.restarts = 1;
        options.seed = (uint64_t)run;
        options.keep_history = false;
        const double start = now();
        check(gonio_plan_select(one, v, rows, k, k, &options, chosen, &found) == GONIO_OK,
              "planning");
        seconds[run] = now() - start;
    }
    free(chosen);
    free(v);
    gonio_context_free(&one);
    return median(seconds, 3);
}

static void bench_growth_axis(bench *b, const char *axis, const size_t sizes[][3], size_t count,
                              int which)
{
    double x[8];
    double y[8];
    char name[128];
    for (size_t k = 0; k < count; k++) {
        x[k] = (double)sizes[k][which];
        y[k] = synthetic_plan_seconds(sizes[k][0], sizes[k][1], sizes[k][2]);
        snprintf(name, sizeof name, "growth: M = %zu, K = %zu, L = %zu", sizes[k][0], sizes[k][1],
                 sizes[k][2]);
        report(b, name, y[k], "s");
    }
    snprintf(name, sizeof name, "growth: exponent of the time in %s", axis);
    report(b, name, exponent(x, y, count), "");
}

/* Seconds to learn from `count` tables: links to the same hundred, under names of their own. */
static double learn_links_seconds(const char *folder, char *const *tables, size_t count)
{
    gonio_context *all = make_context(0);
    char **links = calloc(count, sizeof *links);
    check(links != NULL, "memory");
    for (size_t k = 0; k < count; k++) {
        check(asprintf(&links[k], "%s/link-%05zu.binary", folder, k) > 0 &&
                  symlink(tables[k % TABLES], links[k]) == 0,
              "linking tables");
    }
    const double start = now();
    gonio_basis *basis = learn_paper(all, links, count, 45);
    const double seconds = now() - start;
    gonio_basis_free(&basis);
    for (size_t k = 0; k < count; k++) {
        unlink(links[k]);
        free(links[k]);
    }
    free(links);
    gonio_context_free(&all);
    return seconds;
}

static void bench_growth_materials(bench *b)
{
    static const size_t counts[] = {100, 500, 2000};
    enum { COUNTS = sizeof counts / sizeof *counts };
    double x[COUNTS];
    double y[COUNTS];
    char name[128];
    if (!are_tables(b)) {
        printf("growth in N: needs a folder of %d MERL tables\n", TABLES);
        return;
    }
    char *folder = scratch_folder();
    cat_seconds(b->paths);
    for (size_t k = 0; k < COUNTS; k++) {
        x[k] = (double)counts[k];
        y[k] = learn_links_seconds(folder, b->paths, counts[k]);
        snprintf(name, sizeof name, "growth: N = %zu materials, learning", counts[k]);
        report(b, name, y[k], "s");
    }
    report(b, "growth: exponent of the time in N", exponent(x, y, COUNTS), "");
    rmdir(folder);
    free(folder);
}

void bench_growth(bench *b)
{
    static const size_t rows[][3] = {
        {24000, 20, 40}, {48000, 20, 40}, {96000, 20, 40}, {480000, 20, 40}};
    static const size_t components[][3] = {{24000, 10, 100}, {24000, 20, 100}, {24000, 40, 100}};
    static const size_t counts[][3] = {{24000, 20, 40}, {24000, 20, 80}, {24000, 20, 160}};
    bench_growth_axis(b, "M", rows, 4, 0);
    bench_growth_axis(b, "K", components, 3, 1);
    bench_growth_axis(b, "L", counts, 3, 2);
    bench_growth_materials(b);
}
