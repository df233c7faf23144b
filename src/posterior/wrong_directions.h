/* Directions that were read wrongly: those without which the others fit together.
 *
 * A wrong reading makes its neighbours look wrong, and enough of them make a material look like
 * none of the database's, so that it cannot be told by how far off it is. So the directions that
 * are off most, by a factor of more than three, are left out in turn, in all columns together:
 * greedily that one without which the others explain each other best, as long as that is worth more
 * than a larger remainder is. Of columns of more than 128 readings only those are tested that
 * models are tried on (leave_one_out.h); single readings of the others are judged later
 * (posterior.h). */
#ifndef GONIO_WRONG_DIRECTIONS_H
#define GONIO_WRONG_DIRECTIONS_H

#include "leave_one_out.h"

/* Gives the readings of such directions, found on a subset of the columns, a variance that leaves
 * them hardly a say, in all columns. wrong: how many readings. Errors: _MEMORY, _NUMERICAL,
 * _CANCELLED. */
gonio_status gonio_i_wrong_directions_find(gonio_context *context, const gonio_i_subset *subset,
                                           gonio_i_column *columns, size_t count, size_t *wrong);

#endif
