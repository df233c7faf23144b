/* Digests of materials for the errors of bivariate estimates: see digest.h. */
#include "digest.h"

#include <math.h>
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

/* The index of the node at t, or 0 if there is only one; the number of nodes if none is at t. */
static size_t node_at(const nodes *n, double t)
{
    size_t j = 0;
    while (j < n->count && n->count > 1 && t != n->t[j]) {
        j++;
    }
    return j;
}

GONIO_I_VECTORISED static void divide_by_distance(const nodes *n, double t, double *share)
{
    for (size_t j = 0; j < n->count; j++) {
        share[j] = n->factor[j] / (t - n->t[j]);
    }
}

/* The weight of each node's value at t. */
static void interpolate(const nodes *n, double t, double *share)
{
    const size_t at = node_at(n, t);
    if (at < n->count) {
        memset(share, 0, n->count * sizeof *share);
        share[at] = 1.0;
        return;
    }
    double sum = 0.0;
    divide_by_distance(n, t, share);
    for (size_t j = 0; j < n->count; j++) {
        sum += share[j];
    }
    for (size_t j = 0; j < n->count; j++) {
        share[j] /= sum;
    }
}

/* ---- reading a material ---- */

/* A slab, and the terms of its bins by one metric. */
typedef struct slab {
    double *rho;        /* 0 where there is no data */
    double *g;          /* log space */
    double *own;        /* x_0 of each bin's cell; 0 where there is no data */
    double *difference; /* d_b, by the metric at hand */
    double *reference;  /* what its error is relative to; one channel, as the next two */
    double *cosines;    /* c_i c_o */
    double *log_weight; /* ln w */
    bool *data;
    gonio_slab_statistics statistics;
} slab;

static bool make_slab(gonio_context *context, slab *s)
{
    s->rho = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof(double));
    s->g = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof(double));
    s->own = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof(double));
    s->difference = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof(double));
    s->reference = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(double));
    s->cosines = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(double));
    s->log_weight = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(double));
    s->data = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(bool));
    return s->rho != NULL && s->g != NULL && s->own != NULL && s->difference != NULL &&
           s->reference != NULL && s->cosines != NULL && s->log_weight != NULL && s->data != NULL;
}

static void free_slab(slab *s)
{
    free(s->rho);
    free(s->g);
    free(s->own);
    free(s->difference);
    free(s->reference);
    free(s->cosines);
    free(s->log_weight);
    free(s->data);
}

/* x_0 at all bins with data. */
static void fill_own(slab *s)
{
    for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
        const size_t bin = k % GONIO_SLAB_BINS;
        const double mean = s->statistics.mean[bin / GONIO_PHI_D_BINS][k / GONIO_SLAB_BINS];
        s->own[k] = s->data[bin] ? mean : 0.0;
    }
    gonio_i_expm1(GONIO_SLAB_VALUES, s->own, s->own);
    for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
        s->own[k] *= gonio_log_scale((int)(k / GONIO_SLAB_BINS));
    }
}

static gonio_status read_slab(gonio_context *context, const gonio_material *material, int theta_h,
                              gonio_fingerprint *fingerprint, slab *s)
{
    const gonio_status status = gonio_material_read_slab(context, material, theta_h, s->rho);
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
    fill_own(s);
    gonio_i_slab_cosines(theta_h, s->cosines);
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        s->log_weight[k] = gonio_i_clip_cosines(s->cosines[k]);
    }
    gonio_i_log(GONIO_SLAB_BINS, s->log_weight, s->log_weight);
    return GONIO_OK;
}

/* d_b of all bins, and the sums over them. */
static void fill_terms(int metric, slab *s, gonio_i_digest *d)
{
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        const size_t plane = (size_t)c * GONIO_SLAB_BINS;
        const gonio_i_compared values = {.count = GONIO_SLAB_BINS,
                                         .reference = s->rho + plane,
                                         .other = s->own + plane,
                                         .cosines = s->cosines,
                                         .scale = gonio_log_scale(c)};
        gonio_i_metric_at(metric)->terms(&values, s->difference + plane, s->reference);
        gonio_i_metric_add_terms(GONIO_SLAB_BINS, s->difference + plane, s->reference,
                                 &d->constant.metric[metric]);
    }
}

/* ---- digesting a cell ---- */

