/* Digests of materials for the errors of bivariate estimates: see digest.h. */
#include "digest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "../core/vector_math.h"
#include "../direction/grid.h"
#include "chebyshev.h"

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
static void choose_nodes(const slab *s, size_t row, gonio_i_nodes *n)
{
    double low = HUGE_VAL;
    double high = -HUGE_VAL;
    for (size_t p = 0; p < GONIO_PHI_D_BINS; p++) {
        if (s->cosines[row + p] > 0.0) {
            low = fmin(low, s->log_weight[row + p]);
            high = fmax(high, s->log_weight[row + p]);
        }
    }
    gonio_i_place_nodes(low, high, n);
}

/* Sums over the bins of a cell, for each of its nodes. */
typedef struct node_sums {
    double share[GONIO_I_MOST_NODES];
    double moment[GONIO_CHANNELS][GONIO_I_MOST_NODES];
} node_sums;

static void add_bin(const slab *s, size_t bin, const gonio_i_nodes *n, node_sums *sums)
{
    double share[GONIO_I_MOST_NODES];
    gonio_i_interpolate_nodes(n, s->log_weight[bin], share);
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
    gonio_i_nodes n;
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
    const size_t most = (size_t)GONIO_CELLS * (one ? 1 : GONIO_I_MOST_NODES);
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
