/* Errors between two BRDFs: see evaluate.h. */
#include <gonio/evaluate.h>

#include <stdlib.h>

#include "../core/core.h"
#include "../direction/grid.h"
#include "../metric/metric.h"
#include "compare_sums.h"

/* One thread's scratch. */
typedef struct scratch {
    double *reference; /* slabs, 1/sr */
    double *other;
    double *terms;   /* [2][bins] */
    double *cosines; /* c_i c_o of each bin */
    bool *data;
    bool *data_other;
} scratch;

static bool make_scratch(gonio_context *context, scratch *s)
{
    s->reference = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof(double));
    s->other = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof(double));
    s->terms = gonio_i_allocate(context, (size_t)2 * GONIO_SLAB_BINS, sizeof(double));
    s->cosines = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(double));
    s->data = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(bool));
    s->data_other = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof(bool));
    return s->reference != NULL && s->other != NULL && s->terms != NULL && s->cosines != NULL &&
           s->data != NULL && s->data_other != NULL;
}

static void free_scratch(scratch *s)
{
    free(s->reference);
    free(s->other);
    free(s->terms);
    free(s->cosines);
    free(s->data);
    free(s->data_other);
}

/* Bins without data are 0 in both, and so add nothing to any sum. */
static void sum_channel(const scratch *s, int channel, gonio_i_error_sums *sums)
{
    const size_t plane = (size_t)channel * GONIO_SLAB_BINS;
    const gonio_i_compared values = {.count = GONIO_SLAB_BINS,
                                     .reference = s->reference + plane,
                                     .other = s->other + plane,
                                     .cosines = s->cosines,
                                     .scale = gonio_log_scale(channel)};
    gonio_i_error_add_values(&values, s->terms, sums);
}

static gonio_status sum_slab(gonio_context *context, const gonio_material *reference,
                             const gonio_material *other, int theta_h, const scratch *s,
                             gonio_i_slab_sums *sums)
{
    gonio_status status = gonio_material_read_slab(context, reference, theta_h, s->reference);
    if (status == GONIO_OK) {
        status = gonio_material_read_slab(context, other, theta_h, s->other);
    }
    if (status != GONIO_OK) {
        return status;
    }
    gonio_slab_mask(theta_h, s->reference, s->data);
    gonio_slab_mask(theta_h, s->other, s->data_other);
    gonio_i_slab_cosines(theta_h, s->cosines);
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        const bool both = s->data[k] && s->data_other[k];
        sums->bins += both;
        sums->missing += s->data[k] && !both;
        for (size_t v = k; v < GONIO_SLAB_VALUES && !both; v += GONIO_SLAB_BINS) {
            s->reference[v] = 0.0;
            s->other[v] = 0.0;
        }
    }
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        sum_channel(s, channel, &sums->channel[channel]);
    }
    return GONIO_OK;
}

static gonio_status sum_slabs(gonio_context *context, const gonio_material *reference,
                              const gonio_material *other,
                              gonio_i_slab_sums slabs[GONIO_THETA_H_BINS])
{
    gonio_status result = GONIO_OK;
    gonio_context *shared = gonio_i_shared_context_begin(context);
#pragma omp parallel num_threads(gonio_context_threads(context))
    {
        scratch s = {0};
        gonio_status mine = make_scratch(shared, &s) ? GONIO_OK : GONIO_ERROR_MEMORY;
#pragma omp for schedule(dynamic)
        for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h++) {
            if (mine == GONIO_OK) {
                mine = sum_slab(shared, reference, other, theta_h, &s, &slabs[theta_h]);
            }
        }
        free_scratch(&s);
#pragma omp critical(gonio_compare)
        result = mine != GONIO_OK ? mine : result;
    }
    gonio_i_shared_context_end(shared, context);
    return result;
}

gonio_status gonio_compare(gonio_context *context, const gonio_material *reference,
                           const gonio_material *other, gonio_comparison *comparison)
{
    gonio_i_slab_sums *slabs = gonio_i_allocate(context, GONIO_THETA_H_BINS, sizeof *slabs);
    if (slabs == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const bool turned = gonio_material_describe(reference)->anisotropic ||
                        gonio_material_describe(other)->anisotropic;
    const gonio_status status = turned ? gonio_i_compare_turned(context, reference, other, slabs)
                                       : sum_slabs(context, reference, other, slabs);
    gonio_i_slab_sums sums = {0};
    gonio_i_error_sums all = {0};
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h++) {
        sums.bins += slabs[theta_h].bins;
        sums.missing += slabs[theta_h].missing;
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            gonio_i_error_add(&sums.channel[channel], &slabs[theta_h].channel[channel]);
            gonio_i_error_add(&all, &slabs[theta_h].channel[channel]);
        }
    }
    free(slabs);
    if (status != GONIO_OK) {
        return status;
    }
    if (sums.bins == 0 || all.metric[GONIO_E6].reference == 0.0) {
        return gonio_i_fail(context, GONIO_ERROR_DATA,
                            sums.bins == 0 ? "%s and %s have data in no common bin"
                                           : "%s is black: no error relative to it (%s)",
                            gonio_material_name(reference), gonio_material_name(other));
    }
    comparison->bins = sums.bins;
    comparison->missing = sums.missing;
    comparison->all = gonio_i_error_of(&all, (double)sums.bins * GONIO_CHANNELS);
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        comparison->channel[channel] = gonio_i_error_of(&sums.channel[channel], (double)sums.bins);
    }
    return GONIO_OK;
}
