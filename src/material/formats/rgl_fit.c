/* Values of an RGL .bsdf fitted to the material.
 *
 * Linear interpolation between values at single places is too high where a curve bends upwards, as
 * beside every highlight, and follows noise. So the values are moved until what is interpolated
 * from them fits at many directions in between: the grid's bins and their reverse. At each
 * direction
 *
 *     e = ln((rho + s)/(rho' + s)) (rho' + s)/rho'
 *
 * is the relative change of the interpolated rho' that log space asks for; each value is multiplied
 * by the exponential of the mean of e over the directions that it counts for, by its weight there.
 * A few rounds of this (Jacobi's method for least squares, in logarithms) halve E6. */
#include "rgl_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/core.h"
#include "merl.h"
#include "rgl_places.h"

enum {
    ROUNDS = 5,
    DENSITY = 6, /* directions for each value of a channel, at most */
    BLOCK = 1 << 15,
    CORNERS = 8,
    MOST_THETAS = 64
};

static const double STEEPEST = 80.0 * M_PI / 180.0; /* beyond, measurements are not to be trusted */
static const double LARGEST = 0.5;                  /* of a change, in logarithms */
static const double HELD = 0.3;                     /* weight of leaving a value as it is */

typedef struct fit {
    gonio_context *context;
    const gonio_i_sampler *sampler;
    const gonio_i_rgl_values *v;
    double theta[MOST_THETAS];
    gonio_pair *pair; /* [BLOCK] */
    double *rho;      /* [BLOCK][channels of the material] */
    double *change;   /* [thetas][channels][side][side] */
    double *weight;   /* [thetas][side][side] */
} fit;

/* Where a direction is among the values. */
typedef struct spot {
    size_t node[CORNERS]; /* index of the incidence times places + place */
    double weight[CORNERS];
    double factor; /* from values to rho */
} spot;

static spot locate(const fit *f, gonio_pair pair)
{
    const gonio_i_rgl_values *v = f->v;
    const gonio_i_blend slice = {1, {0}, {1.0}};
    const double phi = pair.outgoing.phi - pair.incident.phi;
    const double x = sin(pair.incident.theta) + sin(pair.outgoing.theta) * cos(phi);
    const double y = sin(pair.outgoing.theta) * sin(phi);
    const double z = cos(pair.incident.theta) + cos(pair.outgoing.theta);
    const double revolutions = (atan2(y, x) + M_PI) / (2.0 * M_PI);
    const double u[2] = {sqrt(atan2(hypot(x, y), z) * (2.0 / M_PI)),
                         revolutions - floor(revolutions)};
    double s[2];
    gonio_i_warp_invert(v->warp, &slice, u, s);
    const gonio_i_step t = gonio_i_step_among(f->theta, v->thetas, pair.incident.theta);
    const gonio_i_step a = gonio_i_step_evenly(v->side, s[0]);
    const gonio_i_step b = gonio_i_step_evenly(v->side, s[1]);
    const double area = gonio_i_rgl_look_up(v->sigma, sqrt(pair.incident.theta * (2.0 / M_PI)));
    spot at = {.factor =
                   gonio_i_rgl_look_up(v->ndf, u[0]) / (4.0 * area * cos(pair.outgoing.theta))};
    for (size_t k = 0; k < CORNERS; k++) {
        const size_t i = k & 1;
        const size_t j = k >> 1 & 1;
        const size_t l = k >> 2;
        at.node[k] = ((t.before + l) * v->side + b.before + j) * v->side + a.before + i;
        at.weight[k] = (i ? a.share : 1.0 - a.share) * (j ? b.share : 1.0 - b.share) *
                       (l ? t.share : 1.0 - t.share);
    }
    return at;
}

/* A place's value in a channel, from its node. */
static size_t index_of(const gonio_i_rgl_values *v, size_t node, size_t channel)
{
    const size_t places = v->side * v->side;
    return (node / places * v->channels + channel) * places + node % places;
}

static double scale_of(const fit *f, size_t channel)
{
    return gonio_i_merl_scale[f->sampler->view->wavelength == NULL ? channel : 0];
}

/* The change that a direction asks of a channel. */
static double find_error(const fit *f, const spot *at, size_t channel, double rho)
{
    const double s = scale_of(f, channel);
    double made = 0.0;
    for (size_t k = 0; k < CORNERS; k++) {
        made += at->weight[k] * (double)f->v->value[index_of(f->v, at->node[k], channel)];
    }
    made = fmax(made * at->factor, 0.0);
    const double error = log((rho + s) / (made + s)) * (made + s) / (made + 1e-12);
    return fmin(fmax(error, -LARGEST), LARGEST);
}

