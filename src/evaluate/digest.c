/* Materials digested for the errors of bivariate estimates: see digest.h. */
#include "digest.h"

#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "../core/vector_math.h"
#include "../direction/grid.h"

enum { MOST_NODES = 24 };

/* ---- nodes ---- */

/* Chebyshev points of the first kind for functions of t = ln w on [low, high]. D(e^t) is analytic
 * up to a distance of pi from the real line, so that the error of n points is (r + sqrt(1 +
 * r^2))^-n, r = pi / half the interval: n is chosen for 1e-9. */
typedef struct nodes {
    size_t count;
    double t[MOST_NODES];
    double factor[MOST_NODES]; /* of the barycentric formula */
} nodes;

static void place_nodes(double low, double high, nodes *n)
{
    const double half = 0.5 * (high - low);
    n->count = half > 1e-9 ? 2 + (size_t)ceil(21.0 / asinh(M_PI / half)) : 1;
    for (size_t j = 0; j < n->count; j++) {
        const double angle = M_PI * (2.0 * (double)j + 1.0) / (2.0 * (double)n->count);
        n->t[j] = low + half * (1.0 + cos(angle));
        n->factor[j] = (j % 2 == 0 ? 1.0 : -1.0) * sin(angle);
    }
}

/* How much each node's value counts at t. */
static void interpolate(const nodes *n, double t, double *share)
{
    double sum = 0.0;
    for (size_t j = 0; j < n->count; j++) {
        if (t == n->t[j] || n->count == 1) {
            memset(share, 0, n->count * sizeof *share);
            share[j] = 1.0;
            return;
        }
        share[j] = n->factor[j] / (t - n->t[j]);
        sum += share[j];
    }
    for (size_t j = 0; j < n->count; j++) {
        share[j] /= sum;
    }
}

/* ---- reading a material ---- */

/* A slab, and what its bins are worth. */
typedef struct slab {
    double *rho;
    double *g;          /* log space */
    double *root;       /* cbrt(rho) */
    double *ratio;      /* d_b */
    double *cosines;    /* c_i c_o; the others likewise for one channel */
    double *area;       /* (c_i c_o)^(2/3) */
    double *log_weight; /* ln w */
    bool *data;
    gonio_slab_statistics statistics;
} slab;

static bool make_slab(gonio_context *context, slab *s)
{
    s->rho = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof(double));
    s->g = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof(double));
    s->root = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof(double));
    s->ratio = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof(double));
    s->cosines = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(double));
    s->area = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(double));
    s->log_weight = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(double));
    s->data = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(bool));
    return s->rho != NULL && s->g != NULL && s->root != NULL && s->ratio != NULL &&
           s->cosines != NULL && s->area != NULL && s->log_weight != NULL && s->data != NULL;
}

static void free_slab(slab *s)
{
    free(s->rho);
    free(s->g);
    free(s->root);
    free(s->ratio);
    free(s->cosines);
    free(s->area);
    free(s->log_weight);
    free(s->data);
}

/* d_b of all bins. */
static void fill_ratios(slab *s)
{
    for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
        const size_t bin = k % GONIO_SLAB_BINS;
        const int channel = (int)(k / GONIO_SLAB_BINS);
        const double g = s->statistics.mean[bin / GONIO_PHI_D_BINS][channel];
        const double w = gonio_i_ratio_weight(s->cosines[bin]);
        s->ratio[k] = s->data[bin] ? g : 0.0;
        s->log_weight[bin] = w;
    }
    gonio_i_expm1(GONIO_SLAB_VALUES, s->ratio, s->ratio);
    for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
        const size_t bin = k % GONIO_SLAB_BINS;
        const double w = s->log_weight[bin];
        const double mean = gonio_log_scale((int)(k / GONIO_SLAB_BINS)) * s->ratio[k];
        s->ratio[k] = (s->rho[k] * w + GONIO_I_RATIO_OFFSET) / (mean * w + GONIO_I_RATIO_OFFSET);
    }
    gonio_i_log(GONIO_SLAB_VALUES, s->ratio, s->ratio);
    gonio_i_log(GONIO_SLAB_BINS, s->log_weight, s->log_weight);
}

