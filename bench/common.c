/* What the sections of the benchmark share: see bench.h. */
#include "bench.h"

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return count % 2 == 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

double exponent(const double *x, const double *y, size_t count)
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

void report(bench *b, const char *name, double value, const char *unit)
{
    printf("%-52s %12.4g %s\n", name, value, unit);
    fflush(stdout);
    json_object_set_new(b->results, name, json_pack("{s:f, s:s}", "value", value, "unit", unit));
}

gonio_context *make_context(int threads)
{
    gonio_context *context = NULL;
    const gonio_context_options options = {.size = sizeof options, .threads = threads};
    check(gonio_context_create(&context, &options) == GONIO_OK, "making a context");
    return context;
}

/* ---- materials and bases ---- */

static int is_material(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot != NULL && (strcmp(dot, ".h5") == 0 || strcmp(dot, ".binary") == 0);
}

void find_materials(bench *b, const char *folder)
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

bool are_tables(const bench *b)
{
    bool all = b->count >= TABLES;
    for (size_t k = 0; k < TABLES && all; k++) {
        const char *dot = strrchr(b->paths[k], '.');
        all = dot != NULL && strcmp(dot, ".binary") == 0;
    }
    return all;
}

gonio_basis *learn(gonio_context *context, char *const *paths, size_t count,
                   const gonio_recipe *recipe)
{
    gonio_basis *basis = NULL;
    check(gonio_learn(context, (const char *const *)paths, count, recipe, &basis) == GONIO_OK,
          "learning");
    return basis;
}

gonio_basis *learn_paper(gonio_context *context, char *const *paths, size_t count,
                         size_t components)
{
    gonio_recipe recipe;
    gonio_recipe_paper(&recipe);
    recipe.components = components;
    return learn(context, paths, count, &recipe);
}

/* ---- folders and processes ---- */

char *scratch_folder(void)
{
    char *folder = NULL;
    const char *base = getenv("TMPDIR");
    check(asprintf(&folder, "%s/gonio-bench-XXXXXX", base != NULL ? base : "/tmp") > 0 &&
              mkdtemp(folder) != NULL,
          "making a scratch folder");
    return folder;
}

double run_seconds(const char *program, char *const *argv, struct rusage *usage)
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

double command_seconds(const char *folder, const char *command)
{
    char *line = NULL;
    check(asprintf(&line, "cd '%s' && %s", folder, command) > 0, "memory");
    const double start = now();
    check(system(line) == 0, command);
    free(line);
    return now() - start;
}

double cat_seconds(char *const *tables)
{
    char *argv[TABLES + 2] = {"cat"};
    memcpy(argv + 1, tables, TABLES * sizeof *argv);
    struct rusage usage;
    return run_seconds("cat", argv, &usage);
}
