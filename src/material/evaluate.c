/* A material evaluated at any directions: from its own source, or from its table. */
#include <gonio/material.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "inside.h"
#include "look_up.h"
#include "source.h"

enum {
    MOST_CHANNELS = 4096, /* of a colour that is looked up directly */
    BLOCK = 4096          /* directions that a thread evaluates at a time */
};

/* ---- by the source ---- */

/* Marks values without data: below the horizon, beyond the measured angles, or negative. */
static void take_out(const gonio_material_view *view, const gonio_pair *pair, double *values)
{
    const double most = fmax(pair->incident.theta, pair->outgoing.theta);
    const bool outside =
        !(most < M_PI / 2.0) || (view->theta_limit > 0.0 && most > view->theta_limit);
    for (size_t c = 0; c < view->channels; c++) {
        values[c] = outside || !(values[c] >= 0.0 && isfinite(values[c])) ? NAN : values[c];
    }
}

static gonio_status evaluate_blocks(gonio_context *context, const gonio_material *material,
                                    const gonio_pair *pairs, size_t count, double *values)
{
    const gonio_material_source source = gonio_i_material_source(material);
    const gonio_material_view *view = gonio_material_describe(material);
    gonio_context *shared = gonio_i_shared_context_begin(context);
    gonio_status status = GONIO_OK;
/* A single block is left to what the source does in parallel. */
#pragma omp parallel for schedule(dynamic) if (count > BLOCK)                                      \
    num_threads(gonio_context_threads(context))
    for (size_t first = 0; first < count; first += BLOCK) {
        const size_t here = count - first < BLOCK ? count - first : BLOCK;
        double *block = values + first * view->channels;
        const gonio_status mine = source.evaluate(source.self, shared, pairs + first, here, block);
        for (size_t k = 0; k < here && mine == GONIO_OK; k++) {
            take_out(view, &pairs[first + k], block + k * view->channels);
        }
        if (mine != GONIO_OK) {
#pragma omp atomic write
            status = mine;
        }
    }
    gonio_i_shared_context_end(shared, context);
    return status;
}

/* ---- by the table ---- */

/* A direction to look up, in the order of the slabs. */
typedef struct place {
    size_t index;
    int first; /* slabs of its stencil */
    int last;
    gonio_half_difference at;
} place;

static int compare_places(const void *a, const void *b)
{
    const place *x = a;
    const place *y = b;
    return x->first != y->first ? (x->first > y->first) - (x->first < y->first)
                                : (x->index > y->index) - (x->index < y->index);
}

/* The two slabs of a stencil, which are in memory, or those of their rows that are needed. Even and
 * odd slabs have a place each. */
typedef struct window {
    double *buffer[2];
    int held[2];
    bool row[2][GONIO_THETA_D_BINS]; /* which are in memory, if the source reads rows */
    const double *slab[GONIO_THETA_H_BINS];
} window;

static gonio_status hold(gonio_context *context, const gonio_material *material, window *w,
                         int theta_h)
{
    const int at = theta_h % 2;
    if (w->held[at] == theta_h) {
        return GONIO_OK;
    }
    w->held[at] = theta_h;
    w->slab[theta_h] = w->buffer[at];
    memset(w->row[at], 0, sizeof w->row[at]);
    return material->read_row != NULL
               ? GONIO_OK
               : gonio_material_read_slab(context, material, theta_h, w->buffer[at]);
}

/* Reads the rows of the stencil of a direction, whose slabs are held. */
static gonio_status hold_rows(gonio_context *context, const gonio_material *material, window *w,
                              gonio_half_difference coordinates)
{
    const gonio_material_source *source = &material->source;
    gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
    const int points = material->read_row != NULL ? gonio_i_trilinear(coordinates, stencil) : 0;
    gonio_status status = GONIO_OK;
    for (int k = 0; k < points && status == GONIO_OK; k++) {
        const gonio_bin bin = stencil[k].bin;
        bool *row = &w->row[bin.theta_h % 2][bin.theta_d];
        if (!*row) {
            status = material->read_row(source->self, context, bin.theta_h, bin.theta_d,
                                        w->buffer[bin.theta_h % 2]);
            *row = true;
        }
    }
    return status;
}

