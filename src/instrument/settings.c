/* The settings of an instrument that read a pair of directions, or what tells the same. */
#include <math.h>
#include <string.h>

#include "settings.h"

/* What is this near to a direction of a table counts as reached, rad. */
static const double BETWEEN_ROWS = 7.5 * M_PI / 180.0;

gonio_pair gonio_i_mirrored(gonio_pair pair)
{
    pair.outgoing.phi = gonio_i_azimuth(2.0 * pair.incident.phi - pair.outgoing.phi);
    return pair;
}

static gonio_pair exchanged(gonio_pair pair)
{
    return (gonio_pair){pair.outgoing, pair.incident};
}

bool gonio_i_is_axis(const gonio_instrument *instrument, const char *obstacle)
{
    bool found = false;
    for (size_t k = 0; k < instrument->view.axes; k++) {
        found = found || instrument->axis[k].name == obstacle;
    }
    return found;
}

static bool is_listed(const gonio_setting *setting, size_t count, const gonio_setting *one,
                      size_t axes)
{
    for (size_t s = 0; s < count; s++) {
        double away = 0.0;
        for (size_t k = 0; k < axes; k++) {
            away = fmax(away, fabs(setting[s].axis[k] - one->axis[k]));
        }
        if (away < GONIO_I_EDGE) {
            return true;
        }
    }
    return false;
}

/* Adds the settings of a pair that can be used. */
static void add(const gonio_instrument *instrument, gonio_pair pair, bool isotropic,
                gonio_i_settings *s)
{
    double axis[GONIO_I_MOST_SOLUTIONS][GONIO_MOST_AXES] = {{0.0}};
    const size_t found = instrument->kinematics->settings(instrument, pair, isotropic, axis);
    for (size_t k = 0; k < found && s->count < s->most; k++) {
        gonio_setting one;
        memcpy(one.axis, axis[k], sizeof one.axis);
        const char *obstacle = gonio_i_take_position(instrument, &one);
        if (obstacle != NULL) {
            const bool tells_more = s->obstacle == NULL || !gonio_i_is_axis(instrument, obstacle);
            s->obstacle = tells_more ? obstacle : s->obstacle;
        } else if (!is_listed(s->setting, s->count, &one, instrument->view.axes)) {
            s->setting[s->count++] = one;
        }
    }
}

void gonio_i_find_settings(const gonio_instrument *instrument, gonio_pair pair,
                           gonio_freedom freedom, gonio_i_settings *s)
{
    const bool exchange = freedom.reciprocal && instrument->view.reciprocal;
    s->count = 0;
    s->obstacle = NULL;
    for (int way = 0; way < (exchange ? 2 : 1); way++) {
        const gonio_pair one = way == 0 ? pair : exchanged(pair);
        add(instrument, one, freedom.isotropic, s);
        if (freedom.isotropic && freedom.bilateral) {
            add(instrument, gonio_i_mirrored(one), true, s);
        }
    }
}

size_t gonio_instrument_settings(const gonio_instrument *instrument, gonio_pair pair,
                                 gonio_freedom freedom, gonio_setting *setting, size_t most)
{
    gonio_i_settings s = {.setting = setting, .most = most};
    gonio_i_find_settings(instrument, pair, freedom, &s);
    return s.count;
}

const char *gonio_instrument_region_obstacle(const gonio_instrument *instrument, gonio_pair pair,
                                             gonio_freedom freedom)
{
    gonio_instrument between = *instrument;
    for (size_t k = 0; k < between.view.axes; k++) {
        between.axis[k].positions = 0;
    }
    between.same_row = BETWEEN_ROWS;
    return gonio_instrument_pair_obstacle(&between, pair, freedom);
}

const char *gonio_instrument_pair_obstacle(const gonio_instrument *instrument, gonio_pair pair,
                                           gonio_freedom freedom)
{
    gonio_setting one;
    gonio_i_settings s = {.setting = &one, .most = 1};
    gonio_i_find_settings(instrument, pair, freedom, &s);
    return s.count > 0 ? NULL : s.obstacle != NULL ? s.obstacle : "kinematics";
}
