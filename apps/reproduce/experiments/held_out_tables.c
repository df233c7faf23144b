/* Trials with any basis, by way of whole tables: see held_out.h. */
#include <stdlib.h>
#include <string.h>

#include "held_out.h"

typedef struct trial {
    gonio_context *context;
    const gonio_i_method_entry *method;
    const gonio_basis *basis;
    const gonio_plan *plan;
    size_t *rows;                 /* of the plan */
    const gonio_i_viewer *viewer; /* NULL for none */
} trial;

/* ---- a material in memory ---- */

static gonio_status read_table(void *self, gonio_context *context, int theta_h, double *rho)
{
    (void)context;
    const double *values = gonio_table_values(self);
    memcpy(rho, values + (size_t)theta_h * GONIO_SLAB_VALUES, GONIO_SLAB_VALUES * sizeof *rho);
    return GONIO_OK;
}

static void free_table(void *self)
{
    gonio_table *table = self;
    gonio_table_free(&table);
}

static gonio_status load(gonio_context *context, const char *path, gonio_material **loaded)
{
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    gonio_status status = gonio_material_open(context, path, &material);
    if (status == GONIO_OK) {
        status = gonio_table_load(context, material, &table);
    }
    if (status == GONIO_OK) {
        const gonio_material_source source = {
            .size = sizeof source, .read_slab = read_table, .release = free_table, .self = table};
        status =
            gonio_material_create(context, gonio_material_name(material), "table", &source, loaded);
    }
    if (status != GONIO_OK) {
        gonio_table_free(&table);
    }
    gonio_material_free(&material);
    return status;
}

/* ---- one material ---- */

/* Reconstructs a material from noise-free readings of the plan's rows. It has data in all of them.
 */
static gonio_status reconstruct(const trial *t, const gonio_material *material,
                                gonio_reconstruction **made)
{
    const size_t count = t->plan->count;
    gonio_reconstruct_options options;
    gonio_reconstruct_options_default(&options);
    options.components = t->plan->components;
    options.method = gonio_plan_method_reconstruction(t->method->plan);
    double *b = gonio_i_allocate(t->context, GONIO_CHANNELS * count, sizeof *b);
    gonio_status status = b == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = gonio_material_rows(t->context, t->basis, material, t->rows, count, b);
    }
    if (status == GONIO_OK) {
        status =
            gonio_reconstruct_rows_with(t->context, t->basis, &options, t->rows, count, b, made);
    }
    free(b);
    return status;
}

static gonio_status compare(const trial *t, const gonio_material *material,
                            const gonio_reconstruction *made, gonio_error *error)
{
    gonio_material *other = NULL;
    gonio_comparison comparison;
    gonio_status status = gonio_reconstruction_material(t->context, t->basis, made,
                                                        gonio_material_name(material), &other);
    if (status == GONIO_OK) {
        status = gonio_compare(t->context, material, other, &comparison);
    }
    if (status == GONIO_OK) {
        *error = comparison.all;
        status = t->viewer != NULL ? t->viewer->show(t->viewer->user, material, other) : GONIO_OK;
    }
    gonio_material_free(&other);
    return status;
}

static gonio_status test_material(const trial *t, const char *path, gonio_error *error)
{
    gonio_material *material = NULL;
    gonio_reconstruction *made = NULL;
    gonio_status status = load(t->context, path, &material);
    if (status == GONIO_OK) {
        status = reconstruct(t, material, &made);
    }
    if (status == GONIO_OK) {
        status = compare(t, material, made, error);
    }
    gonio_reconstruction_free(&made);
    gonio_material_free(&material);
    return status;
}

/* ---- all of a trial ---- */

/* Learns from the materials of the split, in the method's representation. */
static gonio_status learn(gonio_context *context, const gonio_i_collection *collection,
                          const gonio_i_method_entry *method, gonio_i_size size,
                          const gonio_i_split *split, const gonio_basis **basis)
{
    const gonio_database_options how = {.size = sizeof how,
                                        .representation = method->representation,
                                        .channels = method->channels,
                                        .mapping = method->mapping};
    const gonio_basis_options options = {.size = sizeof options,
                                         .components = size.components,
                                         .subset = split->basis,
                                         .subset_count = split->basis_count,
                                         .without_mean = method->without_mean};
    return gonio_i_basis_cache_learn(context, collection->cache,
                                     (const char *const *)collection->path, collection->count, &how,
                                     &options, basis);
}

static gonio_status make_plan(trial *t, gonio_i_size size, uint64_t seed, gonio_plan **plan)
{
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    options.method = t->method->plan;
    options.components = size.components;
    options.count = size.samples;
    options.restarts = 1;
    options.seed = seed;
    options.keep_history = false;
    t->rows = gonio_i_allocate(t->context, size.samples, sizeof *t->rows);
    if (t->rows == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = gonio_plan_create(t->context, t->basis, &options, plan);
    if (status == GONIO_OK) {
        t->plan = *plan;
        status = gonio_plan_rows(t->context, *plan, t->basis, t->rows);
    }
    return status;
}

gonio_status gonio_i_trial_seen(gonio_context *context, const gonio_i_collection *collection,
                                const gonio_i_method_entry *method, gonio_i_size size,
                                const gonio_i_split *split, uint64_t seed,
                                const gonio_i_viewer *viewer, double *condition,
                                gonio_error *errors)
{
    trial t = {.context = context, .method = method, .viewer = viewer};
    gonio_plan *plan = NULL;
    gonio_status status = learn(context, collection, method, size, split, &t.basis);
    if (status == GONIO_OK) {
        status = make_plan(&t, size, seed, &plan);
    }
    if (status == GONIO_OK) {
        *condition = plan->condition_number;
    }
    for (size_t k = 0; k < split->test_count && status == GONIO_OK; k++) {
        status = test_material(&t, collection->path[split->test[k]], &errors[k]);
    }
    gonio_plan_free(&plan);
    free(t.rows);
    return status;
}

gonio_status gonio_i_trial_tables(gonio_context *context, const gonio_i_collection *collection,
                                  const gonio_i_method_entry *method, gonio_i_size size,
                                  const gonio_i_split *split, uint64_t seed, double *condition,
                                  gonio_error *errors)
{
    return gonio_i_trial_seen(context, collection, method, size, split, seed, NULL, condition,
                              errors);
}
