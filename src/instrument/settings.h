/* The settings that read a pair: see settings.c. */
#ifndef GONIO_SETTINGS_H
#define GONIO_SETTINGS_H

#include "instrument.h"

typedef struct gonio_i_settings {
    gonio_setting *setting; /* [most], the caller's */
    size_t most;
    size_t count;
    const char *obstacle; /* what keeps settings out, an axis only if nothing else does; or NULL */
} gonio_i_settings;

void gonio_i_find_settings(const gonio_instrument *instrument, gonio_pair pair,
                           gonio_freedom freedom, gonio_i_settings *s);

/* Whether an obstacle is the range of an axis. */
bool gonio_i_is_axis(const gonio_instrument *instrument, const char *obstacle);

/* The pair with the difference of azimuths negated. */
gonio_pair gonio_i_mirrored(gonio_pair pair);

#endif
