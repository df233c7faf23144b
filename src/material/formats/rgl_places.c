/* The density of the places of an RGL .bsdf: higher where its values bend.
 *
 * Between nodes at a distance h, linear interpolation of values V along u errs by up to
 * h^2 V''/8; in log space, g = ln(1 + rho/s), by h^2 (V''/V) rho/(rho + s)/8. With h = 1/density,
 * the sum of squared errors is least if the density is proportional to (their mean square)^(1/5). A
 * share of the places is evenly spaced, for directions that the means do not include. */
#include "rgl_places.h"

#include <math.h>
#include <stdlib.h>

#include "../../core/core.h"
#include "../warp.h"
#include "merl.h"

enum {
    NORMALS = GONIO_I_RGL_NORMALS,
    FINE = 512, /* steps along u that V'' is found from */
    INCIDENCES = 6,
    AZIMUTHS = 5
};

static const double incidence[INCIDENCES] = {5.0, 25.0, 45.0, 60.0, 70.0, 76.0}; /* degrees */

/* Towards the light, beside it, away from it. */
static const double azimuth[AZIMUTHS] = {0.5, 0.375, 0.25, 0.125, 0.0}; /* v */

static const double EVEN = 0.25; /* share of the places */

static const double LOWEST = 1e-30; /* V above this can be divided by */

double gonio_i_rgl_theta(double u)
{
    return u * u * (M_PI / 2.0);
}

gonio_i_rgl_mirrored gonio_i_rgl_mirror(double theta_i, double u, double v)
{
    const double theta = gonio_i_rgl_theta(u);
    const double phi = (2.0 * v - 1.0) * M_PI;
    const double m[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
    const double cosine = sin(theta_i) * m[0] + cos(theta_i) * m[2];
    const double o[3] = {2.0 * cosine * m[0] - sin(theta_i), 2.0 * cosine * m[1],
                         2.0 * cosine * m[2] - cos(theta_i)};
    return (gonio_i_rgl_mirrored){.theta_m = theta,
                                  .cosine_m = cosine,
                                  .cosine_o = o[2],
                                  .outgoing = {atan2(hypot(o[0], o[1]), o[2]), atan2(o[1], o[0])}};
}

double gonio_i_rgl_look_up(const float row[NORMALS], double u)
{
    const gonio_i_step x = gonio_i_step_evenly(NORMALS, u);
    return (1.0 - x.share) * (double)row[x.before] + x.share * (double)row[x.before + 1];
}

/* Sums over lines of constant incidence and azimuth, at FINE steps along u. */
typedef struct bending {
    size_t channels;
    double squares[FINE];
    double count[FINE];
} bending;

/* The squared error of all channels at a step, but for a factor; NAN without data there. */
static double error_at(const bending *b, const double *rho, const double *factor)
{
    double sum = 0.0;
    for (size_t c = 0; c < b->channels; c++) {
        const double *at = rho + c;
        const double value = at[0] * factor[0];
        const double before = *(at - b->channels) * factor[-1];
        const double after = at[b->channels] * factor[1];
        const double bend = (before - 2.0 * value + after) * (FINE - 1) * (FINE - 1);
        const double scale = gonio_i_merl_scale[b->channels == GONIO_CHANNELS ? c : 0];
        const double error = value > LOWEST ? bend / value * (at[0] / (at[0] + scale)) : 0.0;
        if (isfinite(before) && isfinite(value) && isfinite(after)) {
            sum += error * error;
        }
    }
    return sum;
}

static gonio_status add_line(gonio_context *context, const gonio_i_sampler *sampler,
                             const float ndf[NORMALS], double theta_i, double v, double limit,
                             bending *b)
{
    gonio_pair pair[FINE];
    double factor[FINE];
    double *rho = gonio_i_allocate(context, FINE * b->channels, sizeof *rho);
    for (size_t k = 0; k < FINE; k++) {
        const double u = (double)k / (FINE - 1);
        const gonio_i_rgl_mirrored to = gonio_i_rgl_mirror(theta_i, u, v);
        pair[k] = (gonio_pair){{theta_i, 0.0}, to.outgoing};
        factor[k] = to.outgoing.theta <= limit ? to.cosine_o / gonio_i_rgl_look_up(ndf, u) : NAN;
    }
    const gonio_status status = rho != NULL
                                    ? gonio_i_sampler_values(context, sampler, pair, FINE, rho)
                                    : GONIO_ERROR_MEMORY;
    for (size_t k = 1; k + 1 < FINE && status == GONIO_OK; k++) {
        if (isfinite(factor[k - 1] + factor[k] + factor[k + 1])) {
            b->squares[k] += error_at(b, rho + k * b->channels, factor + k);
            b->count[k] += 1.0;
        }
    }
    free(rho);
    return status;
}

/* The mean over the steps up to the next nodes, to the power 1/5, and the mean of these to 1. */
static void find_density(const bending *b, float density[NORMALS])
{
    double all = 0.0;
    for (int k = 0; k < NORMALS; k++) {
        const int first = (k - 1) * FINE / NORMALS;
        const int last = (k + 1) * FINE / NORMALS;
        double sum = 0.0;
        int count = 0;
        for (int x = first > 0 ? first : 0; x <= last && x < FINE; x++) {
            sum += b->squares[x] / fmax(b->count[x], 1.0);
            count++;
        }
        density[k] = (float)pow(sum / count, 0.2);
        all += (double)density[k];
    }
    for (int k = 0; k < NORMALS; k++) {
        const double here = all > 0.0 ? (double)density[k] * NORMALS / all : 1.0;
        density[k] = (float)(EVEN + (1.0 - EVEN) * here);
    }
}

gonio_status gonio_i_rgl_places(gonio_context *context, const gonio_i_sampler *sampler,
                                const float ndf[NORMALS], double limit, float density[NORMALS])
{
    bending b = {.channels = sampler->view->channels};
    gonio_status status = GONIO_OK;
    for (size_t i = 0; i < INCIDENCES; i++) {
        for (size_t a = 0; a < AZIMUTHS && status == GONIO_OK; a++) {
            status =
                add_line(context, sampler, ndf, incidence[i] * M_PI / 180.0, azimuth[a], limit, &b);
        }
    }
    if (status == GONIO_OK) {
        find_density(&b, density);
    }
    return status;
}
