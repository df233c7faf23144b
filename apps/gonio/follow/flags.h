/* What the instrument's limits say of a new reading: saturated, at or below the dark level. */
#ifndef GONIO_FOLLOW_FLAGS_H
#define GONIO_FOLLOW_FLAGS_H

#include "follower.h"

/* Sets the limits by the options and the instrument, and the noise that readings are judged by. */
void follow_set_limits(follower *f, posterior_options *judged);

/* Warns, once, if the instrument states other values than the readings were taken for. */
void follow_check_values(follower *f, const gonio_readings *readings);

/* Looks at the row that came last: notes what is unusual, and asks for a repeat. */
void follow_flag(follower *f);

#endif
