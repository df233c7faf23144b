/* Many readings as fewer: neighbours become one.
 *
 * The posterior holds the covariance of a column's readings, n x n. Of more than it can hold, those
 * that share a cell of a lattice in the coordinates in which the remainder is smooth
 * (gonio_i_place) are merged into one observation, as is usual for dense observations of smooth
 * fields ("superobservations"; Lorenc 1981): their mean weighted by 1/variance, at the one nearest
 * to their middle. Noise averages out, what the model leaves open inside a cell does not. Bounds
 * are merged with bounds of the same kind only. The lattice is the finest, in steps of 1.2, by
 * which few enough are left; cells of 1/20 of the remainder's length, half a bin of theta_h, at
 * least. */
#ifndef GONIO_MERGE_H
#define GONIO_MERGE_H

#include "posterior.h"

/* merged: a new column of at most `most` observations (of a few dozen if that is less: bounds and
 * channels stay apart); merged->observation belongs to the caller.
 * Errors: _MEMORY. */
gonio_status gonio_i_merge(gonio_context *context, const gonio_i_column *column, size_t most,
                           gonio_i_column *merged);

#endif
