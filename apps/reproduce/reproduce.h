/* The experiments of Ali et al. on the user's database: figures, tables and a page that compares
 * them with the paper's. */
#ifndef GONIO_REPRODUCE_H
#define GONIO_REPRODUCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gonio/context.h>

#include "run/process_group.h"

typedef struct gonio_reproduce_options {
    /* A JSON file {"splits": [{"basis": [names], "test": [names]}, ...]}; NULL for random splits,
     * 80 per cent of the materials to learn from and 20 to test on. */
    const char *splits;
    uint64_t seed;    /* of the splits and the plans */
    bool quick;       /* fewer splits and plans: about a minute for 100 materials */
    const char *only; /* "fig3a,fig5": these experiments (gonio_experiment_name); NULL for all */
    bool skip_bad;    /* leave out materials that cannot be used, instead of refusing to start */
    const process_group *group; /* NULL for a process on its own */
} gonio_reproduce_options;

/* Random splits from seed 0, all experiments in full, bad materials refused. */
void gonio_reproduce_options_default(gonio_reproduce_options *options);

/* The experiments: "fig2a", "fig2b" ...; NULL past the last. */
const char *gonio_experiment_name(int index);

/* Runs the experiments on the materials at the given paths (material.h) and leaves in `folder`
 *   report.md       a section for each figure: the paper's numbers, these, and whether they agree
 *   results.json    the same numbers for programs
 *   figures/        data, gnuplot script and pictures
 *   tables/         all raw numbers as CSV: per split, material, and cell of the grid
 *   run.json, pieces/  finished work: a run that was stopped resumes there, to the same bytes
 * The results do not depend on the number of threads or processes. All processes of a group call
 * this with the same arguments and a folder that all see.
 *
 * Memory: about 4 MB a material and 10 MB a thread. Methods of the full grid (fig3b, fig5, not in a
 * quick run) are compared one at a time; they take 3 GB for 100 materials, and 1.3 GB of scratch
 * space in $TMPDIR or /tmp.
 *
 * Errors: _ARGUMENT for an unknown experiment, fewer than 4 materials, or a folder that is not
 * empty; _DATA for materials that cannot be used, all of them named, and splits that do not fit;
 * _FORMAT for another kind of splits file; _MISMATCH for the folder of another run, or of another
 * build's; _IO; _MEMORY; _CANCELLED. */
gonio_status gonio_reproduce(gonio_context *context, const char *const *paths, size_t count,
                             const char *folder, const gonio_reproduce_options *options);

#endif
