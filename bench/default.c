/* The default method: whole commands. */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

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
void bench_default(bench *b)
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
