/* Analytic columns: see analytic.h. */
#include "analytic.h"

#include <stdio.h>
#include <stdlib.h>

#include <gonio/material.h>

#include "../core/core.h"
#include "../core/random.h"
#include "../database/tiles.h"
#include "elongation.h"

/* What all random materials are read with. */
typedef struct reading {
    const gonio_basis *basis;
    const gonio_database *database;
    double *across; /* [cells], elongation.h */
    size_t values;  /* of a material */
} reading;

static double log_ratio_of(size_t number)
{
    gonio_i_random random;
    gonio_i_random_seed(&random, 2, (uint64_t)number); /* 1 is that of their parameters */
    return GONIO_I_ELONGATION * gonio_i_random_normal(&random);
}

static gonio_status read_random(gonio_context *context, const reading *r, size_t number,
                                float *columns)
{
    char name[32];
    gonio_material *material = NULL;
    float *isotropic = gonio_i_allocate(context, r->values, sizeof *isotropic);
    if (isotropic == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    snprintf(name, sizeof name, "atlas:random-%04zu", number);
    gonio_status status = gonio_material_open(context, name, &material);
    if (status == GONIO_OK) {
        status = gonio_i_database_read_other(context, r->database, material, isotropic);
    }
    if (status == GONIO_OK) {
        gonio_i_elongate(r->basis, r->across, log_ratio_of(number), isotropic, columns);
    }
    gonio_material_free(&material);
    free(isotropic);
    return status;
}

static gonio_status read_all(gonio_context *context, const reading *r, size_t materials, float *all)
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
            mine = read_random(shared, r, k, all + k * r->values);
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

gonio_status gonio_i_analytic_columns(gonio_context *context, const gonio_basis *basis,
                                      const gonio_database *database, size_t materials,
                                      float **values)
{
    reading r = {basis, database, NULL,
                 gonio_i_columns_per_material(basis->channels) * basis->rows};
    r.across = gonio_i_allocate(context, basis->cells, sizeof *r.across);
    *values = gonio_i_allocate(context, materials * r.values, sizeof **values);
    gonio_status status = r.across == NULL || *values == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        gonio_i_elongation_of_cells(basis, r.across);
        status = read_all(context, &r, materials, *values);
    }
    free(r.across);
    if (status != GONIO_OK) {
        free(*values);
        *values = NULL;
    }
    return status;
}
