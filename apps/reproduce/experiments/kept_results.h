/* Whether a result that was kept in a file is one of its kind. A file with a right checksum may
 * still say anything, as may the folder that somebody else hands over. */
#ifndef GONIO_REPRODUCE_KEPT_RESULTS_H
#define GONIO_REPRODUCE_KEPT_RESULTS_H

#include "computations.h"

/* True for a result as the computation of the same name leaves it, every number in its range;
 * otherwise writes what is wrong to complaint [GONIO_I_COMPLAINT]. */
typedef bool gonio_i_accept(const gonio_i_study *study, const gonio_i_piece *p,
                            const json_t *result, char *complaint);

gonio_i_accept gonio_i_accept_spectrum;
gonio_i_accept gonio_i_accept_convergence;
gonio_i_accept gonio_i_accept_directions;
gonio_i_accept gonio_i_accept_grid;
gonio_i_accept gonio_i_accept_method;
gonio_i_accept gonio_i_accept_left_out;
gonio_i_accept gonio_i_accept_quoted;

/* The same of a rendering, whose images have `side` pixels each way. */
bool gonio_i_accept_images(const json_t *result, int side, char *complaint);

#endif
