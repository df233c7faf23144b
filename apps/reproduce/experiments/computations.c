/* The numbers of the paper's experiments: see computations.h. */
#include "computations.h"

#include <math.h>
#include <stdlib.h>

#include "held_out.h"

/* ---- JSON ---- */

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

double gonio_i_json_number(const json_t *value)
{
    return json_is_number(value) ? json_number_value(value) : NAN;
}

static json_t *error_json(const gonio_error *error)
{
    json_t *list = json_array();
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        json_array_append_new(list, number(error->value[m]));
    }
    return list;
}

gonio_error gonio_i_json_error(const json_t *value)
{
    gonio_error error = {{0.0}};
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        error.value[m] = gonio_i_json_number(json_array_get(value, (size_t)m));
    }
    return error;
}

static json_t *errors_json(const gonio_error *errors, size_t count)
{
    json_t *list = json_array();
    for (size_t k = 0; k < count; k++) {
        json_array_append_new(list, error_json(&errors[k]));
    }
    return list;
}

/* ---- Fig. 2(a) ---- */

static gonio_status add_variances(gonio_context *context, const gonio_i_study *study,
                                  const size_t *subset, size_t count, json_t *list)
{
    gonio_basis *basis = NULL;
    const gonio_basis_options options = {
        .size = sizeof options, .components = 1, .subset = subset, .subset_count = count};
    const gonio_status status =
        gonio_basis_learn(context, study->collection.database, &options, &basis);
    if (status != GONIO_OK) {
        return status;
    }
    const gonio_basis_view *view = gonio_basis_describe(basis);
    for (size_t k = 0; k < view->variance_count; k++) {
        json_array_append_new(list, number(view->variances[k]));
    }
    gonio_basis_free(&basis);
    return GONIO_OK;
}

gonio_status gonio_i_compute_spectrum(const gonio_i_study *study, gonio_context *context,
                                      const gonio_i_piece *p, json_t *result)
{
    (void)p;
    json_t *all = json_array();
    json_t *splits = json_array();
    json_object_set_new(result, "all", all);
    json_object_set_new(result, "splits", splits);
    gonio_status status = add_variances(context, study, NULL, 0, all);
    for (size_t s = 0; s < study->splits.count && status == GONIO_OK; s++) {
        const gonio_i_split *split = &study->splits.split[s];
        json_t *list = json_array();
        json_array_append_new(splits, list);
        status = add_variances(context, study, split->basis, split->basis_count, list);
    }
    return status;
}

/* ---- Fig. 2(b) and Fig. 4: plans from all materials ---- */

static gonio_status plan_for_all(gonio_context *context, const gonio_basis *basis,
                                 gonio_i_size size, int starts, uint64_t seed, gonio_plan **plan)
{
    gonio_plan_options planning;
    gonio_plan_options_default(&planning);
    planning.components = size.components;
    planning.count = size.samples;
    planning.restarts = starts;
    planning.seed = seed;
    return gonio_plan_create(context, basis, &planning, plan);
}

static gonio_status learn_from_all(gonio_context *context, const gonio_i_study *study,
                                   gonio_i_size size, gonio_basis **basis)
{
    const gonio_basis_options learning = {.size = sizeof learning, .components = size.components};
    return gonio_basis_learn(context, study->collection.database, &learning, basis);
}