/* The one node of terms that are in proportion; returns how many that is. */
static size_t add_proportional(const slab *s, size_t row, double (*proportion)(double),
                               size_t first, gonio_i_digest_metric *m)
{
    m->node[first] = 1.0;
    for (size_t p = row; p < row + GONIO_PHI_D_BINS; p++) {
        if (s->data[p]) {
            const double share = proportion(s->cosines[p]);
            m->linear[first] += share;
            m->square[first] += share * share;
            for (size_t c = 0; c < GONIO_CHANNELS; c++) {
                m->moment[c][first] += share * s->difference[c * GONIO_SLAB_BINS + p];
            }
        }
    }
    return 1;
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

/* Sums over the bins of a cell, for each of its nodes. */
typedef struct node_sums {
    double share[MOST_NODES];
    double moment[GONIO_CHANNELS][MOST_NODES];
} node_sums;

static void add_bin(const slab *s, size_t bin, const nodes *n, node_sums *sums)
{
    double share[MOST_NODES];
    interpolate(n, s->log_weight[bin], share);
    for (size_t j = 0; j < n->count; j++) {
        sums->share[j] += share[j];
    }
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        const double difference = s->difference[c * GONIO_SLAB_BINS + bin];
        for (size_t j = 0; j < n->count; j++) {
            sums->moment[c][j] += share[j] * difference;
        }
    }
}

/* The nodes of any other terms; returns how many. */
static size_t add_interpolated(const slab *s, size_t row, size_t first, gonio_i_digest_metric *m)
{
    nodes n;
    node_sums sums = {0};
    choose_nodes(s, row, &n);
    for (size_t p = row; p < row + GONIO_PHI_D_BINS; p++) {
        if (s->data[p]) {
            add_bin(s, p, &n, &sums);
        }
    }
    for (size_t j = 0; j < n.count; j++) {
        m->node[first + j] = exp(n.t[j]);
        m->linear[first + j] = sums.share[j];
        m->square[first + j] = sums.share[j];
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            m->moment[c][first + j] = sums.moment[c][j];
        }
    }
    return n.count;
}

/* Cell i of the digest, by one metric. */
static void add_cell(const slab *s, int metric, size_t i, gonio_i_digest *d)
{
    gonio_i_digest_metric *m = &d->metric[metric];
    const size_t row =
        (size_t)gonio_cell_bin(GONIO_BIVARIATE, d->cell[i]).theta_d * GONIO_PHI_D_BINS;
    double (*const proportion)(double) = gonio_i_metric_at(metric)->proportion;
    const size_t first = m->first[i];
    const size_t count = proportion != NULL ? add_proportional(s, row, proportion, first, m)
                                            : add_interpolated(s, row, first, m);
    m->first[i + 1] = first + count;
}

/* The cells of a slab with data. */
static void list_cells(const slab *s, int theta_h, gonio_i_digest *d)
{
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
        if (s->statistics.count[theta_d] == 0) {
            continue;
        }
        d->cell[d->cells] = gonio_cell_of_bin(GONIO_BIVARIATE, (gonio_bin){theta_h, theta_d, 0});
        d->bins += s->statistics.count[theta_d];
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            d->mean[c][d->cells] = s->statistics.mean[theta_d][c];
            d->own[c][d->cells] = gonio_brdf_from_log(d->mean[c][d->cells], c);
        }
        d->cells++;
    }
}

static void add_slab(slab *s, int theta_h, gonio_i_digest *d)
{
    const size_t before = d->cells;
    list_cells(s, theta_h, d);
    for (int metric = 0; metric < gonio_i_metric_count(); metric++) {
        fill_terms(metric, s, d);
        for (size_t i = before; i < d->cells; i++) {
            add_cell(s, metric, i, d);
        }
    }
}

/* ---- the whole ---- */

static bool allocate_channels(gonio_context *context, double **channel, size_t count)
{
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        channel[c] = gonio_i_allocate(context, count, sizeof *channel[c]);
    }
    return channel[0] != NULL && channel[1] != NULL && channel[2] != NULL;
}

static bool allocate_metric(gonio_context *context, int metric, gonio_i_digest_metric *m)
{
    const bool one = gonio_i_metric_at(metric)->proportion != NULL;
    const size_t most = (size_t)GONIO_CELLS * (one ? 1 : MOST_NODES);
    m->first = gonio_i_allocate(context, GONIO_CELLS + 1, sizeof *m->first);
    m->node = gonio_i_allocate(context, most, sizeof *m->node);
    m->linear = gonio_i_allocate(context, most, sizeof *m->linear);
    m->square = gonio_i_allocate(context, most, sizeof *m->square);
    return allocate_channels(context, m->moment, most) && m->first != NULL && m->node != NULL &&
           m->linear != NULL && m->square != NULL;
}

static bool allocate(gonio_context *context, gonio_i_digest *d)
{
    d->cell = gonio_i_allocate(context, GONIO_CELLS, sizeof *d->cell);
    bool done = allocate_channels(context, d->mean, GONIO_CELLS) &&
                allocate_channels(context, d->own, GONIO_CELLS) && d->cell != NULL;
    for (int metric = 0; metric < gonio_i_metric_count() && done; metric++) {
        done = allocate_metric(context, metric, &d->metric[metric]);
    }
    return done;
}

