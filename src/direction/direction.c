/* Half/difference coordinates of directions and back (Rusinkiewicz 1998). */
#include <gonio/direction.h>

#include <math.h>

typedef struct vector {
    double x, y, z;
} vector;

static vector vector_from_angles(gonio_angles a)
{
    return (vector){sin(a.theta) * cos(a.phi), sin(a.theta) * sin(a.phi), cos(a.theta)};
}

static gonio_angles angles_from_vector(vector v)
{
    const double sine = hypot(v.x, v.y);
    double phi = sine > 0.0 ? atan2(v.y, v.x) : 0.0;
    if (phi < 0.0) {
        phi += 2.0 * M_PI;
    }
    return (gonio_angles){atan2(sine, v.z), phi < 2.0 * M_PI ? phi : 0.0};
}

/* Reciprocity: phi_d and phi_d + pi are the same sample. */
static double fold_phi_d(double phi)
{
    phi = fmod(phi, M_PI);
    if (phi < 0.0) {
        phi += M_PI;
    }
    return phi < M_PI ? phi : 0.0;
}

gonio_half_difference gonio_half_difference_from_pair(gonio_pair pair)
{
    const vector i = vector_from_angles(pair.incident);
    const vector o = vector_from_angles(pair.outgoing);
    const vector sum = {i.x + o.x, i.y + o.y, i.z + o.z};
    const double sine_h = hypot(sum.x, sum.y);
    if (hypot(sine_h, sum.z) < 1e-14) { /* opposite directions: no half vector */
        return (gonio_half_difference){0.0, M_PI / 2.0, 0.0};
    }
    const double theta_h = atan2(sine_h, sum.z);
    const double phi_h = sine_h > 0.0 ? atan2(sum.y, sum.x) : 0.0;
    const vector r = {cos(phi_h) * i.x + sin(phi_h) * i.y, cos(phi_h) * i.y - sin(phi_h) * i.x,
                      i.z};
    const vector d = {cos(theta_h) * r.x - sin(theta_h) * r.z, r.y,
                      sin(theta_h) * r.x + cos(theta_h) * r.z};
    const double sine_d = hypot(d.x, d.y);
    const double phi_d = sine_d > 0.0 ? fold_phi_d(atan2(d.y, d.x)) : 0.0;
    return (gonio_half_difference){theta_h, fmin(atan2(sine_d, d.z), M_PI / 2.0), phi_d};
}

gonio_pair gonio_pair_from_half_difference(gonio_half_difference c)
{
    const vector h = {sin(c.theta_h), 0.0, cos(c.theta_h)};
    const vector d = vector_from_angles((gonio_angles){c.theta_d, c.phi_d});
    const vector i = {h.z * d.x + h.x * d.z, d.y, h.z * d.z - h.x * d.x};
    const double twice = 2.0 * d.z; /* i . h = cos theta_d */
    const vector o = {twice * h.x - i.x, -i.y, twice * h.z - i.z};
    return (gonio_pair){angles_from_vector(i), angles_from_vector(o)};
}

void gonio_cosines(gonio_half_difference c, double *incident, double *outgoing)
{
    const double even = cos(c.theta_h) * cos(c.theta_d);
    const double odd = sin(c.theta_h) * sin(c.theta_d) * cos(c.phi_d);
    *incident = even - odd;
    *outgoing = even + odd;
}
