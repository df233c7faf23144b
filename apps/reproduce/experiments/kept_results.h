/* Checks of results that were read from files. A file with a right checksum may still have any
 * content, because the folder may come from somebody else. */
#ifndef GONIO_REPRODUCE_KEPT_RESULTS_H
#define GONIO_REPRODUCE_KEPT_RESULTS_H

#include "computations.h"

/* True if a result has the form that the computation of the same name makes, with every number in
 * its range. Otherwise complaint [GONIO_I_COMPLAINT] says what is wrong. */
typedef bool gonio_i_accept(const gonio_i_study *study, const gonio_i_piece *p,
                            const json_t *result, char *complaint);

gonio_i_accept gonio_i_accept_spectrum;
gonio_i_accept gonio_i_accept_convergence;
gonio_i_accept gonio_i_accept_directions;
gonio_i_accept gonio_i_accept_grid;
gonio_i_accept gonio_i_accept_method;
gonio_i_accept gonio_i_accept_left_out;
gonio_i_accept gonio_i_accept_quoted;

/* The same for a rendering, whose images have side x side pixels. */
bool gonio_i_accept_images(const json_t *result, int side, char *complaint);

#endif
