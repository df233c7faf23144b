/* Where a material is not as its readings let expect. */
#ifndef GONIO_ODD_PLACES_H
#define GONIO_ODD_PLACES_H

#include "expected_error_choices.h"

/* Multiplies each row of p->f by s, where
 *
 *     s^2 = (o + sum_i w_i o_i)/(o + o sum_i w_i),   w_i = exp(-|p - p_i|^2/2),
 *
 * o_i is the oddity of reading i, at most 9, and o the mean of these. So errors of the same kind as
 * were found are expected near the readings that the others predicted badly. Errors: _MEMORY. */
gonio_status gonio_i_expect_more_of_odd_places(gonio_i_choices *p);

#endif
