/* Repeated look-ups of a material at any directions: see sampler.h. */
#include "sampler.h"

#include <math.h>
#include <stdlib.h>

#include "../core/core.h"
#include "inside.h"

enum { AZIMUTHS = 8 };

gonio_status gonio_i_sampler_begin(gonio_context *context, const gonio_material *material,
                                   bool average, gonio_i_sampler *sampler)
{
    *sampler = (gonio_i_sampler){.material = material,
                                 .view = gonio_material_describe(material),
                                 .average = average,
                                 .azimuths = 1};
    if (average && sampler->view->anisotropic) {
        sampler->azimuths = AZIMUTHS;
        gonio_i_note(context, "%s: anisotropic; the mean over %d azimuths of the sample is written",
                     sampler->view->name, AZIMUTHS);
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

/* Adds the values of one azimuth to sums, and counts those that exist. */
static void add_azimuth(const double *rotated, size_t count, double *sum, double *counts)
{
    for (size_t k = 0; k < count; k++) {
        sum[k] += isnan(rotated[k]) ? 0.0 : rotated[k];
        counts[k] += isnan(rotated[k]) ? 0.0 : 1.0;
    }
}

static gonio_status average_azimuths(gonio_context *context, const gonio_i_sampler *s,
                                     const gonio_pair *pairs, size_t count, double *values)
{
    const size_t numbers = count * s->view->channels;
    gonio_pair *rotated = gonio_i_allocate(context, count, sizeof *rotated);
    double *one = gonio_i_allocate(context, numbers, sizeof *one);
    double *counts = gonio_i_allocate(context, numbers, sizeof *counts);
    gonio_status status =
        rotated != NULL && one != NULL && counts != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < numbers; k++) {
        values[k] = 0.0;
    }
    for (size_t t = 0; t < s->azimuths && status == GONIO_OK; t++) {
        for (size_t k = 0; k < count; k++) {
            const double angle = 2.0 * M_PI * (double)t / (double)s->azimuths;
            rotated[k] = pairs[k];
            rotated[k].incident.phi += angle;
            rotated[k].outgoing.phi += angle;
        }
        status = look_up(context, s, rotated, count, one);
        if (status == GONIO_OK) {
            add_azimuth(one, numbers, values, counts);
        }
    }
    for (size_t k = 0; k < numbers && status == GONIO_OK; k++) {
        values[k] = counts[k] > 0.0 ? values[k] / counts[k] : NAN;
    }
    free(rotated);
    free(one);
    free(counts);
    return status;
}

gonio_status gonio_i_sampler_values(gonio_context *context, const gonio_i_sampler *sampler,
                                    const gonio_pair *pairs, size_t count, double *values)
{
    return sampler->azimuths > 1 ? average_azimuths(context, sampler, pairs, count, values)
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
