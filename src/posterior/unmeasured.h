/* Readings of nothing: zeros and floors where the other readings are bright.
 *
 * Where the detector hides the light, towards the light and about it, and where a beam leaves the
 * detector's field, files have 0 or the smallest number that the instrument writes. A BRDF has
 * narrow peaks, and no narrow holes. So a reading that is far below what the others predict, in all
 * channels, is not one. */
#ifndef GONIO_UNMEASURED_H
#define GONIO_UNMEASURED_H

#include "observations.h"

/* Takes such readings out of the columns, which are corrected for a dark level if there is one, and
 * counts them in the interpretation. None is taken if there are too many for that. With a joint
 * basis none is looked for. Errors: _MEMORY, _NUMERICAL.
 */
gonio_status gonio_i_unmeasured_leave_out(gonio_context *context, const gonio_i_prior *prior,
                                          const gonio_readings *readings, gonio_i_columns *columns,
                                          gonio_interpretation *interpretation);

#endif
