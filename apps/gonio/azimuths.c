/* What an anisotropic material reflects at azimuths of the sample: see azimuths.h. */
#include "azimuths.h"

#include <math.h>
#include <stdlib.h>

enum {
    THETAS = 64, /* half vectors that an albedo is a sum over */
    PHIS = 64,
    HALVES = THETAS * PHIS
};

/* A half vector's outgoing direction, and what it counts for: 4 <i, h> cos theta_o dw_h. */
typedef struct ray {
    gonio_pair pair;
    double weight; /* 0 below the horizon */
} ray;

/* Half vectors crowd around the normal, as the bins do. */
static ray mirror(gonio_angles in, int k)
{
    const double largest = 0.5 * (0.5 * M_PI + in.theta);
    const int row = k / PHIS;
    const double x = (row + 0.5) / THETAS;
    const double theta_h = x * x * largest;
    const double phi_h = (k % PHIS + 0.5) * 2.0 * M_PI / PHIS;
    const double i[3] = {sin(in.theta) * cos(in.phi), sin(in.theta) * sin(in.phi), cos(in.theta)};
    const double h[3] = {sin(theta_h) * cos(phi_h), sin(theta_h) * sin(phi_h), cos(theta_h)};
    const double d = i[0] * h[0] + i[1] * h[1] + i[2] * h[2];
    const double o[3] = {2.0 * d * h[0] - i[0], 2.0 * d * h[1] - i[1], 2.0 * d * h[2] - i[2]};
    const double angle = sin(theta_h) * 2.0 * x * largest / THETAS * 2.0 * M_PI / PHIS;
    return (ray){{in, {atan2(hypot(o[0], o[1]), o[2]), atan2(o[1], o[0])}},
                 d > 0.0 && o[2] > 0.0 ? 4.0 * d * o[2] * angle : 0.0};
}

/* Room for the directions of an albedo. */
typedef struct room {
    gonio_pair pair[HALVES];
    double weight[HALVES];
} room;

/* The colour of a direction is that of R, G, B, or the mean of other channels; NaN for no data. */
static double value_of(const double *value, size_t channels, int c)
{
    double sum = 0.0;
    for (size_t k = 0; k < channels; k++) {
        sum += value[k];
    }
    return channels == GONIO_CHANNELS ? value[c] : sum / (double)channels;
}

/* Adds an albedo, and the share of the hemisphere that has data. */
static void add_albedo(const room *r, const double *value, size_t channels,
                       double albedo[GONIO_CHANNELS], double *share)
{
    double covered = 0.0;
    double all = 0.0;
    double sum[GONIO_CHANNELS] = {0.0};
    for (int k = 0; k < HALVES; k++) {
        const double *here = value + (size_t)k * channels;
        const bool data = !isnan(value_of(here, channels, 0));
        for (int c = 0; c < GONIO_CHANNELS && data; c++) {
            const double rho = value_of(here, channels, c);
            sum[c] += isnan(rho) ? 0.0 : r->weight[k] * rho;
        }
        covered += data ? r->weight[k] : 0.0;
        all += r->weight[k];
    }
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        albedo[c] = sum[c];
    }
    *share = covered / all;
}

static gonio_status find_albedo(gonio_context *context, const gonio_material *material, room *r,
                                double *value, int incidence, tool_azimuths *found)
{
    const size_t channels = gonio_material_describe(material)->channels;
    gonio_status status = GONIO_OK;
    for (int a = 0; a < TOOL_AZIMUTHS && status == GONIO_OK; a++) {
        const gonio_angles in = {tool_incidence_deg[incidence] * M_PI / 180.0,
                                 2.0 * M_PI * a / TOOL_AZIMUTHS};
        double albedo[GONIO_CHANNELS];
        double share = 0.0;
        for (int k = 0; k < HALVES; k++) {
            const ray to = mirror(in, k);
            r->pair[k] = to.pair;
            r->weight[k] = to.weight;
        }
        status = gonio_material_evaluate(context, material, r->pair, HALVES, value);
        if (status == GONIO_OK) {
            add_albedo(r, value, channels, albedo, &share);
            found->share[incidence] += share / TOOL_AZIMUTHS;
            for (int c = 0; c < GONIO_CHANNELS; c++) {
                found->albedo[incidence][c] += albedo[c] / TOOL_AZIMUTHS;
                found->largest = fmax(found->largest, albedo[c]);
            }
        }
    }
    return status;
}

/* The bins' directions, each at an azimuth of its own, and turned by 90 degrees. */
static gonio_status find_turn(gonio_context *context, const gonio_material *material, room *r,
                              double *value, tool_azimuths *found)
{
    enum { HALF = HALVES / 2, STRIDE = GONIO_BINS / HALF };
    const size_t channels = gonio_material_describe(material)->channels;
    double sums[2] = {0.0};
    for (int k = 0; k < HALF; k++) {
        const gonio_bin bin = gonio_bin_from_index(k * STRIDE);
        const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
        for (int t = 0; t < 2; t++) {
            const double phi_h = 2.4 * k + 0.5 * M_PI * t;
            r->pair[2 * k + t] = pair;
            r->pair[2 * k + t].incident.phi += phi_h;
            r->pair[2 * k + t].outgoing.phi += phi_h;
        }
    }
    const gonio_status status = gonio_material_evaluate(context, material, r->pair, HALVES, value);
    for (size_t k = 0; k < HALF * channels && status == GONIO_OK; k++) {
        const double *at = value + (2 * (k / channels)) * channels + k % channels;
        if (!isnan(at[0]) && !isnan(at[channels])) {
            const int scale = channels == GONIO_CHANNELS ? (int)(k % channels) : GONIO_CHANNELS;
            const double g = gonio_log_from_brdf(at[0], scale);
            const double difference = g - gonio_log_from_brdf(at[channels], scale);
            sums[0] += difference * difference;
            sums[1] += g * g;
        }
    }
    found->turn = sums[1] > 0.0 ? 100.0 * sqrt(sums[0] / sums[1]) : 0.0;
    return status;
}

gonio_status tool_find_azimuths(gonio_context *context, const gonio_material *material,
                                tool_azimuths *found)
{
    room *r = calloc(1, sizeof *r);
    double *value = calloc(HALVES * gonio_material_describe(material)->channels, sizeof *value);
    gonio_status status = r != NULL && value != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    *found = (tool_azimuths){0};
    for (int k = 0; k < TOOL_INCIDENCES && status == GONIO_OK; k++) {
        status = find_albedo(context, material, r, value, k, found);
        for (int c = 0; c < GONIO_CHANNELS && found->share[k] == 0.0; c++) {
            found->albedo[k][c] = NAN;
        }
    }
    if (status == GONIO_OK) {
        status = find_turn(context, material, r, value, found);
    }
    free(r);
    free(value);
    return status;
}
