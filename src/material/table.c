/* A material read whole into a table: trilinear look-ups and the albedo. */
#include <gonio/material.h>

#include <math.h>
#include <stdlib.h>

#include "../core/core.h"
#include "look_up.h"
#include "slab.h"
#include "source.h"

struct gonio_table {
    double *rho;                            /* [theta_h][channel][theta_d][phi_d] */
    const double *slab[GONIO_THETA_H_BINS]; /* of rho */
};

static void load_slabs(gonio_context *shared, const gonio_material *material, int threads, int run,
                       double *rho, gonio_status *status)
{
    int finished = 0;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h++) {
        gonio_status mine;
#pragma omp atomic read
        mine = *status;
        if (mine == GONIO_OK) {
            mine = gonio_i_slab_read(shared, material, theta_h, run,
                                     rho + (size_t)theta_h * GONIO_SLAB_VALUES);
        }
        int done;
#pragma omp atomic capture
        done = ++finished;
        if (mine == GONIO_OK) {
            mine = gonio_i_progress(shared, "reading", (double)done / GONIO_THETA_H_BINS);
        }
        if (mine != GONIO_OK) {
#pragma omp atomic write
            *status = mine;
        }
    }
}

gonio_status gonio_i_table_load_runs(gonio_context *context, const gonio_material *material,
                                     int run, gonio_table **table)
{
    gonio_table *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = GONIO_OK;
    made->rho = gonio_i_allocate(context, (size_t)GONIO_THETA_H_BINS * GONIO_SLAB_VALUES,
                                 sizeof *made->rho);
    for (size_t k = 0; made->rho != NULL && k < GONIO_THETA_H_BINS; k++) {
        made->slab[k] = made->rho + k * GONIO_SLAB_VALUES;
    }
    if (made->rho == NULL) {
        status = GONIO_ERROR_MEMORY;
    } else {
        gonio_context *shared = gonio_i_shared_context_begin(context);
        load_slabs(shared, material, gonio_context_threads(context), run, made->rho, &status);
        gonio_i_shared_context_end(shared, context);
    }
    if (status != GONIO_OK) {
        gonio_table_free(&made);
        return status;
    }
    *table = made;
    return GONIO_OK;
}

gonio_status gonio_table_load(gonio_context *context, const gonio_material *material,
                              gonio_table **table)
{
    return gonio_i_table_load_runs(context, material, 1, table);
}

void gonio_table_free(gonio_table **table)
{
    if (table == NULL || *table == NULL) {
        return;
    }
    free((*table)->rho);
    free(*table);
    *table = NULL;
}

const double *gonio_table_values(const gonio_table *table)
{
    return table->rho;
}

bool gonio_table_value(const gonio_table *table, gonio_half_difference coordinates,
                       double rho[GONIO_CHANNELS])
{
    return gonio_i_look_up(table->slab, coordinates, rho);
}

/* The integral over outgoing directions is over half vectors h = (theta_h, phi), with theta_h
 * spaced like the grid. So it resolves the narrowest peak of a table: d omega_o = 4 (i.h) d
 * omega_h.
 */
double gonio_table_albedo(const gonio_table *table, double theta_i, double albedo[GONIO_CHANNELS])
{
    enum { POLAR = 2 * GONIO_THETA_H_BINS, AZIMUTH = 180 };
    const double sine_i = sin(theta_i);
    const double cosine_i = cos(theta_i);
    double all = 0.0; /* projected solid angle */
    double with_data = 0.0;
    albedo[0] = albedo[1] = albedo[2] = 0.0;
    for (int p = 0; p < POLAR; p++) {
        const double t = (p + 0.5) / POLAR;
        const double theta_h = t * t * (M_PI / 2.0);
        const double step = 2.0 * t * (M_PI / 2.0) / POLAR * (M_PI / AZIMUTH);
        for (int a = 0; a < AZIMUTH; a++) { /* half the circle: the plane of incidence mirrors */
            const double phi = M_PI * (a + 0.5) / AZIMUTH;
            const double h[3] = {sin(theta_h) * cos(phi), sin(theta_h) * sin(phi), cos(theta_h)};
            const double i_h = sine_i * h[0] + cosine_i * h[2];
            const double o[3] = {2.0 * i_h * h[0] - sine_i, 2.0 * i_h * h[1],
                                 2.0 * i_h * h[2] - cosine_i};
            double rho[GONIO_CHANNELS];
            const gonio_pair pair = {{theta_i, 0.0},
                                     {atan2(hypot(o[0], o[1]), o[2]), atan2(o[1], o[0])}};
            if (i_h <= 0.0 || o[2] <= 0.0) {
                continue;
            }
            const double weight = 2.0 * o[2] * 4.0 * i_h * sin(theta_h) * step;
            all += weight;
            if (!gonio_table_value(table, gonio_half_difference_from_pair(pair), rho)) {
                continue;
            }
            with_data += weight;
            for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
                albedo[channel] += weight * rho[channel];
            }
        }
    }
    for (int channel = 0; channel < GONIO_CHANNELS && !(with_data > 0.0); channel++) {
        albedo[channel] = NAN;
    }
    return all > 0.0 ? with_data / all : 0.0;
}
