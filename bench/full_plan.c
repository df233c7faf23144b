/* Planning on the full grid, in processes of their own: time and peak memory. */
#include "plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

const char plan_child[] = "--plan";

/* Reads a basis and plans 100 readings. */
int plan_as_child(char *const *arguments, size_t count)
{
    gonio_context *context = make_context(0);
    gonio_basis *basis = NULL;
    check(count == 1 && gonio_basis_read(context, arguments[0], &basis) == GONIO_OK,
          "reading a basis");
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

void bench_full_plans(bench *b)
{
    char *folder = scratch_folder();
    bench_full_plan(b, folder, GONIO_SEPARATE, "separate");
    bench_full_plan(b, folder, GONIO_JOINT, "joint");
    rmdir(folder);
    free(folder);
}
