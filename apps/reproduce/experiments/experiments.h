/* The paper's experiments as pieces of work (checkpoint.h), and their results. */
#ifndef GONIO_REPRODUCE_EXPERIMENTS_H
#define GONIO_REPRODUCE_EXPERIMENTS_H

#include "../run/checkpoint.h"
#include "setup.h"

/* The series of errors of a left-out material. */
enum {
    GONIO_I_ALL_SAMPLES = GONIO_I_CHOSEN, /* after the chosen sizes */
    GONIO_I_BIVARIATE_ITSELF,
    GONIO_I_LEFT_OUT_SERIES
};

/* The results of the pieces; NULL for experiments that are not run. Errors are arrays [E6, cube
 * root, log-relative]. Numbers that are not finite are null. */
typedef struct gonio_i_results {
    /* {"all": [variances], "splits": [[variances], ...]} */
    json_t *spectrum;
    /* {"starts": [[condition numbers], ...], "rows": [[rows in the end], ...]} */
    json_t *convergence;
    /* [split][K]: {"condition": [by L], "errors": [by L][test], "all": [test]}; null for L < K */
    json_t *grid;
    /* [split][method]: {"condition": number, "errors": [test]} */
    json_t *methods;
    /* [chosen]: {"condition": number, "entries": [[cell, channel, theta_i, phi_i, theta_o, phi_o]]}
     */
    json_t *directions;
    /* [left out]: {"condition": [chosen], "errors": [series]} */
    json_t *left_out;
    /* [quoted]: {"condition": number, "error": [..]} of the quoted method */
    json_t *quoted;
    /* [row x method], see renderings.h */
    json_t *rendered;
    json_t *lit;
} gonio_i_results;

/* Runs the missing pieces of all experiments together. The results are to be freed in any
 * case. Errors: those of gonio_i_checkpoint_run. */
gonio_status gonio_i_run_experiments(gonio_context *context, const gonio_i_study *study,
                                     const gonio_i_checkpoint *checkpoint,
                                     gonio_i_results *results);
void gonio_i_results_free(gonio_i_results *results);

/* A number; NaN for null. */
double gonio_i_json_number(const json_t *value);
gonio_error gonio_i_json_error(const json_t *value);

#endif
