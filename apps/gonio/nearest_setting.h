/* The setting of an instrument that reads a direction soonest. */
#ifndef GONIO_NEAREST_SETTING_H
#define GONIO_NEAREST_SETTING_H

#include <gonio/instrument.h>

/* All settings that read a pair as it is, otherwise turned about the normal, otherwise its mirror
 * image: found[GONIO_MOST_SETTINGS]. Returns how many. */
size_t nearest_candidates(const gonio_instrument *instrument, gonio_pair pair,
                          gonio_setting *found);

/* The one of them that is reached soonest from another setting. False if there is none. */
bool nearest_setting(const gonio_instrument *instrument, gonio_pair pair, const gonio_setting *from,
                     gonio_setting *setting);

/* What keeps an instrument from reading a pair; NULL if nothing does. */
const char *nearest_obstacle(const gonio_instrument *instrument, gonio_pair pair);

#endif
