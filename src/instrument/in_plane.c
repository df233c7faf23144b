/* Kinematics of a light and a detector in one plane with the normal. */
#include "two_arms.h"

#include <math.h>

enum { INCIDENCE, DETECTOR, SAMPLE };

/* A direction this near to the plane is in it, rad. */
static const double NEAR_PLANE = 1e-3;

static gonio_pair pair_of(const gonio_instrument *instrument, const double *axis)
{
    (void)instrument;
    return gonio_i_arms_pair(&(gonio_i_arms){axis[INCIDENCE], 0.0, axis[DETECTOR], axis[SAMPLE]});
}

static size_t settings_of(const gonio_instrument *instrument, gonio_pair pair, bool isotropic,
                          double axis[][GONIO_MOST_AXES])
{
    const gonio_axis *sample = &instrument->axis[SAMPLE];
    const double rest = fmin(fmax(0.0, sample->low), sample->high);
    gonio_i_arms arms[4];
    const size_t all = gonio_i_arms_of_pair(&pair, isotropic, rest, arms);
    size_t count = 0;
    for (size_t k = 0; k < all; k++) {
        const double away = gonio_i_turn_into(arms[k].azimuth, -M_PI);
        if (fabs(away) * sin(pair.outgoing.theta) < NEAR_PLANE) {
            axis[count][INCIDENCE] = arms[k].incidence;
            axis[count][DETECTOR] = arms[k].receive;
            axis[count][SAMPLE] = gonio_i_turn_into(arms[k].stage, sample->low);
            count++;
        }
    }
    return count;
}

const gonio_i_kinematics gonio_i_in_plane_kinematics = {
    .name = "in-plane",
    .summary = "light and detector in one plane with the normal, at angles of either sign",
    .axis = {{"incidence", true}, {"detector", true}, {"sample", false}},
    .incidence = INCIDENCE,
    .pair = pair_of,
    .settings = settings_of,
};
