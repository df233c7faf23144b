/* Errors of estimates from a digest: see digest.h. */
#include "digest.h"

#include <math.h>
#include <stdlib.h>

#include "../core/core.h"
#include "../core/vector_math.h"

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