static gonio_status read_slab(gonio_context *context, const gonio_material *material, int theta_h,
                              gonio_fingerprint *fingerprint, slab *s)
{
    const gonio_status status = gonio_material_read_slab(material, context, theta_h, s->rho);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_fingerprint_add(fingerprint, s->rho, GONIO_SLAB_VALUES * sizeof *s->rho);
    gonio_slab_mask(theta_h, s->rho, s->data);
    for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
        s->rho[k] = s->data[k % GONIO_SLAB_BINS] ? s->rho[k] : 0.0;
    }
    gonio_slab_to_log(s->rho, s->g);
    gonio_slab_reduce(s->g, s->data, &s->statistics);
    gonio_i_cbrt(GONIO_SLAB_VALUES, s->rho, s->root);
    gonio_i_slab_cosines(theta_h, s->cosines);
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        s->area[k] = cbrt(s->cosines[k] * s->cosines[k]);
    }
    fill_ratios(s);
    return GONIO_OK;
}

/* ---- digesting a cell ---- */

/* The weighted mean of the roots, their squares and their scatter. */
static void add_roots(const slab *s, size_t row, int channel, gonio_i_digest *d)
{
    const double *root = s->root + (size_t)channel * GONIO_SLAB_BINS + row;
    double area = 0.0;
    double sum = 0.0;
    for (size_t p = 0; p < GONIO_PHI_D_BINS; p++) {
        const double share = s->data[row + p] ? s->area[row + p] : 0.0;
        area += share;
        sum += share * root[p];
    }
    const double mean = sum / area;
    for (size_t p = 0; p < GONIO_PHI_D_BINS; p++) {
        const double share = s->data[row + p] ? s->area[row + p] : 0.0;
        d->constant.cube_difference += share * (root[p] - mean) * (root[p] - mean);
        d->constant.cube_reference += share * root[p] * root[p];
    }
    d->area[d->cells] = area;
    d->root[channel][d->cells] = mean;
}

/* The nodes of a cell: over all of its valid bins, whether they have data or not. */
static void choose_nodes(const slab *s, size_t row, nodes *n)
{
    double low = HUGE_VAL;
    double high = -HUGE_VAL;
    for (size_t p = 0; p < GONIO_PHI_D_BINS; p++) {
        if (s->cosines[row + p] > 0.0) {
            low = fmin(low, s->log_weight[row + p]);
            high = fmax(high, s->log_weight[row + p]);
        }
    }
    place_nodes(low, high, n);
}

static void add_ratios(const slab *s, size_t row, gonio_i_digest *d)
{
    nodes n;
    double share[MOST_NODES];
    const size_t first = d->first[d->cells];
    choose_nodes(s, row, &n);
    for (size_t j = 0; j < n.count; j++) {
        d->node[first + j] = exp(n.t[j]);
    }
    for (size_t p = row; p < row + GONIO_PHI_D_BINS; p++) {
        if (!s->data[p]) {
            continue;
        }
        interpolate(&n, s->log_weight[p], share);
        for (size_t j = 0; j < n.count; j++) {
            d->weight[first + j] += share[j];
        }
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            const double ratio = s->ratio[c * GONIO_SLAB_BINS + p];
            d->constant.ratio += ratio * ratio;
            for (size_t j = 0; j < n.count; j++) {
                d->moment[c][first + j] += share[j] * ratio;
            }
        }
    }
    d->first[d->cells + 1] = first + n.count;
}

static void add_cell(const slab *s, int theta_h, int theta_d, gonio_i_digest *d)
{
    const size_t row = (size_t)theta_d * GONIO_PHI_D_BINS;
    const double count = s->statistics.count[theta_d];
    if (count == 0.0) {
        return;
    }
    d->cell[d->cells] = theta_d + GONIO_THETA_D_BINS * theta_h;
    d->count[d->cells] = count;
    d->bins += s->statistics.count[theta_d];
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        const double mean = s->statistics.mean[theta_d][channel];
        const double scatter = s->statistics.scatter[theta_d][channel];
        d->mean[channel][d->cells] = mean;
        d->constant.log_difference += scatter;
        d->constant.log_reference += scatter + count * mean * mean;
        add_roots(s, row, channel, d);
    }
    add_ratios(s, row, d);
    d->cells++;
}

