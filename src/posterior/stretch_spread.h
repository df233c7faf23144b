/* What readings leave open of a stretch: stretches around one, in place of it. */
#ifndef GONIO_STRETCH_SPREAD_H
#define GONIO_STRETCH_SPREAD_H

#include "stretch_trials.h"

enum { GONIO_I_SPREAD = 9 };

/* Three ratios times three azimuths of the grain, around[GONIO_I_SPREAD]. They share the weight (a
 * logarithm) of h out as predictions of the readings do. The steps are those that the readings just
 * tell apart. Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_stretch_spread(gonio_i_search *s, const gonio_i_hypothesis *h,
                                    gonio_i_hypothesis *around);

/* A step in the ratio or in the azimuth. The ratio of the axes stays at least 1: beyond 1 the grain
 * is a quarter turn from where it was. */
gonio_i_stretch gonio_i_stretch_moved(gonio_i_stretch from, double ratio, double rotation);

#endif
