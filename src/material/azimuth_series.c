/* Fourier series of azimuths: see azimuth_series.h. */
#include "azimuth_series.h"

#include <math.h>

gonio_i_circle gonio_i_circle_of(size_t nodes)
{
    gonio_i_circle c = {.nodes = nodes};
    for (size_t n = 0; n < nodes; n++) {
        c.cosine[n] = cos(2.0 * M_PI * (double)n / (double)nodes);
        c.sine[n] = sin(2.0 * M_PI * (double)n / (double)nodes);
    }
    return c;
}

void gonio_i_circle_series(const gonio_i_circle *circle, const double *v, int orders,
                           double *coefficient)
{
    const size_t nodes = circle->nodes;
    for (int k = 0; k <= orders; k++) {
        double c = 0.0;
        double s = 0.0;
        for (size_t n = 0, place = 0; n < nodes; n++, place = (place + (size_t)k) % nodes) {
            c += v[n] * circle->cosine[place];
            s += v[n] * circle->sine[place];
        }
        coefficient[k == 0 ? 0 : 2 * k - 1] = (k == 0 ? 1.0 : 2.0) * c / (double)nodes;
        if (k > 0) {
            coefficient[2 * k] = 2.0 * s / (double)nodes;
        }
    }
}
