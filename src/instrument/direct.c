/* Kinematics whose axes are the polar angles and azimuths of light and detector themselves. */
#include <math.h>

#include "instrument.h"

enum { THETA_I, PHI_I, THETA_O, PHI_O };

static gonio_pair pair_of(const gonio_instrument *instrument, const double *axis)
{
    (void)instrument;
    return (gonio_pair){gonio_i_signed_direction(axis[THETA_I], axis[PHI_I]),
                        gonio_i_signed_direction(axis[THETA_O], axis[PHI_O])};
}

/* Azimuths of the axes, of which phi_o - phi_i is the given one to within whole turns, with phi_i
 * as near to 0 as the ranges allow. False if there are none. */
static bool turn_both(const gonio_instrument *instrument, double difference, double axis[])
{
    const gonio_axis *i = &instrument->axis[PHI_I];
    const gonio_axis *o = &instrument->axis[PHI_O];
    double nearest = INFINITY;
    for (int turns = -2; turns <= 2; turns++) {
        const double d = difference + 2.0 * M_PI * turns;
        const double low = fmax(i->low, o->low - d);
        const double high = fmin(i->high, o->high - d);
        const double phi_i = fmin(fmax(0.0, low), high);
        if (low <= high + GONIO_I_EDGE && fabs(phi_i) < nearest) {
            nearest = fabs(phi_i);
            axis[PHI_I] = phi_i;
            axis[PHI_O] = phi_i + d;
        }
    }
    return isfinite(nearest);
}

/* With the given signs of the polar angles. */
static bool solve(const gonio_instrument *instrument, const gonio_pair *pair, bool isotropic,
                  double sign_i, double sign_o, double axis[])
{
    const double turn_i = sign_i < 0.0 ? M_PI : 0.0;
    const double turn_o = sign_o < 0.0 ? M_PI : 0.0;
    axis[THETA_I] = sign_i * pair->incident.theta;
    axis[THETA_O] = sign_o * pair->outgoing.theta;
    if (isotropic) {
        return turn_both(instrument, gonio_i_azimuth_difference(pair) + turn_o - turn_i, axis);
    }
    axis[PHI_I] = gonio_i_turn_into(pair->incident.phi - turn_i, instrument->axis[PHI_I].low);
    axis[PHI_O] = gonio_i_turn_into(pair->outgoing.phi - turn_o, instrument->axis[PHI_O].low);
    return true;
}

static size_t settings_of(const gonio_instrument *instrument, gonio_pair pair, bool isotropic,
                          double axis[][GONIO_MOST_AXES])
{
    static const double signs[4][2] = {{1.0, 1.0}, {1.0, -1.0}, {-1.0, 1.0}, {-1.0, -1.0}};
    size_t count = 0;
    for (int k = 0; k < 4; k++) {
        count += solve(instrument, &pair, isotropic, signs[k][0], signs[k][1], axis[count]);
    }
    return count;
}

const gonio_i_kinematics gonio_i_direct_kinematics = {
    .name = "direct",
    .summary = "the axes are the polar angles and azimuths of light and detector",
    .axis = {{"theta_i", true}, {"phi_i", false}, {"theta_o", true}, {"phi_o", false}},
    .incidence = THETA_I,
    .pair = pair_of,
    .settings = settings_of,
};
