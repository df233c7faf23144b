/* The prior of anisotropic materials: see stretch.h. */
#include "stretch.h"

#include <math.h>

#include "../core/random.h"

/* Of q, where t is (sin theta_h)^(1/2). */
static const double LENGTH = 0.7;

/* Of theta_d in q of fibres, radians. */
static const double DEPTH = 1.5;

/* Of theta_h in the density of facets: towards the horizon other things reflect more. */
static const double LEAST_COSINE = 0.01;

/* The stretch ends here, so that the horizon stays where it is. */
static const double MOST_TANGENT = 1e6;

typedef struct vector {
    double x, y, z;
} vector;

static vector vector_of(gonio_angles a)
{
    return (vector){sin(a.theta) * cos(a.phi), sin(a.theta) * sin(a.phi), cos(a.theta)};
}

gonio_i_oriented gonio_i_oriented_of(gonio_pair pair)
{
    const vector i = vector_of(pair.incident);
    const vector o = vector_of(pair.outgoing);
    const double x = i.x + o.x;
    const double y = i.y + o.y;
    const gonio_half_difference at = gonio_half_difference_from_pair(pair);
    return (gonio_i_oriented){at, at.theta_h > 0.0 ? atan2(y, x) : 0.0};
}

void gonio_i_oriented_sample(uint64_t seed, size_t count, gonio_i_oriented *place)
{
    gonio_i_random random;
    gonio_i_random_seed(&random, seed, 0);
    for (size_t found = 0; found < count;) {
        const int32_t index = (int32_t)gonio_i_random_below(&random, GONIO_BINS);
        const gonio_bin bin = gonio_bin_from_index(index);
        const double phi_h = 2.0 * M_PI * gonio_i_random_uniform(&random);
        if (gonio_bin_is_valid(bin)) {
            place[found++] = (gonio_i_oriented){gonio_bin_centre(bin), phi_h};
        }
    }
}

static gonio_angles turned(gonio_angles a, double angle)
{
    const double whole = 2.0 * M_PI;
    const double phi = fmod(a.phi + angle, whole);
    return (gonio_angles){a.theta, phi < 0.0 ? phi + whole : phi};
}

gonio_pair gonio_i_oriented_pair(gonio_i_oriented here)
{
    const gonio_pair pair = gonio_pair_from_half_difference(here.at);
    return (gonio_pair){turned(pair.incident, here.phi_h), turned(pair.outgoing, here.phi_h)};
}

bool gonio_i_stretch_is_isotropic(const gonio_i_stretch *stretch)
{
    return stretch->log_ratio == 0.0 && stretch->symmetry == 0;
}

gonio_half_difference gonio_i_stretch_apply(const gonio_i_stretch *stretch, gonio_i_oriented here)
{
    if (stretch->log_ratio == 0.0 || stretch->fibres) {
        return here.at;
    }
    const double ratio = exp(stretch->log_ratio);
    const double c = cos(here.phi_h - stretch->rotation);
    const double s = sin(here.phi_h - stretch->rotation);
    const double tangent = tan(here.at.theta_h) * sqrt(ratio * c * c + s * s / ratio);
    gonio_half_difference there = here.at;
    there.theta_h = tangent >= 0.0 ? atan(fmin(tangent, MOST_TANGENT)) : 0.5 * M_PI;
    return there;
}

double gonio_i_stretch_log_factor(const gonio_i_stretch *stretch, gonio_i_oriented here)
{
    if (!stretch->facets) {
        return 0.0;
    }
    const double there = cos(gonio_i_stretch_apply(stretch, here).theta_h);
    return 4.0 * log(fmax(there, LEAST_COSINE) / fmax(cos(here.at.theta_h), LEAST_COSINE));
}

/* Values below 0, which noise makes, are multiplied too. */
double gonio_i_multiplied(double g, double log_factor, double *slope)
{
    if (log_factor == 0.0) {
        *slope = 1.0;
        return g;
    }
    const double factor = exp(log_factor);
    const double value = expm1(fabs(g));
    *slope = factor * (1.0 + value) / (1.0 + factor * value);
    return copysign(log1p(factor * value), g);
}

/* Where the half vector's azimuth is taken to, from that of the grain. */
static double azimuth_from_grain(const gonio_i_stretch *stretch, double phi_h)
{
    const double root = exp(0.5 * stretch->log_ratio);
    const double phi = phi_h - stretch->rotation;
    return atan2(sin(phi) / root, cos(phi) * root);
}

/* i + o has the length 2 cos theta_d. */
static gonio_i_azimuth_point fibres_point(const gonio_i_stretch *stretch, gonio_i_oriented here)
{
    const double root = exp(0.5 * stretch->log_ratio);
    const double length = 2.0 * cos(here.at.theta_d) * sin(here.at.theta_h) / LENGTH;
    const double along = root * length * cos(here.phi_h - stretch->rotation);
    const double across = length * sin(here.phi_h - stretch->rotation) / root;
    return (gonio_i_azimuth_point){stretch->symmetry == 2 ? fabs(along) : along, fabs(across),
                                   here.at.theta_d / DEPTH};
}

gonio_i_azimuth_point gonio_i_azimuth_of(const gonio_i_stretch *stretch, gonio_i_oriented here)
{
    if (stretch->fibres) {
        return fibres_point(stretch, here);
    }
    const int n = stretch->symmetry;
    const double theta = gonio_i_stretch_apply(stretch, here).theta_h;
    const double t = n > 0 ? sqrt(fmax(sin(theta), 0.0)) / LENGTH : 0.0;
    const double phi = n * azimuth_from_grain(stretch, here.phi_h);
    const double y = t * sin(phi);
    return (gonio_i_azimuth_point){t * cos(phi), stretch->mirrored ? fabs(y) : y, 0.0};
}

double gonio_i_azimuth_kernel(gonio_i_azimuth_point a, gonio_i_azimuth_point b)
{
    const double x = a.x - b.x;
    const double y = a.y - b.y;
    const double depth = a.depth - b.depth;
    return exp(-0.5 * (x * x + y * y + depth * depth));
}

double gonio_i_stretch_remainder(const gonio_i_stretch *stretch, const gonio_i_place *a,
                                 const gonio_i_place *b, double peak, double retro)
{
    const double k = gonio_i_remainder(a, b, peak, retro);
    return stretch->fibres ? 1.0 + k - gonio_i_smooth(a, b) : k;
}
