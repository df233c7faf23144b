/* The apertures of light and detector, as directions of equal weight. */
#include <math.h>

#include "instrument.h"

static size_t directions_of(double half_angle, int rings)
{
    const size_t r = (size_t)rings;
    return half_angle > 0.0 ? 1 + 3 * r * (r + 1) : 1;
}

static int valid_rings(int rings)
{
    return rings < 0 ? 0 : rings > GONIO_MOST_APERTURE_RINGS ? GONIO_MOST_APERTURE_RINGS : rings;
}

size_t gonio_i_aperture_directions(gonio_i_aperture aperture)
{
    return directions_of(aperture.half_angle, valid_rings(aperture.rings));
}

size_t gonio_instrument_aperture_samples(const gonio_instrument *instrument, int rings)
{
    return directions_of(instrument->view.source_aperture, valid_rings(rings)) *
           directions_of(instrument->view.detector_aperture, valid_rings(rings));
}

/* A direction at a small angle from another, on its side `turn`. */
static gonio_angles beside(gonio_angles centre, double away, double turn)
{
    const double x = sin(away) * cos(turn);
    const double y = sin(away) * sin(turn);
    const double z = cos(away);
    const double along = x * cos(centre.theta) + z * sin(centre.theta);
    const double up = z * cos(centre.theta) - x * sin(centre.theta);
    const double across = hypot(along, y);
    return (gonio_angles){atan2(across, up),
                          gonio_i_azimuth(centre.phi + (across > 0.0 ? atan2(y, along) : 0.0))};
}

/* Rings of equal area for each direction: 1, 6, 12 ... directions within
 * ((1 + 3 j (j + 1))/all)^(1/2) of the half angle, each at the root mean square of its ring. */
static size_t cover(gonio_angles centre, double half_angle, int rings, gonio_angles *direction)
{
    const size_t all = directions_of(half_angle, rings);
    size_t count = 0;
    direction[count++] = centre;
    double inner = 1.0;
    for (int ring = 1; count < all; ring++) {
        const double outer = inner + 6.0 * ring;
        const double away = half_angle * sqrt(0.5 * (inner + outer) / (double)all);
        for (int k = 0; k < 6 * ring; k++) {
            direction[count++] = beside(centre, away, 2.0 * M_PI * (k + 0.5) / (6.0 * ring));
        }
        inner = outer;
    }
    return count;
}

size_t gonio_i_through_apertures(gonio_i_aperture source, gonio_i_aperture detector,
                                 gonio_pair pair, gonio_pair *sample)
{
    gonio_angles light[GONIO_I_MOST_APERTURE_DIRECTIONS];
    gonio_angles seen[GONIO_I_MOST_APERTURE_DIRECTIONS];
    const size_t lights = cover(pair.incident, source.half_angle, valid_rings(source.rings), light);
    const size_t detectors =
        cover(pair.outgoing, detector.half_angle, valid_rings(detector.rings), seen);
    size_t count = 0;
    for (size_t i = 0; i < lights; i++) {
        for (size_t o = 0; o < detectors; o++) {
            const bool above =
                light[i].theta < 0.5 * M_PI - 1e-9 && seen[o].theta < 0.5 * M_PI - 1e-9;
            if (above) {
                sample[count++] = (gonio_pair){light[i], seen[o]};
            }
        }
    }
    if (count == 0) {
        sample[count++] = pair;
    }
    return count;
}

size_t gonio_instrument_aperture(const gonio_instrument *instrument, gonio_pair pair, int rings,
                                 gonio_pair *sample)
{
    const gonio_i_aperture source = {instrument->view.source_aperture, rings};
    const gonio_i_aperture detector = {instrument->view.detector_aperture, rings};
    return gonio_i_through_apertures(source, detector, pair, sample);
}
