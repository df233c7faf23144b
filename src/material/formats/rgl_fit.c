/* Values of an RGL .bsdf fitted to the material.
 *
 * Linear interpolation between values of the material is too high where a curve bends upwards, as
 * beside every highlight, and it follows noise. So the values are changed until the interpolation
 * fits at many directions in between: the grid's bins and their reciprocals. At each direction
 *
 *     e = ln((rho + s)/(rho' + s)) (rho' + s)/rho'
 *
 * is the relative change of the interpolated rho' that reduces the error in log space. Each value
 * is multiplied by the exponential of the mean of e over the directions that use it, weighted by
 * its interpolation weight. A few rounds of this (Jacobi's method for least squares, in logarithms)
 * halve E6. */
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
    MOST_THETAS = 64,
    MOST_KEPT = 1 << 24 /* values that are kept from round to round: 128 MB */
};

static const double STEEPEST = 80.0 * M_PI / 180.0; /* measurements beyond are not reliable */
static const double LARGEST = 0.5;                  /* of a change, in logarithms */
static const double HELD = 0.3;                     /* weight of no change */

/* Where a direction is among the values: between two incidences and four places. */
typedef struct spot {
    size_t node; /* the first of the eight: index of the incidence times places + place */
    double share[3];
    double factor; /* from values to rho */
} spot;

typedef struct fit {
    gonio_context *context;
    const gonio_i_sampler *sampler;
    const gonio_i_rgl_values *v;
    double theta[MOST_THETAS];
    size_t count;     /* of directions, the same in every round */
    gonio_pair *pair; /* [count] */
    spot *spot;       /* [count] */
    size_t kept;      /* directions whose values are kept */
    double *rho;      /* [kept][channels of the material] */
    double *others;   /* [BLOCK][channels of the material], those beyond */
    double *change;   /* [thetas][channels][side][side] */
    double *weight;   /* [thetas][side][side] */
} fit;

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
    return (spot){.node = (t.before * v->side + b.before) * v->side + a.before,
                  .share = {a.share, b.share, t.share},
                  .factor =
                      gonio_i_rgl_look_up(v->ndf, u[0]) / (4.0 * area * cos(pair.outgoing.theta))};
}

/* The nodes around a spot, and their weights. */
typedef struct corners {
    size_t node[CORNERS];
    double weight[CORNERS];
} corners;

