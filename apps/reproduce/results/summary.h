/* The means of the experiments' results. */
#ifndef GONIO_REPRODUCE_SUMMARY_H
#define GONIO_REPRODUCE_SUMMARY_H

#include "../experiments/experiments.h"
#include "../experiments/methods.h"

/* Arrays are NULL for experiments that are not run. Means are over a split's test materials and
 * then over the splits; NaN if a value is missing. */
typedef struct gonio_i_findings {
    gonio_error *bivariate; /* [materials] */
    gonio_error bivariate_mean;
    double *cumulative; /* [cumulative_count]: of the variance of all materials */
    size_t cumulative_count;
    gonio_error *grid;         /* [K][L] */
    double *grid_condition;    /* [K][L] */
    gonio_error *limit;        /* [K]: all rows */
    gonio_error *method_split; /* [methods][splits] */
    gonio_error *method;       /* [methods] */
    double *method_condition;  /* [methods] */
    gonio_error *left_out;     /* [left out][GONIO_I_LEFT_OUT_SERIES] */
    gonio_error left_out_mean[GONIO_I_LEFT_OUT_SERIES];
    gonio_error quoted[GONIO_I_QUOTED]; /* [study->quoted_count] of the quoted method */
} gonio_i_findings;

/* To be freed in any case. Errors: _MEMORY. */
gonio_status gonio_i_find(gonio_context *context, const gonio_i_study *study,
                          const gonio_i_results *results, gonio_i_findings *findings);
void gonio_i_findings_free(gonio_i_findings *findings);

/* E6 in a cell of the grid; NaN if the grid has no such cell. */
double gonio_i_grid_e6(const gonio_i_study *study, const gonio_i_findings *findings,
                       size_t components, size_t samples);

#endif