/* Returns the memory that the nodes did not need. */
static void shrink(const gonio_i_digest *d, gonio_i_digest_metric *m)
{
    double **const arrays[] = {&m->node,      &m->linear,    &m->square,
                               &m->moment[0], &m->moment[1], &m->moment[2]};
    const size_t count = m->first[d->cells] > 0 ? m->first[d->cells] : 1;
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
        if (status == GONIO_OK) {
            add_slab(s, theta_h, d);
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
    if (status == GONIO_OK && d->constant.metric[GONIO_E6].reference == 0.0) {
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
    for (int metric = 0; metric < gonio_i_metric_count(); metric++) {
        shrink(made, &made->metric[metric]);
    }
    *digest = made;
    return GONIO_OK;
}

static void free_metric(gonio_i_digest_metric *m)
{
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        free(m->moment[c]);
    }
    free(m->first);
    free(m->node);
    free(m->linear);
    free(m->square);
}

void gonio_i_digest_free(gonio_i_digest **digest)
{
    if (digest == NULL || *digest == NULL) {
        return;
    }
    gonio_i_digest *d = *digest;
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        free(d->mean[c]);
        free(d->own[c]);
    }
    for (int metric = 0; metric < GONIO_MOST_METRICS; metric++) {
        free_metric(&d->metric[metric]);
    }
    free(d->name);
    free(d->cell);
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

/* One channel's estimate. */
typedef struct estimate {
    double *rho;       /* [cells], 1/sr */
    double *x;         /* [nodes] each: the estimate, */
    double *own;       /* x_0, */
    double *change;    /* D, */
    double *reference; /* and what terms are relative to: unused */
} estimate;

static size_t most_nodes(const gonio_i_digest *d)
{
    size_t most = 0;
    for (int metric = 0; metric < gonio_i_metric_count(); metric++) {
        const size_t count = d->metric[metric].first[d->cells];
        most = count > most ? count : most;
    }
    return most;
}

static bool make_estimate(gonio_context *context, const gonio_i_digest *d, estimate *e)
{
    const size_t n = most_nodes(d);
    double *all = gonio_i_allocate(context, d->cells + 4 * n, sizeof *all);
    *e = (estimate){.rho = all};
    if (all != NULL) {
        e->x = all + d->cells;
        e->own = e->x + n;
        e->change = e->own + n;
        e->reference = e->change + n;
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
        e->rho[i] = positive < largest ? positive : largest;
    }
    gonio_i_expm1(d->cells, e->rho, e->rho);
    for (size_t i = 0; i < d->cells; i++) {
        e->rho[i] *= scale;
    }
}

/* D at the nodes. */
static void fill_changes(const gonio_i_digest *d, int metric, int channel, estimate *e)
{
    const gonio_i_digest_metric *m = &d->metric[metric];
    for (size_t i = 0; i < d->cells; i++) {
        for (size_t j = m->first[i]; j < m->first[i + 1]; j++) {
            e->x[j] = e->rho[i];
            e->own[j] = d->own[channel][i];
        }
    }
    const gonio_i_compared values = {.count = m->first[d->cells],
                                     .reference = e->x,
                                     .other = e->own,
                                     .cosines = m->node,
                                     .scale = gonio_log_scale(channel)};
    gonio_i_metric_at(metric)->terms(&values, e->change, e->reference);
}

/* Adds the terms with D of the sums of d_b - D(c_b) and of their squares. */
GONIO_I_VECTORISED static void add_changes(size_t n, const gonio_i_digest_metric *m,
                                           const double *moment, const double *change,
                                           gonio_i_metric_sums *sums)
{
    const double *linear = m->linear;
    const double *squares = m->square;
    double difference = 0.0;
    double square = 0.0;
#pragma omp simd reduction(+ : difference, square)
    for (size_t j = 0; j < n; j++) {
        difference += linear[j] * change[j];
        square += (squares[j] * change[j] - 2.0 * moment[j]) * change[j];
    }
    sums->difference -= difference;
    sums->square += square;
}

static void add_channel(const gonio_i_digest *d, const double *g, int channel, estimate *e,
                        gonio_i_error_sums *sums)
{
    fill_estimate(d, g, channel, e);
    for (int metric = 0; metric < gonio_i_metric_count(); metric++) {
        const gonio_i_digest_metric *m = &d->metric[metric];
        fill_changes(d, metric, channel, e);
        add_changes(m->first[d->cells], m, m->moment[channel], e->change, &sums->metric[metric]);
    }
}

gonio_status gonio_i_digest_compare(gonio_context *context, const gonio_i_digest *digest,
                                    const double *g, gonio_error *error)
{
    estimate e;
    gonio_i_error_sums sums = digest->constant;
    if (!make_estimate(context, digest, &e)) {
        return GONIO_ERROR_MEMORY;
    }
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        add_channel(digest, g, channel, &e, &sums);
    }
    free(e.rho);
    for (int metric = 0; metric < gonio_i_metric_count(); metric++) {
        sums.metric[metric].square = fmax(sums.metric[metric].square, 0.0);
    }
    *error = gonio_i_error_of(&sums, (double)digest->bins * GONIO_CHANNELS);
    return GONIO_OK;
}
