/* The samples of an RGL .bsdf: see rgl_samples.h; rgl.c has the equations. */
#include "rgl_samples.h"

#include <math.h>

#include "rgl_places.h"

size_t gonio_i_rgl_sample_count(const gonio_i_rgl *rgl)
{
    return rgl->phis * rgl->thetas * rgl->side * rgl->side;
}

/* A bit for each sample, the highest of a byte first. */
static bool flag_of(const gonio_i_rgl *rgl, size_t k)
{
    return rgl->valid == NULL || k / 8 >= rgl->valid_size ||
           (rgl->valid[k / 8] & (0x80U >> (k % 8))) != 0;
}

static double from_zero(double phi)
{
    return phi - 2.0 * M_PI * floor(phi / (2.0 * M_PI));
}

/* What values are to be multiplied by for rho. */
static double factor_of(const gonio_i_rgl *rgl, const double u[2], gonio_angles incident,
                        double cosine_o)
{
    const double area =
        gonio_i_rgl_image_at(&rgl->sigma, gonio_i_rgl_place_of_theta(incident.theta),
                             gonio_i_rgl_place_of_phi(incident.phi));
    const double normals = gonio_i_rgl_image_at(&rgl->ndf, u[0], u[1]);
    return (rgl->jacobian ? normals / (4.0 * area) : 1.0) / cosine_o;
}

/* Where a sample is, by the one incidence that it belongs to. u: where it is among half vectors. */
static gonio_i_rgl_mirrored place_of(const gonio_i_rgl *rgl, size_t slice, size_t node, double u[2])
{
    const size_t row = node / rgl->side;
    const size_t column = node % rgl->side;
    const double last = (double)(rgl->side - 1);
    const double s[2] = {(double)column / last, (double)row / last};
    const gonio_i_blend blend = {.count = 1, .slice = {slice}, .weight = {1.0}};
    gonio_i_warp_sample(&rgl->vndf, &blend, s, u);
    /* Of anisotropic materials u holds the azimuth itself, which the mirror counts from the light.
     */
    const double turn = rgl->isotropic ? 0.0 : rgl->phi[slice / rgl->thetas] / (2.0 * M_PI);
    return gonio_i_rgl_mirror(rgl->theta[slice % rgl->thetas], u[0], u[1] - turn);
}

gonio_i_rgl_sample gonio_i_rgl_sample_of(const gonio_i_rgl *rgl, size_t k, double *value)
{
    const size_t nodes = rgl->side * rgl->side;
    const size_t slice = k / nodes;
    const size_t node = k % nodes;
    const gonio_angles incident = {rgl->theta[slice % rgl->thetas], rgl->phi[slice / rgl->thetas]};
    double u[2];
    const gonio_i_rgl_mirrored to = place_of(rgl, slice, node, u);
    const double factor = factor_of(rgl, u, incident, to.cosine_o);
    for (size_t c = 0; c < rgl->channels; c++) {
        const double held = (double)rgl->value[(slice * rgl->channels + c) * nodes + node] * factor;
        value[c] = held >= 0.0 && to.cosine_o > 0.0 && isfinite(held) ? held : NAN;
    }
    return (gonio_i_rgl_sample){
        .pair = {{incident.theta, from_zero(incident.phi)},
                 {to.outgoing.theta, from_zero(to.outgoing.phi + incident.phi)}},
        .flag = flag_of(rgl, k)};
}

bool gonio_i_rgl_flag_of_measured(const gonio_i_rgl *rgl)
{
    const size_t nodes = rgl->side * rgl->side;
    size_t above[2] = {0, 0}; /* samples above the horizon, by their flags */
    for (size_t k = 0; k < gonio_i_rgl_sample_count(rgl); k++) {
        double u[2];
        above[flag_of(rgl, k)] += place_of(rgl, k / nodes, k % nodes, u).cosine_o > 0.0;
    }
    return above[true] >= above[false];
}
