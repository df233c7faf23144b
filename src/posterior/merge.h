/* Merging of neighbouring readings ("superobservations"; Lorenc 1981).
 *
 * The posterior stores the covariance of a column's readings, n x n. If there are too many,
 * readings in one cell of a lattice in the coordinates of the remainder (gonio_i_place) are merged
 * into one observation: their mean weighted by 1/variance, at the reading nearest to their middle.
 * Noise averages out. The variation inside a cell does not. Bounds are merged with bounds of the
 * same kind only. The lattice is the finest, in steps of 1.2, that leaves few enough observations.
 * Its cells are at least 1/20 of the remainder's length scale, half a bin of theta_h. */
#ifndef GONIO_MERGE_H
#define GONIO_MERGE_H

#include "posterior.h"

/* merged: a new column of at most `most` observations (of a few dozen if that is less: bounds and
 * channels stay apart); merged->observation belongs to the caller.
 * Errors: _MEMORY. */
gonio_status gonio_i_merge(gonio_context *context, const gonio_i_column *column, size_t most,
                           gonio_i_column *merged);

/* Merges readings of one place only, to a fiftieth of the FINEST lattice: repeats, on a turned
 * sample too. They share the error of the model, so that n of them count as one whose noise is
 * smaller. A column without such readings is copied, in its order. Otherwise as gonio_i_merge. */
gonio_status gonio_i_merge_repeats(gonio_context *context, const gonio_i_column *column,
                                   gonio_i_column *merged);

#endif
