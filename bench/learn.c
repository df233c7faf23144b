/* Learning, against `cat` of the same tables. */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char learn_child[] = "--learn";

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

/* arguments: a kind (below) and the materials. */
int learn_as_child(char *const *arguments, size_t count)
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

void bench_learn(bench *b)
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