/* The condition numbers of a plan's swaps, and the rows that it ends with. */
static gonio_status record_start(gonio_context *context, const gonio_basis *basis,
                                 const gonio_plan *plan, json_t *starts, json_t *rows)
{
    size_t *row = gonio_i_allocate(context, plan->count, sizeof *row);
    if (row == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status = gonio_plan_rows(context, plan, basis, row);
    if (status != GONIO_OK) {
        free(row);
        return status;
    }
    json_t *steps = json_array();
    json_t *chosen = json_array();
    for (size_t k = 0; k < plan->steps; k++) {
        json_array_append_new(steps, number(plan->history[k].condition_number));
    }
    for (size_t k = 0; k < plan->count; k++) {
        json_array_append_new(chosen, json_integer((json_int_t)row[k]));
    }
    json_array_append_new(starts, steps);
    json_array_append_new(rows, chosen);
    free(row);
    return GONIO_OK;
}

/* Each start is a plan of its own, because a plan of several starts keeps the rows of the best
 * only.
 */
gonio_status gonio_i_compute_convergence(const gonio_i_study *study, gonio_context *context,
                                         const gonio_i_piece *p, json_t *result)
{
    (void)p;
    json_t *starts = json_array();
    json_t *rows = json_array();
    gonio_basis *basis = NULL;
    json_object_set_new(result, "starts", starts);
    json_object_set_new(result, "rows", rows);
    gonio_status status = learn_from_all(context, study, study->chosen[0], &basis);
    for (int k = 0; k < GONIO_I_STARTS && status == GONIO_OK; k++) {
        gonio_plan *plan = NULL;
        status =
            plan_for_all(context, basis, study->chosen[0], 1, study->seed + (uint64_t)k, &plan);
        if (status == GONIO_OK) {
            status = record_start(context, basis, plan, starts, rows);
        }
        gonio_plan_free(&plan);
    }
    gonio_basis_free(&basis);
    return status;
}

static json_t *entry_json(const gonio_plan_entry *entry)
{
    return json_pack("[i, i, f, f, f, f]", (int)entry->cell, entry->channel,
                     entry->pair.incident.theta, entry->pair.incident.phi,
                     entry->pair.outgoing.theta, entry->pair.outgoing.phi);
}

gonio_status gonio_i_compute_directions(const gonio_i_study *study, gonio_context *context,
                                        const gonio_i_piece *p, json_t *result)
{
    gonio_plan *plan = NULL;
    gonio_basis *basis = NULL;
    const gonio_i_size size = study->chosen[p->index];
    gonio_status status = learn_from_all(context, study, size, &basis);
    if (status == GONIO_OK) {
        status = plan_for_all(context, basis, size, GONIO_I_STARTS, study->seed, &plan);
    }
    gonio_basis_free(&basis);
    if (status != GONIO_OK) {
        return status;
    }
    json_t *entries = json_array();
    for (size_t k = 0; k < plan->count; k++) {
        json_array_append_new(entries, entry_json(&plan->entries[k]));
    }
    json_object_set_new(result, "condition", number(plan->condition_number));
    json_object_set_new(result, "entries", entries);
    gonio_plan_free(&plan);
    return GONIO_OK;
}

/* ---- Fig. 3(a) ---- */

static gonio_status compute_samples(gonio_context *context, const gonio_i_study *study,
                                    const gonio_i_trial *trial, uint64_t seed, gonio_error *errors,
                                    json_t *result)
{
    gonio_status status = GONIO_OK;
    json_t *conditions = json_array();
    json_t *by_samples = json_array();
    json_object_set_new(result, "condition", conditions);
    json_object_set_new(result, "errors", by_samples);
    for (size_t l = 0; l < study->grid_samples && status == GONIO_OK; l++) {
        double condition = NAN;
        const bool fits = study->grid_sample[l] >= trial->view->components;
        if (fits) {
            status = gonio_i_trial_plan(context, trial, "condition", study->grid_sample[l], seed,
                                        &condition, errors);
        }
        if (status == GONIO_OK) {
            json_array_append_new(conditions, number(condition));
            json_array_append_new(by_samples,
                                  fits ? errors_json(errors, trial->tests) : json_null());
            status = gonio_i_progress(context, "", 0.0);
        }
    }
    return status;
}

gonio_status gonio_i_compute_grid(const gonio_i_study *study, gonio_context *context,
                                  const gonio_i_piece *p, json_t *result)
{
    const gonio_i_split *split = &study->splits.split[p->split];
    gonio_i_trial trial;
    gonio_error *errors = gonio_i_allocate(context, split->test_count, sizeof *errors);
    if (errors == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = gonio_i_trial_begin(context, &study->collection, split->basis,
                                              split->basis_count, study->grid_component[p->index],
                                              split->test, split->test_count, &trial);
    if (status == GONIO_OK) {
        status = compute_samples(context, study, &trial, study->seed + p->split, errors, result);
    }
    if (status == GONIO_OK) {
        status = gonio_i_trial_all_rows(context, &trial, errors);
    }
    if (status == GONIO_OK) {
        json_object_set_new(result, "all", errors_json(errors, split->test_count));
    }
    gonio_i_trial_end(&trial);
    free(errors);
    return status;
}

/* ---- Fig. 3(b) ---- */

gonio_status gonio_i_compute_method(const gonio_i_study *study, gonio_context *context,
                                    const gonio_i_piece *p, json_t *result)
{
    const gonio_i_split *split = &study->splits.split[p->split];
    const gonio_i_method_entry *method = gonio_i_method_at(p->index);
    double condition = NAN;
    gonio_error *errors = gonio_i_allocate(context, split->test_count, sizeof *errors);
    if (errors == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status = gonio_i_trial_method(context, &study->collection, method,
                                                     gonio_i_method_size(study, method), split,
                                                     study->seed + p->split, &condition, errors);
    if (status == GONIO_OK) {
        json_object_set_new(result, "condition", number(condition));
        json_object_set_new(result, "errors", errors_json(errors, split->test_count));
    }
    free(errors);
    return status;
}

/* ---- Fig. 5 ---- */

/* Tests one chosen size; with the last one, all samples too. */
static gonio_status test_size(gonio_context *context, const gonio_i_study *study,
                              const size_t *others, size_t material, size_t chosen,
                              double *condition, gonio_error *errors)
{
    const gonio_i_size size = study->chosen[chosen];
    gonio_i_trial trial;
    gonio_status status =
        gonio_i_trial_begin(context, &study->collection, others, study->collection.count - 1,
                            size.components, &material, 1, &trial);
    if (status == GONIO_OK) {
        status = gonio_i_trial_plan(context, &trial, "condition", size.samples, study->seed,
                                    &condition[chosen], &errors[chosen]);
    }
    if (status == GONIO_OK && chosen == GONIO_I_CHOSEN - 1) {
        status = gonio_i_trial_all_rows(context, &trial, &errors[GONIO_I_ALL_SAMPLES]);
    }
    gonio_i_trial_end(&trial);
    return status;
}

/* All materials but one; NULL when out of memory. */
static size_t *list_others(gonio_context *context, const gonio_i_study *study, size_t material)
{
    size_t *others = gonio_i_allocate(context, study->collection.count, sizeof *others);
    for (size_t m = 0, n = 0; others != NULL && m < study->collection.count; m++) {
        if (m != material) {
            others[n++] = m;
        }
    }
    return others;
}

gonio_status gonio_i_compute_left_out(const gonio_i_study *study, gonio_context *context,
                                      const gonio_i_piece *p, json_t *result)
{
    const size_t material = study->left_out[p->index];
    double condition[GONIO_I_CHOSEN];
    gonio_error errors[GONIO_I_LEFT_OUT_SERIES];
    size_t *others = list_others(context, study, material);
    if (others == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status =
        gonio_i_digest_compare(context, study->collection.digest[material],
                               study->collection.mean[material], &errors[GONIO_I_BIVARIATE_ITSELF]);
    for (size_t k = 0; k < GONIO_I_CHOSEN && status == GONIO_OK; k++) {
        status = test_size(context, study, others, material, k, condition, errors);
    }
    free(others);
    if (status == GONIO_OK) {
        json_t *conditions = json_array();
        for (size_t k = 0; k < GONIO_I_CHOSEN; k++) {
            json_array_append_new(conditions, number(condition[k]));
        }
        json_object_set_new(result, "condition", conditions);
        json_object_set_new(result, "errors", errors_json(errors, GONIO_I_LEFT_OUT_SERIES));
    }
    return status;
}

/* Computes the errors of the method that the paper compares with. */
gonio_status gonio_i_compute_quoted(const gonio_i_study *study, gonio_context *context,
                                    const gonio_i_piece *p, json_t *result)
{
    size_t material = study->quoted[p->index].material;
    const size_t count = study->collection.count - 1;
    double condition = NAN;
    gonio_error error;
    size_t *others = list_others(context, study, material);
    if (others == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_i_split split = {
        .basis = others, .basis_count = count, .test = &material, .test_count = 1};
    const gonio_status status =
        gonio_i_trial_method(context, &study->collection, gonio_i_quoted_method(),
                             gonio_i_quoted_size(count), &split, study->seed, &condition, &error);
    free(others);
    if (status == GONIO_OK) {
        json_object_set_new(result, "condition", number(condition));
        json_object_set_new(result, "error", error_json(&error));
    }
    return status;
}
