/* Kinematics of a light arm and a detector arm that swings in a plane of any azimuth. */
#include "two_arms.h"

#include <math.h>

enum { INCIDENCE, AZIMUTH, RECEIVE, STAGE };

gonio_pair gonio_i_arms_pair(const gonio_i_arms *arms)
{
    return (gonio_pair){
        gonio_i_signed_direction(arms->incidence, -arms->stage),
        gonio_i_signed_direction(arms->receive, M_PI + arms->azimuth - arms->stage)};
}

size_t gonio_i_arms_of_pair(const gonio_pair *pair, bool isotropic, double rest,
                            gonio_i_arms arms[])
{
    const double difference =
        isotropic ? gonio_i_azimuth_difference(pair) : pair->outgoing.phi - pair->incident.phi;
    size_t count = 0;
    for (int side = 0; side < 2; side++) {
        const double turn = side == 0 ? 0.0 : M_PI; /* the light at a negative incidence */
        for (int over = 0; over < 2; over++) {      /* the detector beyond the normal */
            const double stage = isotropic ? rest : turn - pair->incident.phi;
            const double azimuth = difference + turn - (over == 0 ? M_PI : 0.0);
            arms[count++] = (gonio_i_arms){(side == 0 ? 1.0 : -1.0) * pair->incident.theta, azimuth,
                                           (over == 0 ? 1.0 : -1.0) * pair->outgoing.theta, stage};
        }
    }
    return count;
}

static gonio_pair pair_of(const gonio_instrument *instrument, const double *axis)
{
    (void)instrument;
    return gonio_i_arms_pair(
        &(gonio_i_arms){axis[INCIDENCE], axis[AZIMUTH], axis[RECEIVE], axis[STAGE]});
}

static size_t settings_of(const gonio_instrument *instrument, gonio_pair pair, bool isotropic,
                          double axis[][GONIO_MOST_AXES])
{
    const gonio_axis *stage = &instrument->axis[STAGE];
    const double rest = fmin(fmax(0.0, stage->low), stage->high);
    gonio_i_arms arms[4];
    const size_t count = gonio_i_arms_of_pair(&pair, isotropic, rest, arms);
    for (size_t k = 0; k < count; k++) {
        axis[k][INCIDENCE] = arms[k].incidence;
        axis[k][AZIMUTH] = gonio_i_turn_into(arms[k].azimuth, instrument->axis[AZIMUTH].low);
        axis[k][RECEIVE] = arms[k].receive;
        axis[k][STAGE] = gonio_i_turn_into(arms[k].stage, stage->low);
    }
    return count;
}

const gonio_i_kinematics gonio_i_arms_kinematics = {
    .name = "arms",
    .summary = "a light arm, and a detector arm in a plane that turns about the normal",
    .axis = {{"incidence", true}, {"azimuth", true}, {"receive", true}, {"stage", false}},
    .incidence = INCIDENCE,
    .pair = pair_of,
    .settings = settings_of,
};
