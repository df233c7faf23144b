/* The albedo of a fit: see albedo.h.
 *
 * For light from i the albedo is the integral of rho cos theta_o over the outgoing directions. It
 * is taken over half vectors, d omega_o = 4 cos theta_d d omega_h, which are dense around the
 * mirror direction as the grid is, so that narrow peaks count. */
#include "albedo.h"

#include <math.h>
#include <stdlib.h>

static const double INCIDENCE[GONIO_I_ALBEDO_INCIDENCES] = {
    20.0 * M_PI / 180.0, 45.0 * M_PI / 180.0, 65.0 * M_PI / 180.0};

enum { POLAR = 30, AZIMUTHS = 12, MOST = GONIO_I_ALBEDO_INCIDENCES * POLAR * AZIMUTHS };

void gonio_i_hemisphere_release(gonio_i_hemisphere *h)
{
    free(h->weight);
    free(h->place);
    free(h->mean);
    free(h->f);
    *h = (gonio_i_hemisphere){0};
}

/* The half/difference coordinates of light from `incidence` for a half vector whose azimuth about
 * the normal, from the plane of incidence, is phi. Returns cos theta_o, which may be negative. */
static double place_node(double incidence, double theta_h, double phi, gonio_half_difference *at)
{
    /* i, the half vector at azimuth phi, and o = 2 (i.h) h - i. */
    const double i[3] = {sin(incidence), 0.0, cos(incidence)};
    const double half[3] = {sin(theta_h) * cos(phi), sin(theta_h) * sin(phi), cos(theta_h)};
    const double cosine = i[0] * half[0] + i[2] * half[2];
    const double o[3] = {2.0 * cosine * half[0] - i[0], 2.0 * cosine * half[1],
                         2.0 * cosine * half[2] - i[2]};
    if (cosine <= 0.0 || o[2] <= 0.0) {
        return -1.0;
    }
    const gonio_pair pair = {{incidence, 0.0}, {acos(fmin(o[2], 1.0)), atan2(o[1], o[0])}};
    *at = gonio_half_difference_from_pair(pair);
    return o[2];
}

static void add_node(gonio_i_hemisphere *h, size_t *count, double incidence, double u, double phi)
{
    const double theta_h = u * u * M_PI / 2.0;
    gonio_half_difference at = {0};
    const double outgoing = place_node(incidence, theta_h, phi, &at);
    if (outgoing <= 0.0) {
        return;
    }
    const size_t n = (*count)++;
    /* Both halves of the hemisphere: 2 pi/AZIMUTHS; d theta_h = pi u du. */
    const double omega =
        sin(theta_h) * (M_PI * u / (double)POLAR) * (2.0 * M_PI / (double)AZIMUTHS);
    h->weight[n] = outgoing * 4.0 * cos(at.theta_d) * omega;
    h->place[n] = gonio_i_place_of(at);
    gonio_i_prior_at(h->prior, at, 0, &h->mean[n], h->f + n * h->prior->components);
}

gonio_status gonio_i_hemisphere_create(gonio_context *context, const gonio_i_prior *prior,
                                       gonio_i_hemisphere *h)
{
    size_t count = 0;
    *h = (gonio_i_hemisphere){.prior = prior};
    h->weight = gonio_i_allocate(context, MOST, sizeof *h->weight);
    h->place = gonio_i_allocate(context, MOST, sizeof *h->place);
    h->mean = gonio_i_allocate(context, MOST, sizeof *h->mean);
    h->f = gonio_i_allocate(context, MOST * prior->components, sizeof *h->f);
    if (!(h->weight && h->place && h->mean && h->f)) {
        return GONIO_ERROR_MEMORY;
    }
    for (int n = 0; n < GONIO_I_ALBEDO_INCIDENCES; n++) {
        for (int k = 0; k < POLAR * AZIMUTHS; k++) {
            const int polar = k / AZIMUTHS;
            const int azimuth = k % AZIMUTHS;
            const double u = (polar + 0.5) / (double)POLAR;
            const double phi = (azimuth + 0.5) / (double)AZIMUTHS * M_PI;
            add_node(h, &count, INCIDENCE[n], u, phi);
        }
        h->first[n + 1] = count;
    }
    return GONIO_OK;
}

/* g of the fit at a node. */
static double predict(const gonio_i_fit *e, const gonio_i_hemisphere *h, const double *c,
                      size_t node)
{
    double g = h->mean[node];
    for (size_t k = 0; k < e->components; k++) {
        g += h->f[node * e->components + k] * c[k];
    }
    for (size_t i = 0; i < e->n; i++) {
        g += e->model.alpha * e->model.alpha * e->solved[i] *
             gonio_i_remainder(&h->place[node], &e->sites->place[i], e->model.peak, e->model.retro);
    }
    return g;
}

gonio_status gonio_i_fit_albedo(const gonio_i_fit *e, const gonio_i_hemisphere *h, double s,
                                double albedo[GONIO_I_ALBEDO_INCIDENCES])
{
    double *c = gonio_i_allocate(e->context, e->components, sizeof *c);
    if (c == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_i_fit_coefficients(e, c);
    for (int n = 0; n < GONIO_I_ALBEDO_INCIDENCES; n++) {
        albedo[n] = 0.0;
        for (size_t node = h->first[n]; node < h->first[n + 1]; node++) {
            albedo[n] += h->weight[node] * s * expm1(fmax(predict(e, h, c, node), 0.0));
        }
    }
    free(c);
    return GONIO_OK;
}
