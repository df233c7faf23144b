/* Wrong directions: directions without which the other readings agree.
 *
 * A wrong reading makes its neighbours look wrong, and several make a material look unlike all of
 * the database's. So the size of its prediction error alone does not identify it. The suspects are
 * the directions with the largest prediction errors, above a factor of three. They are left out in
 * turn, in all columns together. Greedily, the one whose removal explains the others best is set
 * aside, as long as the gain exceeds that of a larger remainder. Of columns of more than 128
 * readings only the subset of leave_one_out.h is tested; single readings are judged later
 * (posterior.h). */
#ifndef GONIO_WRONG_DIRECTIONS_H
#define GONIO_WRONG_DIRECTIONS_H

#include "leave_one_out.h"

/* Gives the readings of such directions, found on a subset of the columns, a variance so large that
 * they have almost no weight, in all columns. wrong: how many readings. Errors: _MEMORY,
 * _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_wrong_directions_find(gonio_context *context, const gonio_i_subset *subset,
                                           gonio_i_column *columns, size_t count, size_t *wrong);

#endif
