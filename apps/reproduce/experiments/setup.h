/* The setup of the experiments: materials, splits and sizes. */
#ifndef GONIO_REPRODUCE_SETUP_H
#define GONIO_REPRODUCE_SETUP_H

#include "../reproduce.h"
#include "splits.h"

typedef enum gonio_i_experiment {
    GONIO_I_SPECTRUM,    /* Fig. 2(a) */
    GONIO_I_CONVERGENCE, /* Fig. 2(b) */
    GONIO_I_GRID,        /* Fig. 3(a) */
    GONIO_I_METHODS,     /* Fig. 3(b) */
    GONIO_I_DIRECTIONS,  /* Fig. 4 */
    GONIO_I_LEFT_OUT,    /* Fig. 5 and the quoted materials */
    GONIO_I_RENDERED,    /* Fig. 6 */
    GONIO_I_LIT,         /* Fig. 7 */
    GONIO_I_EXPERIMENTS
} gonio_i_experiment;

/* K and L. */
typedef struct gonio_i_size {
    size_t components, samples;
} gonio_i_size;

enum {
    GONIO_I_CHOSEN = 3,        /* sizes that the paper chooses */
    GONIO_I_MOST_GRID = 32,    /* lines of the grid, either way */
    GONIO_I_STARTS = 5,        /* of plans that are shown; plans for errors have one */
    GONIO_I_QUOTED = 4,        /* materials whose errors the paper quotes */
    GONIO_I_QUICK_SPLITS = 2,  /* of a quick run */
    GONIO_I_QUICK_LEFT_OUT = 4 /* the same, besides the quoted materials */
};

typedef struct gonio_i_study {
    gonio_i_collection collection;
    gonio_i_splits splits;
    uint64_t seed;
    bool quick;
    bool wanted[GONIO_I_EXPERIMENTS];
    gonio_i_size chosen[GONIO_I_CHOSEN];
    bool cut; /* there are too few materials for the paper's components */
    size_t grid_components, grid_samples;
    size_t grid_component[GONIO_I_MOST_GRID]; /* [grid_components], ascending */
    size_t grid_sample[GONIO_I_MOST_GRID];    /* [grid_samples], ascending */
    size_t left_out_count;
    size_t *left_out; /* materials that are left out, one at a time; ascending */
    size_t quoted_count;
    struct {
        size_t material;
        size_t left_out;      /* the same, in left_out */
        int quote;            /* in gonio_i_quoted_materials */
    } quoted[GONIO_I_QUOTED]; /* left out for the quoted method too; none in a quick run */
} gonio_i_study;

/* The sizes of the paper, and what it quotes: a material, its E6 by Matusik et al. with 800 samples
 * and by the paper's method with 170. */
extern const gonio_i_size gonio_i_paper_sizes[GONIO_I_CHOSEN];

typedef struct gonio_i_quoted {
    const char *material;
    double matusik, paper;
} gonio_i_quoted;

extern const gonio_i_quoted gonio_i_quoted_materials[GONIO_I_QUOTED];

/* Reads materials and splits and chooses the sizes. Errors: those of gonio_reproduce. The study is
 * to be freed in any case. */
gonio_status gonio_i_study_create(gonio_context *context, const char *const *paths, size_t count,
                                  const gonio_reproduce_options *options, gonio_i_study *study);
void gonio_i_study_free(gonio_i_study *study);

/* The identity of a run: the build, by the sources that its numbers come from; materials with
 * fingerprints, splits, sizes, seed. */
json_t *gonio_i_study_identity(const gonio_i_study *study);

#endif
