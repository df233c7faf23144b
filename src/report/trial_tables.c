/* Trials with any basis, by way of whole tables: see trial.h. */
#include <math.h>
#include <stdlib.h>

#include "trial.h"

typedef struct trial {
    gonio_context *context;
    const gonio_i_method_entry *method;
    gonio_i_size size;
    const gonio_basis *basis;
    gonio_basis_view view;
    const gonio_plan *plan;
    const gonio_i_viewer *viewer; /* NULL for none */
} trial;

/* Whether the material has data in a cell. */
static bool has_data(const trial *t, const gonio_table *table, const double *mean, int32_t cell)
{
    if (t->view.representation == GONIO_BIVARIATE) {
        return !isnan(mean[(size_t)cell * GONIO_CHANNELS]);
    }
    const size_t slab = (size_t)cell / GONIO_SLAB_BINS;
    const size_t bin = (size_t)cell % GONIO_SLAB_BINS;
    return gonio_table_values(table)[slab * GONIO_SLAB_VALUES + bin] >= 0.0;
}

/* The plan's rows where the material has data, and how many these are. */
static size_t find_rows(const trial *t, const gonio_table *table, const double *mean, size_t *rows)
{
    size_t count = 0;
    gonio_plan_rows(t->plan, t->basis, rows);
    for (size_t i = 0; i < t->plan->count; i++) {
        rows[count] = rows[i];
        count += has_data(t, table, mean, t->plan->entries[i].cell);
    }
    return count;
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

static gonio_status reconstruct(const trial *t, const gonio_material *material, const size_t *rows,
                                size_t count, gonio_reconstruction **made)
{
    gonio_reconstruct_options options;
    gonio_reconstruct_options_default(&options);
    options.components = t->plan->components;
    options.method = gonio_plan_method_reconstruction(t->method->plan);
    double *b = gonio_i_allocate(t->context, GONIO_CHANNELS * count, sizeof *b);
    gonio_status status = b == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = gonio_material_rows(t->context, t->basis, material, rows, count, b);
    }
    if (status == GONIO_OK) {
        status = gonio_reconstruct_rows_with(t->context, t->basis, &options, rows, count, b, made);
    }
    free(b);
    return status;
}

static gonio_status test_material(const trial *t, const gonio_material *material,
                                  const double *mean, gonio_error *error)
{
    gonio_table *table = NULL;
    gonio_reconstruction *made = NULL;
    size_t *rows = gonio_i_allocate(t->context, t->plan->count, sizeof *rows);
    gonio_status status = rows == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK && t->view.representation == GONIO_FULL) {
        status = gonio_table_load(t->context, material, &table);
    }
    if (status == GONIO_OK) {
        const size_t count = find_rows(t, table, mean, rows);
        status = reconstruct(t, material, rows, count, &made);
    }
    if (status == GONIO_OK) {
        status = compare(t, material, made, error);
    }
    gonio_reconstruction_free(&made);
    gonio_table_free(&table);
    free(rows);
    return status;
}

static gonio_status test_all(const trial *t, const gonio_i_collection *collection,
                             const gonio_i_split *split, gonio_error *errors)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < split->test_count && status == GONIO_OK; k++) {
        gonio_material *material = NULL;
        status = gonio_material_open(t->context, collection->path[split->test[k]], &material);
        if (status == GONIO_OK) {
            status = test_material(t, material, collection->mean[split->test[k]], &errors[k]);
        }
        gonio_material_free(&material);
    }
    return status;
}

/* Learns from the materials of the split alone, in the method's representation. */
static gonio_status learn(gonio_context *context, const gonio_i_collection *collection,
                          const gonio_i_method_entry *method, gonio_i_size size,
                          const gonio_i_split *split, gonio_basis **basis)
{
    const gonio_database_options how = {.representation = method->representation,
                                        .channels = method->channels,
                                        .mapping = method->mapping};
    const gonio_basis_options options = {.components = size.components,
                                         .without_mean = method->without_mean};
    gonio_database *database = NULL;
    if (method->representation == GONIO_BIVARIATE && method->channels == GONIO_JOINT &&
        method->mapping == GONIO_LOG) { /* which has been read already */
        gonio_basis_options subset = options;
        subset.subset = split->basis;
        subset.subset_count = split->basis_count;
        return gonio_basis_learn(context, collection->database, &subset, basis);
    }
    const char **paths = gonio_i_allocate(context, split->basis_count, sizeof(char *));
    if (paths == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < split->basis_count; k++) {
        paths[k] = collection->path[split->basis[k]];
    }
    gonio_status status =
        gonio_database_create(context, paths, split->basis_count, &how, &database);
    if (status == GONIO_OK) {
        status = gonio_basis_learn(context, database, &options, basis);
    }
    gonio_database_free(&database);
    free(paths);
    return status;
}

static gonio_status run(gonio_context *context, const gonio_i_collection *collection,
                        const gonio_i_method_entry *method, gonio_i_size size,
                        const gonio_i_split *split, uint64_t seed, const gonio_i_viewer *viewer,
                        double *condition, gonio_error *errors)
{
    gonio_basis *basis = NULL;
    gonio_plan *plan = NULL;
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    options.method = method->plan;
    options.components = size.components;
    options.count = size.samples;
    options.restarts = 1;
    options.seed = seed;
    options.keep_history = false;
    gonio_status status = learn(context, collection, method, size, split, &basis);
    if (status == GONIO_OK) {
        status = gonio_plan_create(context, basis, &options, &plan);
    }
    if (status == GONIO_OK) {
        const trial t = {context, method, size, basis, gonio_basis_describe(basis), plan, viewer};
        *condition = plan->condition_number;
        status = test_all(&t, collection, split, errors);
    }
    gonio_plan_free(&plan);
    gonio_basis_free(&basis);
    return status;
}

gonio_status gonio_i_trial_seen(gonio_context *context, const gonio_i_collection *collection,
                                const gonio_i_method_entry *method, gonio_i_size size,
                                const gonio_i_split *split, uint64_t seed,
                                const gonio_i_viewer *viewer, double *condition,
                                gonio_error *errors)
{
    gonio_status status = GONIO_OK;
#pragma omp critical(gonio_trial_tables)
    status = run(context, collection, method, size, split, seed, viewer, condition, errors);
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
