/* The computations of the experiments, for each kind of piece (checkpoint.h). */
#ifndef GONIO_REPRODUCE_COMPUTATIONS_H
#define GONIO_REPRODUCE_COMPUTATIONS_H

#include "experiments.h"

/* One piece: its kind, and its place among those of the kind. */
typedef struct gonio_i_piece {
    int kind; /* in the table of experiments.c */
    size_t split;
    size_t index; /* of the grid's components, the method, the chosen size, the left-out material */
} gonio_i_piece;

/* Computes a piece into a JSON object, in the form described in experiments.h. */
typedef gonio_status gonio_i_compute(const gonio_i_study *study, gonio_context *context,
                                     const gonio_i_piece *p, json_t *result);

gonio_i_compute gonio_i_compute_spectrum;
gonio_i_compute gonio_i_compute_convergence;
gonio_i_compute gonio_i_compute_directions;
gonio_i_compute gonio_i_compute_grid;
gonio_i_compute gonio_i_compute_method;
gonio_i_compute gonio_i_compute_left_out;
gonio_i_compute gonio_i_compute_quoted;

#endif
