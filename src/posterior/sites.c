/* Where a material was read: see sites.h. */
#include "sites.h"

#include <stdlib.h>

#include "../linalg/linalg.h"

static gonio_status allocate(gonio_context *context, gonio_i_sites *s)
{
    const size_t n = s->n;
    s->f = gonio_i_allocate(context, n * s->components, sizeof *s->f);
    s->place = gonio_i_allocate(context, n, sizeof *s->place);
    s->mean = gonio_i_allocate(context, n, sizeof *s->mean);
    s->seen = gonio_i_allocate(context, s->prior->samples * n, sizeof *s->seen);
    s->gram = gonio_i_allocate(context, n * n, sizeof *s->gram);
    s->smooth = gonio_i_allocate(context, n * n, sizeof *s->smooth);
    s->peaked = gonio_i_allocate(context, n * n, sizeof *s->peaked);
    const bool done = s->f && s->place && s->mean && s->seen && s->gram && s->smooth && s->peaked;
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

void gonio_i_sites_free(gonio_i_sites **sites)
{
    if (sites == NULL || *sites == NULL) {
        return;
    }
    free((*sites)->f);
    free((*sites)->place);
    free((*sites)->mean);
    free((*sites)->seen);
    free((*sites)->gram);
    free((*sites)->smooth);
    free((*sites)->peaked);
    free((*sites)->back);
    free(*sites);
    *sites = NULL;
}

/* The kernels between a place and those before it. */
static void relate(gonio_i_sites *s, size_t i)
{
    for (size_t j = 0; j <= i; j++) {
        const double smooth = gonio_i_smooth(&s->place[i], &s->place[j]);
        const double peaked = gonio_i_peaked(&s->place[i], &s->place[j]);
        s->smooth[i * s->n + j] = smooth;
        s->smooth[j * s->n + i] = smooth;
        s->peaked[i * s->n + j] = peaked;
        s->peaked[j * s->n + i] = peaked;
    }
}

static gonio_status relate_back(gonio_context *context, gonio_i_sites *s)
{
    bool any = false;
    for (size_t i = 0; i < s->n; i++) {
        any = any || gonio_i_place_is_back(&s->place[i]);
    }
    s->back = any ? gonio_i_allocate(context, s->n * s->n, sizeof *s->back) : NULL;
    for (size_t i = 0; s->back != NULL && i < s->n * s->n; i++) {
        s->back[i] = gonio_i_back(&s->place[i / s->n], &s->place[i % s->n]);
    }
    return any && s->back == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
}

/* F F' and F z_j. */
static gonio_status see_samples(gonio_context *context, gonio_i_sites *s)
{
    const gonio_i_prior *prior = s->prior;
    const gonio_status status =
        gonio_i_product_transposed(context, s->f, s->n, s->components, s->f, s->n, s->gram, s->n);
    return status == GONIO_OK && prior->samples * s->n > 0
               ? gonio_i_product_transposed(context, prior->sample, prior->samples, s->components,
                                            s->f, s->n, s->seen, s->n)
               : status;
}

/* m and f of an observation: of a spread one, the mean. scratch[K]. */
static void see(gonio_i_sites *s, size_t i, const gonio_i_observation *o, double *scratch)
{
    double *f = s->f + i * s->components;
    if (o->spread == NULL) {
        gonio_i_prior_at(s->prior, o->at, o->channel, &s->mean[i], f);
        return;
    }
    for (size_t j = 0; j < o->spread->count; j++) {
        double mean = 0.0;
        gonio_i_prior_at(s->prior, o->spread->at[j], o->channel, &mean, scratch);
        s->mean[i] += o->spread->weight[j] * mean;
        for (size_t k = 0; k < s->components; k++) {
            f[k] += o->spread->weight[j] * scratch[k];
        }
    }
}

gonio_status gonio_i_sites_create(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_i_column *column, gonio_i_sites **sites)
{
    *sites = NULL;
    gonio_i_sites *s = gonio_i_allocate(context, 1, sizeof *s);
    if (s == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *s = (gonio_i_sites){.prior = prior, .n = column->count, .components = prior->components};
    gonio_status status = allocate(context, s);
    double *scratch = gonio_i_allocate(context, s->components, sizeof *scratch);
    status = scratch == NULL ? GONIO_ERROR_MEMORY : status;
    for (size_t i = 0; i < s->n && status == GONIO_OK; i++) {
        const gonio_i_observation *o = &column->observation[i];
        see(s, i, o, scratch);
        s->place[i] = gonio_i_place_of(o->at);
        relate(s, i);
    }
    free(scratch);
    if (status == GONIO_OK) {
        status = relate_back(context, s);
    }
    if (status == GONIO_OK) {
        status = see_samples(context, s);
    }
    if (status != GONIO_OK) {
        gonio_i_sites_free(&s);
    }
    *sites = s;
    return status;
}

/* ---- sharing ---- */

static bool is_same(const gonio_i_observation *a, const gonio_i_observation *b, bool joint)
{
    return a->at.theta_h == b->at.theta_h && a->at.theta_d == b->at.theta_d &&
           a->at.phi_d == b->at.phi_d && a->spread == b->spread &&
           (!joint || a->channel == b->channel);
}

bool gonio_i_sites_are_same(const gonio_i_prior *prior, const gonio_i_column *a,
                            const gonio_i_column *b)
{
    const bool joint = prior->view->channels == GONIO_JOINT;
    bool same = a->count == b->count;
    for (size_t i = 0; i < a->count && same; i++) {
        same = is_same(&a->observation[i], &b->observation[i], joint);
    }
    return same;
}

gonio_status gonio_i_sites_share(gonio_context *context, const gonio_i_prior *prior,
                                 const gonio_i_column *columns, size_t count, gonio_i_sites **sites)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < count; k++) {
        sites[k] = NULL;
    }
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        size_t j = 0;
        while (j < k && !gonio_i_sites_are_same(prior, &columns[j], &columns[k])) {
            j++;
        }
        sites[k] = sites[j];
        status = j == k ? gonio_i_sites_create(context, prior, &columns[k], &sites[k]) : GONIO_OK;
    }
    return status;
}

void gonio_i_sites_release(gonio_i_sites **sites, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        gonio_i_sites *one = sites[k];
        for (size_t j = k; j < count; j++) {
            sites[j] = sites[j] == one ? NULL : sites[j];
        }
        gonio_i_sites_free(&one);
    }
}

size_t gonio_i_sites_group(const gonio_i_prior *prior, const gonio_i_column *columns, size_t count,
                           size_t *group)
{
    size_t groups = 0;
    for (size_t k = 0; k < count; k++) {
        size_t j = 0;
        while (j < k && !gonio_i_sites_are_same(prior, &columns[j], &columns[k])) {
            j++;
        }
        group[k] = j < k ? group[j] : groups++;
    }
    return groups;
}