static void add_direction(const fit *f, gonio_pair pair, const double *rho)
{
    const spot at = locate(f, pair);
    bool data = false;
    for (size_t c = 0; c < f->v->channels; c++) {
        data = data || !isnan(rho[f->v->order[c]]);
    }
    for (size_t c = 0; c < f->v->channels && data; c++) {
        const double value = rho[f->v->order[c]];
        const double error = find_error(f, &at, c, isnan(value) ? 0.0 : value);
        for (size_t k = 0; k < CORNERS; k++) {
            f->change[index_of(f->v, at.node[k], c)] += at.weight[k] * error;
        }
    }
    for (size_t k = 0; k < CORNERS && data; k++) {
        f->weight[at.node[k]] += at.weight[k];
    }
}

static gonio_status add_block(const fit *f, size_t count)
{
    const gonio_status status =
        gonio_i_sampler_values(f->context, f->sampler, f->pair, count, f->rho);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        add_direction(f, f->pair[k], f->rho + k * f->sampler->view->channels);
    }
    return status;
}

/* Every so many bins, forth and back in turn. */
static gonio_status add_all(const fit *f)
{
    const size_t nodes = f->v->thetas * f->v->side * f->v->side;
    const size_t stride = GONIO_BINS / (DENSITY * nodes + 1) + 1;
    size_t count = 0;
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < GONIO_BINS && status == GONIO_OK; k += stride) {
        const gonio_pair pair =
            gonio_pair_from_half_difference(gonio_bin_centre(gonio_bin_from_index((int32_t)k)));
        if (fmax(pair.incident.theta, pair.outgoing.theta) > STEEPEST) {
            continue;
        }
        const bool reverse = k / stride % 2 == 1;
        f->pair[count++] = reverse ? (gonio_pair){pair.outgoing, pair.incident} : pair;
        if (count == BLOCK) {
            status = add_block(f, count);
            count = 0;
        }
    }
    return status == GONIO_OK && count > 0 ? add_block(f, count) : status;
}

static void apply_changes(const fit *f)
{
    const gonio_i_rgl_values *v = f->v;
    for (size_t node = 0; node < v->thetas * v->side * v->side; node++) {
        for (size_t c = 0; c < v->channels; c++) {
            const size_t k = index_of(v, node, c);
            v->value[k] *= (float)exp(f->change[k] / (f->weight[node] + HELD));
        }
    }
}

static gonio_status run_rounds(const fit *f)
{
    const size_t nodes = f->v->thetas * f->v->side * f->v->side;
    gonio_status status = GONIO_OK;
    for (int round = 0; round < ROUNDS && status == GONIO_OK; round++) {
        memset(f->change, 0, nodes * f->v->channels * sizeof *f->change);
        memset(f->weight, 0, nodes * sizeof *f->weight);
        status = add_all(f);
        if (status == GONIO_OK) {
            apply_changes(f);
            status = gonio_i_progress(f->context, "writing", 0.3 + 0.69 * (round + 1) / ROUNDS);
        }
    }
    return status;
}

gonio_status gonio_i_rgl_fit(gonio_context *context, const gonio_i_sampler *sampler,
                             const gonio_i_rgl_values *values)
{
    const size_t nodes = values->thetas * values->side * values->side;
    fit f = {.context = context, .sampler = sampler, .v = values};
    for (size_t t = 0; t < values->thetas && t < MOST_THETAS; t++) {
        f.theta[t] = (double)values->theta[t];
    }
    f.pair = gonio_i_allocate(context, BLOCK, sizeof *f.pair);
    f.rho = gonio_i_allocate(context, BLOCK * sampler->view->channels, sizeof *f.rho);
    f.change = gonio_i_allocate(context, nodes * values->channels, sizeof *f.change);
    f.weight = gonio_i_allocate(context, nodes, sizeof *f.weight);
    const gonio_status status =
        f.pair != NULL && f.rho != NULL && f.change != NULL && f.weight != NULL
            ? run_rounds(&f)
            : GONIO_ERROR_MEMORY;
    free(f.pair);
    free(f.rho);
    free(f.change);
    free(f.weight);
    return status;
}
