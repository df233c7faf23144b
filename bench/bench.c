/* How fast gonio is, as ratios to what it is compared with, measured side by side in one run.
 *
 *   gonio-bench [MATERIALS] [SECTION...]     sections: learn plan starts
 *                                            reconstruct full growth default
 *
 * MATERIALS is a folder of at least 81 materials (default: the built-in ones). Prints a table and
 * writes bench.json in the working directory. docs/performance.md explains each line. */
#include <gonio/gonio.h>

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cblas.h>
#include <jansson.h>
#include <lapacke.h>

#include "core/random.h"
#include "blas_kernels.h"

enum { RUNS = 5, BASIS_MATERIALS = 80, TABLES = 100 };

typedef struct bench {
    json_t *results;
    char **paths; /* of the materials */
    size_t count;
    int processors;
} bench;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void check(bool fine, const char *what)
{
    if (!fine) {
        fprintf(stderr, "gonio-bench: %s failed\n", what);
        exit(1);
    }
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return count % 2 == 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

/* One line of the table and of the JSON. */
static void report(bench *b, const char *name, double value, const char *unit)
{
    printf("%-52s %12.4g %s\n", name, value, unit);
    fflush(stdout);
    json_object_set_new(b->results, name, json_pack("{s:f, s:s}", "value", value, "unit", unit));
}

static gonio_context *make_context(int threads)
{
    gonio_context *context = NULL;
    const gonio_context_options options = {.size = sizeof options, .threads = threads};
    check(gonio_context_create(&context, &options) == GONIO_OK, "making a context");
    return context;
}

/* ---- materials ---- */

static int is_material(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot != NULL && (strcmp(dot, ".h5") == 0 || strcmp(dot, ".binary") == 0);
}

static void find_materials(bench *b, const char *folder)
{
    struct dirent **entries = NULL;
    const int count =
        folder != NULL ? scandir(folder, &entries, is_material, alphasort) : gonio_atlas_count();
    check(count > BASIS_MATERIALS, "finding 81 materials");
    b->count = (size_t)count;
    b->paths = calloc(b->count, sizeof *b->paths);
    for (size_t k = 0; k < b->count; k++) {
        check((folder != NULL ? asprintf(&b->paths[k], "%s/%s", folder, entries[k]->d_name)
                              : asprintf(&b->paths[k], "atlas:%s", gonio_atlas_name((int)k))) > 0,
              "memory");
        if (folder != NULL) {
            free(entries[k]);
        }
    }
    free(entries);
}

static gonio_basis *learn(gonio_context *context, char *const *paths, size_t count,
                          const gonio_recipe *recipe)
{
    gonio_basis *basis = NULL;
    check(gonio_learn(context, (const char *const *)paths, count, recipe, &basis) == GONIO_OK,
          "learning");
    return basis;
}

/* By the paper's recipe. */
static gonio_basis *learn_paper(gonio_context *context, char *const *paths, size_t count,
                                size_t components)
{
    gonio_recipe recipe;
    gonio_recipe_paper(&recipe);
    recipe.components = components;
    return learn(context, paths, count, &recipe);
}

/* ---- planning ---- */

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

typedef struct planned {
    double seconds;
    double tests;
    double condition_number;
} planned;

static planned plan_once(const gonio_basis *basis, gonio_context *context, size_t k, size_t n,
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

static void bench_plan(bench *b)
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

static void bench_starts(bench *b)
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

/* ---- growth ---- */

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

/* The slope of log y against log x, by least squares. */
static double exponent(const double *x, const double *y, size_t count)
{
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (size_t k = 0; k < count; k++) {
        sx += log(x[k]);
        sy += log(y[k]);
        sxx += log(x[k]) * log(x[k]);
        sxy += log(x[k]) * log(y[k]);
    }
    const double n = (double)count;
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
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

/* ---- learning ---- */

static char *scratch_folder(void)
{
    char *folder = NULL;
    const char *base = getenv("TMPDIR");
    check(asprintf(&folder, "%s/gonio-bench-XXXXXX", base != NULL ? base : "/tmp") > 0 &&
              mkdtemp(folder) != NULL,
          "making a scratch folder");
    return folder;
}

static void write_tables(const bench *b, gonio_context *context, const char *folder, char **tables)
{
    for (size_t k = 0; k < TABLES; k++) {
        gonio_material *material = NULL;
        check(asprintf(&tables[k], "%s/%03zu.binary", folder, k) > 0, "memory");
        check(gonio_material_open(context, b->paths[k % b->count], &material) == GONIO_OK &&
                  gonio_material_write_merl(context, material, tables[k]) == GONIO_OK,
              "writing tables");
        gonio_material_free(&material);
    }
}

static const char learn_child[] = "--learn"; /* how the benchmark starts itself for one learning */

/* Wall-clock seconds of a program that writes to /dev/null, and what it used. */
static double run_seconds(const char *program, char *const *argv, struct rusage *usage)
{
    const double start = now();
    const pid_t child = fork();
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        dup2(nowhere, STDOUT_FILENO);
        execvp(program, argv);
        _exit(127);
    }
    int status = 0;
    check(child > 0 && wait4(child, &status, 0, usage) == child && status == 0, program);
    return now() - start;
}

/* `cat` of every table to /dev/null. */
static double cat_seconds(char *const *tables)
{
    char *argv[TABLES + 2] = {"cat"};
    memcpy(argv + 1, tables, TABLES * sizeof *argv);
    struct rusage usage;
    return run_seconds("cat", argv, &usage);
}

/* What a row of the benchmark of learning learns. */
typedef struct learning {
    const char *name;
    const char *kind; /* representation, channels and components, for the child */
    int runs;
} learning;

static const learning learnings[] = {
    {"bivariate", "bivariate joint 45", RUNS},
    {"full, separate channels, K = 100", "full separate 100", RUNS},
    {"full, joint, K = 60", "full joint 60", 3},
};

/* In a process of its own, whose peak memory is that of learning alone. */
static int learn_as_child(char *const *arguments, size_t count)
{
    char representation[16];
    char channels[16];
    size_t components = 0;
    check(sscanf(arguments[0], "%15s %15s %zu", representation, channels, &components) == 3,
          "reading what to learn");
    gonio_recipe how;
    gonio_recipe_for_grid(&how, strcmp(representation, "full") == 0 ? GONIO_FULL : GONIO_BIVARIATE);
    how.components = components;
    how.channels = strcmp(channels, "separate") == 0 ? GONIO_SEPARATE : GONIO_JOINT;
    gonio_context *all = make_context(0);
    gonio_basis *basis = learn(all, arguments + 1, count - 1, &how);
    gonio_basis_free(&basis);
    gonio_context_free(&all);
    return 0;
}

static void bench_learning(bench *b, const learning *what, char *const *tables)
{
    char name[128];
    double ratio[RUNS];
    double seconds[RUNS];
    long peak = 0;
    char *argv[TABLES + 4] = {"gonio-bench", (char *)(uintptr_t)learn_child,
                              (char *)(uintptr_t)what->kind};
    memcpy(argv + 3, tables, TABLES * sizeof *argv);
    for (int run = 0; run < what->runs; run++) {
        struct rusage usage;
        const double cat = cat_seconds(tables);
        seconds[run] = run_seconds("/proc/self/exe", argv, &usage);
        ratio[run] = seconds[run] / cat;
        peak = usage.ru_maxrss > peak ? usage.ru_maxrss : peak;
    }
    snprintf(name, sizeof name, "learn 100 MERL tables, %s", what->name);
    report(b, name, median(seconds, (size_t)what->runs), "s");
    snprintf(name, sizeof name, "learn, %s: over cat", what->name);
    report(b, name, median(ratio, (size_t)what->runs), "x");
    snprintf(name, sizeof name, "learn, %s: peak memory", what->name);
    report(b, name, (double)peak / 1024.0, "MiB");
}

static bool are_tables(const bench *b)
{
    bool all = b->count >= TABLES;
    for (size_t k = 0; k < TABLES && all; k++) {
        const char *dot = strrchr(b->paths[k], '.');
        all = dot != NULL && strcmp(dot, ".binary") == 0;
    }
    return all;
}

static void bench_learn(bench *b)
{
    const bool given = are_tables(b);
    char *folder = NULL;
    char *tables[TABLES];
    if (given) {
        memcpy(tables, b->paths, sizeof tables);
    } else {
        gonio_context *all = make_context(0);
        folder = scratch_folder();
        write_tables(b, all, folder, tables);
        gonio_context_free(&all);
    }
    cat_seconds(tables);
    for (size_t k = 0; k < sizeof learnings / sizeof *learnings; k++) {
        bench_learning(b, &learnings[k], tables);
    }
    for (size_t k = 0; k < TABLES && !given; k++) {
        unlink(tables[k]);
        free(tables[k]);
    }
    if (!given) {
        rmdir(folder);
        free(folder);
    }
}

/* ---- growth in the number of materials ---- */

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

static void bench_growth(bench *b)
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

/* ---- planning on the full grid ---- */

static const char plan_child[] = "--plan"; /* how the benchmark starts itself for one such plan */

/* In a process of its own, for its peak memory: reads a basis and plans 100 readings. */
static int plan_as_child(const char *path)
{
    gonio_context *context = make_context(0);
    gonio_basis *basis = NULL;
    check(gonio_basis_read(context, path, &basis) == GONIO_OK, "reading a basis");
    plan_once(basis, context, 60, 100, 0, 1, "random");
    gonio_basis_free(&basis);
    gonio_context_free(&context);
    return 0;
}

static void bench_full_plan(bench *b, const char *folder, gonio_channel_model channels,
                            const char *kind)
{
    enum { FULL_RUNS = 3 };
    char name[128];
    char *path = NULL;
    gonio_context *context = make_context(0);
    gonio_recipe how;
    gonio_recipe_for_grid(&how, GONIO_FULL);
    how.channels = channels;
    how.components = 60;
    gonio_basis *basis = learn(context, b->paths, BASIS_MATERIALS, &how);
    check(asprintf(&path, "%s/full.gonio", folder) > 0 &&
              gonio_basis_write(context, basis, NULL, path) == GONIO_OK,
          "writing a basis");
    gonio_basis_free(&basis);
    gonio_context_free(&context);
    double seconds[FULL_RUNS];
    struct rusage usage;
    char *argv[] = {"gonio-bench", (char *)(uintptr_t)plan_child, path, NULL};
    for (int run = 0; run < FULL_RUNS; run++) {
        seconds[run] = run_seconds("/proc/self/exe", argv, &usage);
    }
    snprintf(name, sizeof name, "plan (60, 100) of the full grid, %s", kind);
    report(b, name, median(seconds, FULL_RUNS), "s");
    snprintf(name, sizeof name, "plan (60, 100) of the full grid, %s: peak memory", kind);
    report(b, name, (double)usage.ru_maxrss / 1024.0, "MiB");
    unlink(path);
    free(path);
}

static void bench_full_plans(bench *b)
{
    char *folder = scratch_folder();
    bench_full_plan(b, folder, GONIO_SEPARATE, "separate");
    bench_full_plan(b, folder, GONIO_JOINT, "joint");
    rmdir(folder);
    free(folder);
}

/* ---- reconstructing ---- */

/* write(2) of a MERL table's bytes, with fsync and rename as gonio does. In pieces as cp and dd use
 * them: Linux is slower with all at once, for which it looks for larger pages. */
static double plain_write_seconds(const char *path, const char *data, size_t size)
{
    enum { PIECE = 128 << 10 };
    char *part = NULL;
    check(asprintf(&part, "%s.part", path) > 0, "memory");
    const double start = now();
    const int descriptor = open(part, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    size_t done = 0;
    while (descriptor >= 0 && done < size) {
        const size_t piece = size - done < PIECE ? size - done : PIECE;
        const ssize_t written = write(descriptor, data + done, piece);
        check(written > 0, "write");
        done += (size_t)written;
    }
    check(fsync(descriptor) == 0 && close(descriptor) == 0 && rename(part, path) == 0, "write");
    free(part);
    return now() - start;
}

static double reconstruct_seconds(gonio_context *context, const gonio_basis *basis,
                                  const size_t *rows, size_t n, const double *readings,
                                  const char *path)
{
    gonio_reconstruction *reconstruction = NULL;
    gonio_material *material = NULL;
    const double start = now();
    check(gonio_reconstruct_rows(context, basis, 35, rows, n, readings, &reconstruction) ==
                  GONIO_OK &&
              gonio_reconstruction_material(context, basis, reconstruction, "bench", &material) ==
                  GONIO_OK &&
              gonio_material_write_merl(context, material, path) == GONIO_OK,
          "reconstructing");
    const double seconds = now() - start;
    gonio_material_free(&material);
    gonio_reconstruction_free(&reconstruction);
    return seconds;
}

enum { MERL_SIZE = 12 + sizeof(double) * GONIO_CHANNELS * GONIO_BINS };

/* The bytes of a real table, for the plain writes. */
static char *table_bytes(const bench *b, gonio_context *context, const char *path)
{
    gonio_material *material = NULL;
    char *data = malloc(MERL_SIZE);
    check(data != NULL && gonio_material_open(context, b->paths[0], &material) == GONIO_OK &&
              gonio_material_write_merl(context, material, path) == GONIO_OK,
          "writing a table");
    FILE *file = fopen(path, "rb");
    check(file != NULL && fread(data, 1, MERL_SIZE, file) == MERL_SIZE, "reading a table");
    fclose(file);
    gonio_material_free(&material);
    return data;
}

static void bench_reconstruct_one(bench *b, gonio_context *context, const gonio_basis *basis,
                                  const char *path, const char *data)
{
    enum { N = 80, TIMES = 15 };
    const gonio_basis_view *view = gonio_basis_describe(basis);
    size_t rows[N];
    double readings[N];
    for (size_t k = 0; k < N; k++) {
        rows[k] = k * (view->rows / N);
        readings[k] = view->mean[rows[k]] + 0.01 * (double)(k % 7);
    }
    double ratio[TIMES];
    double seconds[TIMES];
    for (int run = 0; run < TIMES; run++) {
        const double plain = plain_write_seconds(path, data, MERL_SIZE);
        seconds[run] = reconstruct_seconds(context, basis, rows, N, readings, path);
        ratio[run] = seconds[run] / plain;
    }
    report(b, "reconstruct one material to a MERL table", median(seconds, TIMES), "s");
    report(b, "reconstruct one material: over plain write(2)", median(ratio, TIMES), "x");
}

/* Readings of TABLES materials by the simulated instrument, in FOLDER/readings-NUMBER.csv. */
static void write_readings(const bench *b, gonio_context *context, const gonio_basis *basis,
                           const char *folder)
{
    gonio_plan_options how;
    gonio_plan *plan = NULL;
    gonio_plan_options_default(&how);
    how.method = "random";
    check(gonio_plan_create(context, basis, &how, &plan) == GONIO_OK, "planning");
    for (size_t k = 0; k < TABLES; k++) {
        gonio_readings *readings = NULL;
        gonio_material *material = NULL;
        gonio_table *table = NULL;
        char *to = NULL;
        check(asprintf(&to, "%s/readings-%03zu.csv", folder, k) > 0 &&
                  gonio_readings_create_from_plan(context, plan, &readings) == GONIO_OK &&
                  gonio_material_open(context, b->paths[k % b->count], &material) == GONIO_OK &&
                  gonio_table_load(context, material, &table) == GONIO_OK &&
                  gonio_measure(context, readings, table, NULL) == GONIO_OK &&
                  gonio_readings_write(context, readings, NULL, to) == GONIO_OK,
              "measuring");
        gonio_table_free(&table);
        gonio_material_free(&material);
        gonio_readings_free(&readings);
        free(to);
    }
    gonio_plan_free(&plan);
}

/* Seconds for a shell command, with FOLDER as its working directory. */
static double command_seconds(const char *folder, const char *command)
{
    char *line = NULL;
    check(asprintf(&line, "cd '%s' && %s", folder, command) > 0, "memory");
    const double start = now();
    check(system(line) == 0, command);
    free(line);
    return now() - start;
}

/* Empties FOLDER/out and waits for the disk. */
static void make_room(const char *folder)
{
    command_seconds(folder, "rm -rf out && mkdir out && sync");
}

static double plain_writes_seconds(const char *folder, const char *data)
{
    double seconds = 0.0;
    for (int k = 0; k < TABLES; k++) {
        char *path = NULL;
        check(asprintf(&path, "%s/out/%03d.binary", folder, k) > 0, "memory");
        seconds += plain_write_seconds(path, data, MERL_SIZE);
        free(path);
    }
    return seconds;
}

/* The whole command, reading of the basis and of the readings included. */
static void bench_reconstruct_many(bench *b, gonio_context *context, const gonio_basis *basis,
                                   const char *folder, const char *data)
{
    char *path = NULL;
    check(asprintf(&path, "%s/basis.gonio", folder) > 0 &&
              gonio_basis_write(context, basis, NULL, path) == GONIO_OK,
          "writing a basis");
    write_readings(b, context, basis, folder);
    double ratio[RUNS];
    double seconds[RUNS];
    for (int run = 0; run < RUNS; run++) {
        make_room(folder);
        const double plain = plain_writes_seconds(folder, data);
        make_room(folder);
        seconds[run] = command_seconds(folder, GONIO_PROGRAM
                                       " reconstruct -q basis.gonio readings-*.csv -o out");
        ratio[run] = seconds[run] / plain;
    }
    report(b, "reconstruct 100 materials in one command", median(seconds, RUNS), "s");
    report(b, "reconstruct 100 materials: over plain write(2)", median(ratio, RUNS), "x");
    command_seconds(folder, "rm -rf out basis.gonio readings-*.csv");
    free(path);
}

static void bench_reconstruct(bench *b)
{
    gonio_context *all = make_context(0);
    gonio_basis *basis = learn_paper(all, b->paths, BASIS_MATERIALS, 35);
    char *folder = scratch_folder();
    char *path = NULL;
    check(asprintf(&path, "%s/table.binary", folder) > 0, "memory");
    char *data = table_bytes(b, all, path);
    bench_reconstruct_one(b, all, basis, path, data);
    bench_reconstruct_many(b, all, basis, folder, data);
    unlink(path);
    rmdir(folder);
    free(data);
    free(path);
    free(folder);
    gonio_basis_free(&basis);
    gonio_context_free(&all);
}

/* ---- the default method ---- */

/* basis.gonio in a folder: what `gonio learn` makes of the first materials. */
static void write_default_basis(const bench *b, const char *folder)
{
    gonio_context *context = make_context(0);
    gonio_basis *basis = learn(context, b->paths, BASIS_MATERIALS, NULL);
    char *path = NULL;
    check(asprintf(&path, "%s/basis.gonio", folder) > 0 &&
              gonio_basis_write(context, basis, NULL, path) == GONIO_OK,
          "writing a basis");
    gonio_basis_free(&basis);
    gonio_context_free(&context);
    free(path);
}

/* Whole commands, with reading the basis, which `gonio info` does too. */
static void bench_default(bench *b)
{
    char *folder = scratch_folder();
    char *measure = NULL;
    double info[RUNS];
    double plan[RUNS];
    double reconstruct[RUNS];
    const double start = now();
    write_default_basis(b, folder);
    report(b, "default: learn from 80 materials, once", now() - start, "s");
    check(asprintf(&measure, GONIO_PROGRAM " measure -q plan.csv '%s' -o readings.csv",
                   b->paths[BASIS_MATERIALS]) > 0,
          "memory");
    for (int run = 0; run < RUNS; run++) {
        info[run] = command_seconds(folder, GONIO_PROGRAM " info basis.gonio >/dev/null");
        plan[run] = command_seconds(folder, GONIO_PROGRAM " plan -q basis.gonio -n 20 -o plan.csv");
        command_seconds(folder, measure);
        reconstruct[run] = command_seconds(folder, GONIO_PROGRAM
                                           " reconstruct -q basis.gonio readings.csv -o a.binary");
    }
    report(b, "default: reading the basis", median(info, RUNS), "s");
    report(b, "default: plan of 20 directions", median(plan, RUNS), "s");
    report(b, "default: reconstruct from 20 directions", median(reconstruct, RUNS), "s");
    command_seconds(folder, "rm basis.gonio plan.csv readings.csv a.binary");
    rmdir(folder);
    free(measure);
    free(folder);
}

/* ---- */

static const struct {
    const char *name;
    void (*run)(bench *b);
} sections[] = {
    {"learn", bench_learn},     {"plan", bench_plan},
    {"starts", bench_starts},   {"reconstruct", bench_reconstruct},
    {"full", bench_full_plans}, {"growth", bench_growth},
    {"default", bench_default},
};

static bool wanted(const char *name, int argc, char **argv)
{
    for (int k = 2; k < argc; k++) {
        if (strcmp(argv[k], name) == 0) {
            return true;
        }
    }
    return argc <= 2;
}

int main(int argc, char **argv)
{
    blas_kernels_choose(argv);
    if (argc > 4 && strcmp(argv[1], learn_child) == 0) {
        return learn_as_child(argv + 2, (size_t)argc - 2);
    }
    if (argc == 3 && strcmp(argv[1], plan_child) == 0) {
        return plan_as_child(argv[2]);
    }
    bench b = {.results = json_object(), .processors = (int)sysconf(_SC_NPROCESSORS_ONLN)};
    find_materials(&b, argc > 1 && strcmp(argv[1], "atlas:") != 0 ? argv[1] : NULL);
    printf("%zu materials, %d processors\n", b.count, b.processors);
    for (size_t k = 0; k < sizeof sections / sizeof *sections; k++) {
        if (wanted(sections[k].name, argc, argv)) {
            sections[k].run(&b);
        }
    }
    check(json_dump_file(b.results, "bench.json", JSON_INDENT(2)) == 0, "writing bench.json");
    json_decref(b.results);
    for (size_t k = 0; k < b.count; k++) {
        free(b.paths[k]);
    }
    free(b.paths);
    return 0;
}