/* ---- the whole ---- */

static bool allocate_channels(gonio_context *context, double **channel, size_t count)
{
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        channel[c] = gonio_i_allocate(context, count, sizeof *channel[c]);
    }
    return channel[0] != NULL && channel[1] != NULL && channel[2] != NULL;
}

static bool allocate(gonio_context *context, gonio_i_digest *d)
{
    const size_t most = (size_t)GONIO_CELLS * MOST_NODES;
    d->cell = gonio_i_allocate(context, GONIO_CELLS, sizeof *d->cell);
    d->count = gonio_i_allocate(context, GONIO_CELLS, sizeof *d->count);
    d->area = gonio_i_allocate(context, GONIO_CELLS, sizeof *d->area);
    d->first = gonio_i_allocate(context, GONIO_CELLS + 1, sizeof *d->first);
    d->node = gonio_i_allocate(context, most, sizeof *d->node);
    d->weight = gonio_i_allocate(context, most, sizeof *d->weight);
    return allocate_channels(context, d->mean, GONIO_CELLS) &&
           allocate_channels(context, d->root, GONIO_CELLS) &&
           allocate_channels(context, d->moment, most) && d->cell != NULL && d->count != NULL &&
           d->area != NULL && d->first != NULL && d->node != NULL && d->weight != NULL;
}

/* Gives back what the nodes did not need. */
static void shrink(gonio_i_digest *d)
{
    double **const arrays[] = {&d->node, &d->weight, &d->moment[0], &d->moment[1], &d->moment[2]};
    const size_t count = d->first[d->cells] > 0 ? d->first[d->cells] : 1;
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        double *less = reallocarray(*arrays[k], count, sizeof *less);
        *arrays[k] = less != NULL ? less : *arrays[k];
    }
}

static gonio_status read_slabs(gonio_context *context, const gonio_material *material, slab *s,
                               gonio_fingerprint *fingerprint, gonio_i_digest *d)
{
    gonio_status status = GONIO_OK;
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS && status == GONIO_OK; theta_h++) {
        status = read_slab(context, material, theta_h, fingerprint, s);
        for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS && status == GONIO_OK; theta_d++) {
            add_cell(s, theta_h, theta_d, d);
        }
    }
    d->fingerprint = gonio_fingerprint_value(fingerprint);
    return status;
}

static gonio_status digest_material(gonio_context *context, const gonio_material *material,
                                    gonio_i_digest *d)
{
    slab s = {0};
    gonio_fingerprint *fingerprint = NULL;
    d->name = strdup(gonio_material_name(material));
    gonio_status status = GONIO_ERROR_MEMORY;
    if (d->name != NULL && allocate(context, d) && make_slab(context, &s)) {
        status = gonio_fingerprint_create(&fingerprint);
    }
    if (status == GONIO_OK) {
        status = read_slabs(context, material, &s, fingerprint, d);
    }
    if (status == GONIO_OK && d->constant.log_reference == 0.0) {
        status = gonio_i_fail(context, GONIO_ERROR_DATA,
                              d->bins == 0 ? "%s has no data at all"
                                           : "%s is black: no error relative to it",
                              d->name);
    }
    gonio_fingerprint_free(&fingerprint);
    free_slab(&s);
    return status;
}

gonio_status gonio_i_digest_create(gonio_context *context, const gonio_material *material,
                                   gonio_i_digest **digest)
{
    gonio_i_digest *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status = digest_material(context, material, made);
    if (status != GONIO_OK) {
        gonio_i_digest_free(&made);
        return status;
    }
    shrink(made);
    *digest = made;
    return GONIO_OK;
}

void gonio_i_digest_free(gonio_i_digest **digest)
{
    if (digest == NULL || *digest == NULL) {
        return;
    }
    gonio_i_digest *d = *digest;
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        free(d->mean[c]);
        free(d->root[c]);
        free(d->moment[c]);
    }
    free(d->name);
    free(d->cell);
    free(d->count);
    free(d->area);
    free(d->first);
    free(d->node);
    free(d->weight);
    free(d);
    *digest = NULL;
}

