/* Repeated look-ups of a material at any directions: see sampler.h. */
#include "sampler.h"

#include <math.h>
#include <stdlib.h>

#include "../core/core.h"
#include "azimuth_mean.h"
#include "inside.h"

gonio_status gonio_i_sampler_begin(gonio_context *context, const gonio_material *material,
                                   bool average, gonio_i_sampler *sampler)
{
    *sampler = (gonio_i_sampler){
        .material = material, .view = gonio_material_describe(material), .average = average};
    if (average && sampler->view->anisotropic) {
        gonio_i_note(context, "%s: anisotropic; the mean over azimuths of the sample is written",
                     sampler->view->name);
    }
    return material->source.evaluate == NULL ? gonio_table_load(context, material, &sampler->table)
                                             : GONIO_OK;
}

void gonio_i_sampler_end(gonio_i_sampler *sampler)
{
    gonio_table_free(&sampler->table);
}

static gonio_status look_up(gonio_context *context, const gonio_i_sampler *s,
                            const gonio_pair *pairs, size_t count, double *values)
{
    if (s->table == NULL) {
        return gonio_material_evaluate(context, s->material, pairs, count, values);
    }
    for (size_t k = 0; k < count; k++) {
        double *rho = values + k * GONIO_CHANNELS;
        if (!gonio_table_value(s->table, gonio_half_difference_from_pair(pairs[k]), rho)) {
            rho[0] = rho[1] = rho[2] = NAN;
        }
    }
    return GONIO_OK;
}

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    return look_up(context, self, pairs, count, values);
}

gonio_status gonio_i_sampler_values(gonio_context *context, const gonio_i_sampler *sampler,
                                    const gonio_pair *pairs, size_t count, double *values)
{
    const gonio_i_averaged averaged = {.evaluate = evaluate,
                                       .self = (void *)sampler,
                                       .channels = sampler->view->channels,
                                       .anisotropic = true};
    return sampler->average && sampler->view->anisotropic
               ? gonio_i_azimuth_mean(context, &averaged, pairs, count, values)
               : look_up(context, sampler, pairs, count, values);
}

/* The colour of a direction's channels; NaN without data in all. */
static void to_colour(const gonio_i_sampler *s, const double *values, double rgb[GONIO_CHANNELS])
{
    const size_t channels = s->view->channels;
    bool any = false;
    for (size_t k = 0; k < channels; k++) {
        any = any || !isnan(values[k]);
    }
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        double sum = 0.0;
        for (size_t k = 0; k < channels; k++) {
            const double weight = s->view->wavelength != NULL
                                      ? s->material->weight[c * channels + k]
                                      : (k == (channels == 1 ? 0 : c) ? 1.0 : 0.0);
            sum += isnan(values[k]) ? 0.0 : weight * values[k];
        }
        rgb[c] = any ? fmax(sum, 0.0) : NAN;
    }
}

gonio_status gonio_i_sampler_colours(gonio_context *context, const gonio_i_sampler *sampler,
                                     const gonio_pair *pairs, size_t count, double *rgb)
{
    const size_t channels = sampler->view->channels;
    double *values = gonio_i_allocate(context, count * channels, sizeof *values);
    const gonio_status status = values != NULL
                                    ? gonio_i_sampler_values(context, sampler, pairs, count, values)
                                    : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        to_colour(sampler, values + k * channels, rgb + k * GONIO_CHANNELS);
    }
    free(values);
    return status;
}