static corners corners_of(const gonio_i_rgl_values *v, const spot *at)
{
    corners around;
    for (size_t k = 0; k < CORNERS; k++) {
        const size_t i = k & 1;
        const size_t j = k >> 1 & 1;
        const size_t l = k >> 2;
        around.node[k] = at->node + (l * v->side + j) * v->side + i;
        around.weight[k] = (i ? at->share[0] : 1.0 - at->share[0]) *
                           (j ? at->share[1] : 1.0 - at->share[1]) *
                           (l ? at->share[2] : 1.0 - at->share[2]);
    }
    return around;
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

/* e of a direction in a channel; the values at the corners are at `index`. */
static double find_error(const fit *f, const corners *around, const size_t *index, double factor,
                         double s, double rho)
{
    double made = 0.0;
    for (size_t k = 0; k < CORNERS; k++) {
        made += around->weight[k] * (double)f->v->value[index[k]];
    }
    made = fmax(made * factor, 0.0);
    const double error = log((rho + s) / (made + s)) * (made + s) / (made + 1e-12);
    return fmin(fmax(error, -LARGEST), LARGEST);
}

static void add_channel(const fit *f, const spot *at, const corners *around, size_t channel,
                        double rho)
{
    size_t index[CORNERS];
    for (size_t k = 0; k < CORNERS; k++) {
        index[k] = index_of(f->v, around->node[k], channel);
    }
    const double error =
        find_error(f, around, index, at->factor, scale_of(f, channel), isnan(rho) ? 0.0 : rho);
    for (size_t k = 0; k < CORNERS; k++) {
        f->change[index[k]] += around->weight[k] * error;
    }
}

static void add_direction(const fit *f, const spot *at, const double *rho)
{
    bool data = false;
    for (size_t c = 0; c < f->v->channels; c++) {
        data = data || !isnan(rho[f->v->order[c]]);
    }
    if (!data) {
        return;
    }
    const corners around = corners_of(f->v, at);
    for (size_t c = 0; c < f->v->channels; c++) {
        add_channel(f, at, &around, c, rho[f->v->order[c]]);
    }
    for (size_t k = 0; k < CORNERS; k++) {
        f->weight[around.node[k]] += around.weight[k];
    }
}

/* The material's values of a block of directions. From the second round on they may be kept. */
static gonio_status find_values(const fit *f, int round, size_t first, size_t count,
                                const double **values)
{
    const bool kept = first + count <= f->kept;
    double *rho = kept ? f->rho + first * f->sampler->view->channels : f->others;
    *values = rho;
    return kept && round > 0
               ? GONIO_OK
               : gonio_i_sampler_values(f->context, f->sampler, f->pair + first, count, rho);
}

static gonio_status add_all(const fit *f, int round)
{
    gonio_status status = GONIO_OK;
    for (size_t first = 0; first < f->count && status == GONIO_OK; first += BLOCK) {
        const size_t count = f->count - first < BLOCK ? f->count - first : BLOCK;
        const double *rho = NULL;
        status = find_values(f, round, first, count, &rho);
        for (size_t k = 0; k < count && status == GONIO_OK; k++) {
            add_direction(f, &f->spot[first + k], rho + k * f->sampler->view->channels);
        }
    }
    return status;
}

static size_t stride_of(const gonio_i_rgl_values *v)
{
    return GONIO_BINS / (DENSITY * v->thetas * v->side * v->side + 1) + 1;
}

/* Every so many bins, forth and back in turn. */
static void list_directions(fit *f)
{
    const size_t stride = stride_of(f->v);
    for (size_t k = 0; k < GONIO_BINS; k += stride) {
        const gonio_pair pair =
            gonio_pair_from_half_difference(gonio_bin_centre(gonio_bin_from_index((int32_t)k)));
        if (fmax(pair.incident.theta, pair.outgoing.theta) > STEEPEST) {
            continue;
        }
        const bool reverse = k / stride % 2 == 1;
        f->pair[f->count] = reverse ? (gonio_pair){pair.outgoing, pair.incident} : pair;
        f->spot[f->count] = locate(f, f->pair[f->count]);
        f->count++;
    }
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
        status = add_all(f, round);
        if (status == GONIO_OK) {
            apply_changes(f);
            status = gonio_i_progress(f->context, "writing", 0.3 + 0.69 * (round + 1) / ROUNDS);
        }
    }
    return status;
}

static bool make_room(fit *f)
{
    const gonio_i_rgl_values *v = f->v;
    const size_t channels = f->sampler->view->channels;
    const size_t most = GONIO_BINS / stride_of(v) + 1;
    f->kept = MOST_KEPT / channels < most ? MOST_KEPT / channels : most;
    f->pair = gonio_i_allocate(f->context, most, sizeof *f->pair);
    f->spot = gonio_i_allocate(f->context, most, sizeof *f->spot);
    f->rho = gonio_i_allocate(f->context, (f->kept + 1) * channels, sizeof *f->rho);
    f->others = gonio_i_allocate(f->context, BLOCK * channels, sizeof *f->others);
    f->change = gonio_i_allocate(f->context, v->thetas * v->side * v->side * v->channels,
                                 sizeof *f->change);
    f->weight = gonio_i_allocate(f->context, v->thetas * v->side * v->side, sizeof *f->weight);
    return f->pair != NULL && f->spot != NULL && f->rho != NULL && f->others != NULL &&
           f->change != NULL && f->weight != NULL;
}

gonio_status gonio_i_rgl_fit(gonio_context *context, const gonio_i_sampler *sampler,
                             const gonio_i_rgl_values *values)
{
    fit f = {.context = context, .sampler = sampler, .v = values};
    for (size_t t = 0; t < values->thetas && t < MOST_THETAS; t++) {
        f.theta[t] = (double)values->theta[t];
    }
    gonio_status status = GONIO_ERROR_MEMORY;
    if (make_room(&f)) {
        list_directions(&f);
        status = run_rounds(&f);
    }
    free(f.pair);
    free(f.spot);
    free(f.rho);
    free(f.others);
    free(f.change);
    free(f.weight);
    return status;
}