void gonio_i_digest_mean(const gonio_i_digest *digest, double *g)
{
    for (size_t k = 0; k < (size_t)GONIO_CELLS * GONIO_CHANNELS; k++) {
        g[k] = NAN;
    }
    for (size_t i = 0; i < digest->cells; i++) {
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            g[(size_t)digest->cell[i] * GONIO_CHANNELS + c] = digest->mean[c][i];
        }
    }
}

/* ---- comparing ---- */

/* One channel's estimate, [cells] each. */
typedef struct estimate {
    double *g;    /* clamped */
    double *rho;  /* 1/sr */
    double *root; /* cbrt(rho) */
    double *own;  /* rho of the material's own mean */
    double *log;  /* [nodes]: D */
} estimate;

static bool make_estimate(gonio_context *context, const gonio_i_digest *d, estimate *e)
{
    double *all = gonio_i_allocate(context, 4 * d->cells + d->first[d->cells], sizeof *all);
    *e = (estimate){.g = all};
    if (all != NULL) {
        e->rho = all + d->cells;
        e->root = e->rho + d->cells;
        e->own = e->root + d->cells;
        e->log = e->own + d->cells;
    }
    return all != NULL;
}

/* As the material of a reconstruction is made. */
static void fill_estimate(const gonio_i_digest *d, const double *g, int channel, estimate *e)
{
    const double largest = 600.0;
    const double scale = gonio_log_scale(channel);
    for (size_t i = 0; i < d->cells; i++) {
        const double value = g[(size_t)d->cell[i] * GONIO_CHANNELS + (size_t)channel];
        const double positive = value > 0.0 ? value : 0.0;
        e->g[i] = positive < largest ? positive : largest;
    }
    gonio_i_expm1(d->cells, e->g, e->rho);
    gonio_i_expm1(d->cells, d->mean[channel], e->own);
    for (size_t i = 0; i < d->cells; i++) {
        e->rho[i] *= scale;
        e->own[i] *= scale;
    }
    gonio_i_cbrt(d->cells, e->rho, e->root);
    for (size_t i = 0; i < d->cells; i++) {
        for (size_t j = d->first[i]; j < d->first[i + 1]; j++) {
            e->log[j] = (e->rho[i] * d->node[j] + GONIO_I_RATIO_OFFSET) /
                        (e->own[i] * d->node[j] + GONIO_I_RATIO_OFFSET);
        }
    }
    gonio_i_log(d->first[d->cells], e->log, e->log);
}

GONIO_I_VECTORISED static double weighted_squares(size_t n, const double *weight, const double *a,
                                                  const double *b)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++) {
        sum += weight[i] * (a[i] - b[i]) * (a[i] - b[i]);
    }
    return sum;
}

GONIO_I_VECTORISED static double ratio_squares(size_t n, const double *weight, const double *moment,
                                               const double *log)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t j = 0; j < n; j++) {
        sum += (weight[j] * log[j] - 2.0 * moment[j]) * log[j];
    }
    return sum;
}

gonio_status gonio_i_digest_compare(gonio_context *context, const gonio_i_digest *digest,
                                    const double *g, gonio_error *error)
{
    const gonio_i_digest *d = digest;
    estimate e;
    gonio_i_error_sums sums = d->constant;
    if (!make_estimate(context, d, &e)) {
        return GONIO_ERROR_MEMORY;
    }
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        fill_estimate(d, g, channel, &e);
        sums.log_difference += weighted_squares(d->cells, d->count, e.g, d->mean[channel]);
        sums.cube_difference += weighted_squares(d->cells, d->area, e.root, d->root[channel]);
        sums.ratio += ratio_squares(d->first[d->cells], d->weight, d->moment[channel], e.log);
    }
    free(e.g);
    sums.ratio = fmax(sums.ratio, 0.0);
    *error = gonio_i_error_of(&sums, (double)d->bins * GONIO_CHANNELS);
    return GONIO_OK;
}