static gonio_status look_up_places(gonio_context *context, const gonio_material *material,
                                   const place *places, size_t count, window *w, double *values)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        double *rho = values + places[k].index * GONIO_CHANNELS;
        status = hold(context, material, w, places[k].first);
        if (status == GONIO_OK) {
            status = hold(context, material, w, places[k].last);
        }
        if (status == GONIO_OK) {
            status = hold_rows(context, material, w, places[k].at);
        }
        if (status == GONIO_OK && !gonio_i_look_up(w->slab, places[k].at, rho)) {
            rho[0] = rho[1] = rho[2] = NAN;
        }
    }
    return status;
}

/* Room for a slab, not cleared: what is looked at was read into it, and of few rows the rest is
 * never touched. */
static double *make_slab(gonio_context *context)
{
    double *slab = malloc(GONIO_SLAB_VALUES * sizeof *slab);
    if (slab == NULL) {
        gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    return slab;
}

static gonio_status look_up(gonio_context *context, const gonio_material *material,
                            const gonio_pair *pairs, size_t count, double *values)
{
    window w = {.held = {-1, -1}};
    place *places = gonio_i_allocate(context, count, sizeof *places);
    for (size_t k = 0; k < 2; k++) {
        w.buffer[k] = make_slab(context);
    }
    gonio_status status = GONIO_ERROR_MEMORY;
    if (places != NULL && w.buffer[0] != NULL && w.buffer[1] != NULL) {
        for (size_t k = 0; k < count; k++) {
            gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
            places[k].index = k;
            places[k].at = gonio_half_difference_from_pair(pairs[k]);
            gonio_i_trilinear(places[k].at, stencil);
            gonio_i_stencil_slabs(stencil, &places[k].first, &places[k].last);
        }
        qsort(places, count, sizeof *places, compare_places);
        status = look_up_places(context, material, places, count, &w, values);
    }
    free(w.buffer[0]);
    free(w.buffer[1]);
    free(places);
    return status;
}

gonio_status gonio_material_evaluate(gonio_context *context, const gonio_material *material,
                                     const gonio_pair *pairs, size_t count, double *values)
{
    return gonio_i_material_source(material).evaluate != NULL
               ? evaluate_blocks(context, material, pairs, count, values)
               : look_up(context, material, pairs, count, values);
}

/* ---- one colour ---- */

bool gonio_i_material_is_direct(const gonio_material *material)
{
    return material->source.evaluate != NULL && material->source.channels <= MOST_CHANNELS;
}

static double mix_channels(const gonio_material *material, const double *values, size_t channel)
{
    const size_t channels = material->source.channels;
    if (material->weight == NULL) {
        const double value = values[channels == 1 ? 0 : channel];
        return isnan(value) ? 0.0 : value;
    }
    double sum = 0.0;
    for (size_t k = 0; k < channels; k++) {
        sum += isnan(values[k]) ? 0.0 : material->weight[channel * channels + k] * values[k];
    }
    return fmax(sum, 0.0);
}

bool gonio_i_material_colour(const gonio_material *material, gonio_pair pair,
                             double rgb[GONIO_CHANNELS])
{
    const gonio_material_source *source = &material->source;
    const gonio_material_view *view = gonio_material_describe(material);
    double values[MOST_CHANNELS];
    bool any = false;
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    if (source->evaluate(source->self, NULL, &pair, 1, values) != GONIO_OK) {
        return false;
    }
    take_out(view, &pair, values);
    for (size_t k = 0; k < view->channels; k++) {
        any = any || !isnan(values[k]);
    }
    for (size_t c = 0; c < GONIO_CHANNELS && any; c++) {
        rgb[c] = mix_channels(material, values, c);
    }
    return any;
}
