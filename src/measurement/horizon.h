/* Readings near the horizon that the instrument cut off or that are stray light. */
#ifndef GONIO_HORIZON_H
#define GONIO_HORIZON_H

#include "readings.h"

/* Marks readings with theta_o from 75 degrees on that cannot be the material's: less than a
 * twentieth of the median at their incidence, where a BRDF rises or stays; and, on the light's
 * side, more than 20 times both that median and the reading before them, nearer to the normal. Only
 * where an incidence has many readings. lost[count]; values are means over the channels. Errors:
 * _MEMORY. */
gonio_status gonio_i_horizon_find(gonio_context *context, const gonio_readings *readings,
                                  bool *lost);

#endif
