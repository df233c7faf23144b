/* The setting that reads a direction soonest: see nearest_setting.h. */
#include "nearest_setting.h"

#include <math.h>

/* The freedom that is used, the least first. */
static const gonio_freedom freedoms[] = {
    {false, false, false}, {true, false, false}, {true, true, false}};
enum { FREEDOMS = sizeof freedoms / sizeof *freedoms };

size_t nearest_candidates(const gonio_instrument *instrument, gonio_pair pair, gonio_setting *found)
{
    size_t count = 0;
    for (size_t k = 0; k < FREEDOMS && count == 0; k++) {
        count =
            gonio_instrument_settings(instrument, pair, freedoms[k], found, GONIO_MOST_SETTINGS);
    }
    return count;
}

bool nearest_setting(const gonio_instrument *instrument, gonio_pair pair, const gonio_setting *from,
                     gonio_setting *setting)
{
    gonio_setting found[GONIO_MOST_SETTINGS];
    const size_t count = nearest_candidates(instrument, pair, found);
    double least = INFINITY;
    for (size_t k = 0; k < count; k++) {
        const double time = gonio_instrument_travel(instrument, from, &found[k]);
        if (time < least) {
            least = time;
            *setting = found[k];
        }
    }
    return count > 0;
}

const char *nearest_obstacle(const gonio_instrument *instrument, gonio_pair pair)
{
    return gonio_instrument_pair_obstacle(instrument, pair, freedoms[FREEDOMS - 1]);
}
