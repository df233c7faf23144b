/* Kinematics of a sample on three axes before a fixed light, and a detector that turns about it.
 *
 * In the laboratory the light is towards +z, the axis of beta and delta is y. The sample's frame is
 * turned by R = R_y(beta) R_x(gamma) R_z(alpha), and the detector is at (sin delta, 0, cos delta).
 * So cos theta_i = cos gamma cos beta and cos theta_o = cos gamma cos(delta - beta). */
#include <math.h>

#include "instrument.h"

enum { ALPHA, BETA, GAMMA, DELTA };

static gonio_angles angles_of(const double v[3])
{
    const double across = hypot(v[0], v[1]);
    return (gonio_angles){atan2(across, v[2]),
                          across < 1e-12 ? 0.0 : gonio_i_azimuth(atan2(v[1], v[0]))};
}

/* A direction of the laboratory's horizontal plane, at an angle from the light, in the frame of the
 * sample: R' v. */
static gonio_angles seen_by_sample(const double *axis, double angle)
{
    const double x = sin(angle - axis[BETA]);
    const double z = cos(angle - axis[BETA]);
    const double y = sin(axis[GAMMA]) * z;
    const double v[3] = {cos(axis[ALPHA]) * x + sin(axis[ALPHA]) * y,
                         -sin(axis[ALPHA]) * x + cos(axis[ALPHA]) * y, cos(axis[GAMMA]) * z};
    return angles_of(v);
}

static gonio_pair pair_of(const gonio_instrument *instrument, const double *axis)
{
    (void)instrument;
    return (gonio_pair){seen_by_sample(axis, 0.0), seen_by_sample(axis, axis[DELTA])};
}

/* Cosine of the angle between both directions. */
static double cosine_between(const gonio_pair *pair)
{
    const gonio_angles i = pair->incident;
    const gonio_angles o = pair->outgoing;
    const double cosine = cos(i.theta) * cos(o.theta) +
                          sin(i.theta) * sin(o.theta) * cos(gonio_i_azimuth_difference(pair));
    return fmin(fmax(cosine, -1.0), 1.0);
}

/* beta of a delta. Light and detector in one direction leave it free: gamma is 0 then. */
static double tilt(const gonio_pair *pair, double delta)
{
    const double ratio = cos(pair->outgoing.theta) / cos(pair->incident.theta);
    return fabs(sin(delta)) < 1e-9 ? pair->incident.theta : atan((ratio - cos(delta)) / sin(delta));
}

/* Sets alpha so that the light comes from phi_i or, if it is on the normal, the detector is at
 * phi_o. */
static void turn(const gonio_pair *pair, double low, double axis[])
{
    axis[ALPHA] = 0.0;
    const bool pole = pair->incident.theta < GONIO_I_EDGE;
    const double phi = seen_by_sample(axis, pole ? axis[DELTA] : 0.0).phi;
    const double wanted = pole ? pair->outgoing.phi : pair->incident.phi;
    axis[ALPHA] = gonio_i_turn_into(phi - wanted, low);
}

/* Whether the azimuth from light to detector is that of the pair, not of its mirror image. */
static bool is_that(const gonio_pair *pair, const double axis[])
{
    const gonio_pair made = {seen_by_sample(axis, 0.0), seen_by_sample(axis, axis[DELTA])};
    const double wanted = gonio_i_azimuth_difference(pair);
    const double apart = fabs(gonio_i_azimuth_difference(&made) - wanted);
    return fmin(apart, 2.0 * M_PI - apart) < 1e-5 || fabs(sin(wanted)) < 1e-7;
}

static size_t settings_of(const gonio_instrument *instrument, gonio_pair pair, bool isotropic,
                          double axis[][GONIO_MOST_AXES])
{
    const gonio_axis *alpha = &instrument->axis[ALPHA];
    const double delta = acos(cosine_between(&pair));
    size_t count = 0;
    for (int k = 0; k < 4; k++) {
        double *a = axis[count];
        a[DELTA] = k < 2 ? delta : -delta;
        a[BETA] = tilt(&pair, a[DELTA]);
        a[GAMMA] = acos(fmin(cos(pair.incident.theta) / cos(a[BETA]), 1.0));
        a[GAMMA] *= k % 2 == 0 ? 1.0 : -1.0;
        a[ALPHA] = fmin(fmax(0.0, alpha->low), alpha->high);
        const bool found = is_that(&pair, a);
        if (!isotropic) {
            turn(&pair, alpha->low, a);
        }
        count += found;
    }
    return count;
}

const gonio_i_kinematics gonio_i_four_axis_kinematics = {
    .name = "four-axis",
    .summary = "the sample tilts (beta, gamma) and turns (alpha), the detector turns (delta)",
    .axis = {{"alpha", false}, {"beta", true}, {"gamma", true}, {"delta", true}},
    .incidence = -1,
    .pair = pair_of,
    .settings = settings_of,
};
