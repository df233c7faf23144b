/* Reconstructions written as MERL tables, several at a time. */
#include <gonio/reconstruct.h>

#include "../core/core.h"
#include "../material/formats/merl.h"
#include "solve_many.h"

typedef struct batch {
    gonio_context *context;
    const gonio_basis *basis;
    const char *const *paths;
    gonio_reconstruction **made;
    int threads; /* for each */
    gonio_i_tables_progress progress;
    gonio_status status; /* of the first that failed */
} batch;

/* Writes table k all but the last step. */
static gonio_status write_table(batch *all, gonio_context *shared, size_t k, gonio_i_output *output)
{
    gonio_material *material = NULL;
    gonio_status status = gonio_reconstruction_material(shared, all->basis, all->made[k],
                                                        "reconstruction", &material);
    if (status == GONIO_OK) {
        status = gonio_i_merl_write(shared, material, all->paths[k], all->threads, &all->progress,
                                    output);
    }
    gonio_material_free(&material);
    return status;
}

/* Puts table k in place, unless one before it failed. */
static void finish_table(batch *all, gonio_context *shared, size_t k, gonio_status written,
                         gonio_i_output *output)
{
    gonio_status before;
#pragma omp atomic read
    before = all->status;
    const gonio_status status =
        gonio_i_output_close(shared, output, before != GONIO_OK ? before : written);
    if (status != GONIO_OK) {
        gonio_reconstruction_free(&all->made[k]);
#pragma omp atomic write
        all->status = status;
    }
}

/* Writes several tables at a time: one waits for the disk while another computes. They are put in
 * place in order. */
static void write_tables(batch *all, size_t count)
{
    const size_t threads = (size_t)gonio_context_threads(all->context);
    const size_t at_once = count < threads ? count : threads;
    gonio_context *shared = gonio_i_shared_context_begin(all->context);
    all->threads = at_once > 0 ? (int)(threads / at_once) : 1;
#pragma omp parallel for ordered schedule(dynamic) num_threads((int)(at_once > 0 ? at_once : 1))
    for (size_t k = 0; k < count; k++) {
        gonio_i_output output = {.descriptor = -1, .final = -1};
        gonio_status status;
#pragma omp atomic read
        status = all->status;
        if (status == GONIO_OK) {
            status = write_table(all, shared, k, &output);
        }
#pragma omp ordered
        finish_table(all, shared, k, status, &output);
    }
    gonio_i_shared_context_end(shared, all->context);
}

gonio_status gonio_reconstruct_tables(gonio_context *context, const gonio_basis *basis,
                                      const gonio_readings *const *readings,
                                      const char *const *paths, size_t count,
                                      const gonio_reconstruct_options *options,
                                      gonio_reconstruction **made)
{
    batch all = {.context = context, .basis = basis, .paths = paths, .made = made};
    for (size_t k = 0; k < count; k++) {
        made[k] = NULL;
    }
    size_t solved = 0;
    const gonio_status unsolved =
        gonio_i_solve_many(context, basis, readings, count, options, made, &solved);
    all.progress = (gonio_i_tables_progress){"reconstructing", 0, solved};
    write_tables(&all, solved);
    if (all.status == GONIO_OK) {
        all.status = gonio_i_progress(context, all.progress.task, 1.0);
    }
    return all.status != GONIO_OK ? all.status : unsolved;
}
