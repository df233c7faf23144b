/* Analytic columns: see analytic.h. */
#include "analytic.h"

#include <stdio.h>
#include <stdlib.h>

#include <gonio/material.h>

#include "../core/core.h"
#include "../database/tiles.h"

static gonio_status read_random(gonio_context *context, const gonio_database *database,
                                size_t number, float *columns)
{
    char name[32];
    gonio_material *material = NULL;
    snprintf(name, sizeof name, "atlas:random-%04zu", number);
    gonio_status status = gonio_material_open(context, name, &material);
    if (status == GONIO_OK) {
        status = gonio_i_database_read_other(context, database, material, columns);
    }
    gonio_material_free(&material);
    return status;
}

static gonio_status read_all(gonio_context *context, const gonio_database *database,
                             size_t materials, size_t values, float *all)
{
    gonio_status result = GONIO_OK;
    size_t finished = 0;
    gonio_context *shared = gonio_i_shared_context_begin(context);
#pragma omp parallel for schedule(dynamic) num_threads(gonio_context_threads(context))
    for (size_t k = 0; k < materials; k++) {
        gonio_status mine;
#pragma omp atomic read
        mine = result;
        if (mine == GONIO_OK) {
            mine = read_random(shared, database, k, all + k * values);
        }
        size_t done;
#pragma omp atomic capture
        done = ++finished;
        if (mine == GONIO_OK) {
            mine = gonio_i_progress(shared, "making analytic materials",
                                    (double)done / (double)materials);
        }
        if (mine != GONIO_OK) {
#pragma omp atomic write
            result = mine;
        }
    }
    gonio_i_shared_context_end(shared, context);
    return result;
}

gonio_status gonio_i_analytic_columns(gonio_context *context, const gonio_database *database,
                                      size_t materials, float **values)
{
    const gonio_database_view *view = gonio_database_describe(database);
    const size_t each = gonio_i_columns_per_material(view->channels) * view->rows;
    *values = gonio_i_allocate(context, materials * each, sizeof **values);
    gonio_status status = *values == NULL ? GONIO_ERROR_MEMORY
                                          : read_all(context, database, materials, each, *values);
    if (status != GONIO_OK) {
        free(*values);
        *values = NULL;
    }
    return status;
}
