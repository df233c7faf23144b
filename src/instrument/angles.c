/* Angles that axes of either sign and any number of turns make. */
#include <math.h>

#include "instrument.h"

double gonio_i_azimuth(double phi)
{
    const double turned = fmod(phi, 2.0 * M_PI);
    const double positive = turned < 0.0 ? turned + 2.0 * M_PI : turned;
    return positive < 2.0 * M_PI ? positive + 0.0 : 0.0; /* no -0 */
}

gonio_angles gonio_i_signed_direction(double theta, double phi)
{
    return (gonio_angles){fabs(theta), gonio_i_azimuth(theta < 0.0 ? phi + M_PI : phi)};
}

double gonio_i_turn_into(double angle, double low)
{
    const double turns = ceil((low - GONIO_I_EDGE - angle) / (2.0 * M_PI));
    return angle + 2.0 * M_PI * turns;
}

double gonio_i_azimuth_difference(const gonio_pair *pair)
{
    const bool pole = pair->incident.theta < GONIO_I_EDGE || pair->outgoing.theta < GONIO_I_EDGE;
    return pole ? 0.0 : gonio_i_azimuth(pair->outgoing.phi - pair->incident.phi);
}
