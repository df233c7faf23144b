/* Report: the experiments of Ali et al. on a database of one's own, as figures, tables and a page
 * that sets them beside the paper's; and an interactive page for a browser. */
#ifndef GONIO_REPORT_H
#define GONIO_REPORT_H

#include <gonio/render.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Several processes, perhaps on several machines, that do one piece of work together. The library
 * does not know how they talk (MPI, say): the program that starts them tells it here. */
typedef struct gonio_team {
    int rank; /* which of them this process is: 0 .. size - 1 */
    int size; /* 1 for a process on its own */
    /* Waits until all have come here; false if that failed. May be NULL if size is 1. */
    bool (*barrier)(void *user);
    void *user; /* handed to the barrier */
} gonio_team;

typedef struct gonio_reproduce_options {
    /* A JSON file {"splits": [{"basis": [names], "test": [names]}, ...]}; NULL for random splits,
     * 80 per cent of the materials to learn from and 20 to test on. */
    const char *splits;
    uint64_t seed;    /* of the splits and the plans */
    bool quick;       /* fewer splits and plans: about a minute for 100 materials */
    const char *only; /* "fig3a,fig5": these experiments (gonio_experiment_name); NULL for all */
    bool skip_bad;    /* leave out materials that cannot be used, instead of refusing to start */
    const gonio_team *team; /* NULL for a process on its own */
} gonio_reproduce_options;

/* Random splits from seed 0, all experiments in full, bad materials refused. */
GONIO_API void gonio_reproduce_options_default(gonio_reproduce_options *options);

/* The experiments: "fig2a", "fig2b" ...; NULL past the last. */
GONIO_API const char *gonio_experiment_name(int index);

/* Runs the experiments on the materials at the given paths (material.h) and leaves in `folder`
 *   report.md       a section for each figure: the paper's numbers, these, and whether they agree
 *   results.json    the same numbers for programs
 *   figures/        data, gnuplot script and pictures
 *   tables/         all raw numbers as CSV: per split, material, and cell of the grid
 *   run.json, pieces/  what is finished: a run that was stopped goes on there, to the same bytes
 * The results do not depend on the number of threads or processes. All processes of a team call
 * this with the same arguments and a folder that all see.
 *
 * Memory: about 4 MB a material, and 10 MB a thread; while a method of the full grid is compared
 * (fig3b, fig5, not in a quick run), 3 GB for 100 materials, since that is done one at a time, and
 * 1.3 GB of scratch space in $TMPDIR or /tmp.
 *
 * Errors: _ARGUMENT for an unknown experiment, fewer than 4 materials, or a folder that is not
 * empty; _DATA for materials that cannot be used, all of them named, and splits that do not fit;
 * _FORMAT for another kind of splits file; _MISMATCH for the folder of another run, or of another
 * build's; _IO; _MEMORY; _CANCELLED. */
GONIO_API gonio_status gonio_reproduce(gonio_context *context, const char *const *paths,
                                       size_t count, const char *folder,
                                       const gonio_reproduce_options *options);

/* What an interactive page shows. Nothing is owned; everything may be NULL, but not both reference
 * and folder, and what is compared needs a reference. */
typedef struct gonio_report_content {
    const gonio_material *reference;
    const gonio_material *reconstruction; /* shown beside the reference */
    /* A table whose stored numbers are the standard deviations of g = ln(1 + rho/s) of the
     * reconstruction, bin by bin: a MERL file, read by gonio_material_open. */
    const gonio_material *deviation;
    const gonio_readings *readings; /* in measuring order; values are not needed */
    const char *folder;             /* of gonio_reproduce: its tables become charts */
} gonio_report_content;

/* Whether the library was built with the page, which needs Node.js. */
GONIO_API bool gonio_report_is_built(void);

/* Writes a page for a browser: one file of less than 6 MB that needs nothing else and no network.
 * Tables are stored in steps of 1/2048 of g, or coarser where noise makes them too large; the page
 * says which. The file appears whole or not at all.
 * Errors: _IO, also if the library was built without the page (which needs Node.js); _ARGUMENT for
 * nothing to show, a reconstruction without a reference, deviations without a reconstruction;
 * _DATA and _FORMAT for a folder without tables, or with others; those of gonio_compare and of the
 * materials; _MEMORY; _CANCELLED. */
GONIO_API gonio_status gonio_report_write(gonio_context *context,
                                          const gonio_report_content *content, const char *path);

#ifdef __cplusplus
}
#endif
#endif
