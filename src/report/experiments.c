/* The paper's experiments as pieces of work: see experiments.h. */
#include "experiments.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "trial.h"

/* One piece: what kind it is, and which of them. */
typedef struct part {
    int kind; /* in the table below */
    size_t split;
    size_t index; /* of the grid's components, the method, the chosen size, the left-out material */
} part;

typedef struct plan_of_work {
    const gonio_i_study *study;
    size_t count;
    part *part; /* [count] */
} plan_of_work;

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
    json_array_append_new(list, number(error->e6));
    json_array_append_new(list, number(error->cube_root));
    json_array_append_new(list, number(error->log_relative));
    return list;
}

gonio_error gonio_i_json_error(const json_t *value)
{
    return (gonio_error){gonio_i_json_number(json_array_get(value, 0)),
                         gonio_i_json_number(json_array_get(value, 1)),
                         gonio_i_json_number(json_array_get(value, 2))};
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
    const gonio_basis_options options = {.components = 1, .subset = subset, .subset_count = count};
    const gonio_status status =
        gonio_basis_learn(context, study->collection.database, &options, &basis);
    if (status != GONIO_OK) {
        return status;
    }
    const gonio_basis_view view = gonio_basis_describe(basis);
    for (size_t k = 0; k < view.variance_count; k++) {
        json_array_append_new(list, number(view.variances[k]));
    }
    gonio_basis_free(&basis);
    return GONIO_OK;
}

static gonio_status compute_spectrum(const gonio_i_study *study, gonio_context *context,
                                     const part *p, json_t *result)
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
    const gonio_basis_options learning = {.components = size.components};
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
    gonio_plan_rows(plan, basis, row);
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

/* Each start is a plan of its own, since of several a plan keeps the rows of the best. */
static gonio_status compute_convergence(const gonio_i_study *study, gonio_context *context,
                                        const part *p, json_t *result)
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

static gonio_status compute_directions(const gonio_i_study *study, gonio_context *context,
                                       const part *p, json_t *result)
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
        const bool fits = study->grid_sample[l] >= trial->view.components;
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

static gonio_status compute_grid(const gonio_i_study *study, gonio_context *context, const part *p,
                                 json_t *result)
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

static gonio_status compute_method(const gonio_i_study *study, gonio_context *context,
                                   const part *p, json_t *result)
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

/* One chosen size, and with the last of them all samples too. */
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

static gonio_status compute_left_out(const gonio_i_study *study, gonio_context *context,
                                     const part *p, json_t *result)
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

/* The method that the paper quotes beside its own. */
static gonio_status compute_quoted(const gonio_i_study *study, gonio_context *context,
                                   const part *p, json_t *result)
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

/* ---- costs: seconds, roughly ---- */

/* A plan's, as measured for K = 5 .. 60 and L = 10 .. 200. */
static double plan_cost(size_t components, size_t samples)
{
    const double k = (double)components;
    return samples < components ? 0.0 : (double)samples * (0.0016 + 6e-5 * k + 1e-6 * k * k);
}

static double size_cost(gonio_i_size size)
{
    return plan_cost(size.components, size.samples);
}

static double spectrum_cost(const gonio_i_study *study, const part *p)
{
    (void)p;
    return 0.05 * (double)(1 + study->splits.count);
}

static double shown_cost(const gonio_i_study *study, const part *p)
{
    return 0.05 + GONIO_I_STARTS * size_cost(study->chosen[p->index]);
}

static double grid_cost(const gonio_i_study *study, const part *p)
{
    const double tests = (double)study->splits.split[p->split].test_count;
    double cost = 0.1;
    for (size_t l = 0; l < study->grid_samples; l++) {
        cost += plan_cost(study->grid_component[p->index], study->grid_sample[l]) + 0.001 * tests;
    }
    return cost;
}

/* Methods of the full grid. Those that learn the same cost the same, so that for each split they
 * follow each other and the second finds the basis that the first has left on the shelf. */
static const double JOINT_COST = 40.0;
static const double SEPARATE_COST = 15.0;

static bool is_of_full_grid(const gonio_i_study *study, const part *p)
{
    (void)study;
    return gonio_i_method_at(p->index)->representation == GONIO_FULL;
}

static bool is_always(const gonio_i_study *study, const part *p)
{
    (void)study;
    (void)p;
    return true;
}

static double quoted_cost(const gonio_i_study *study, const part *p)
{
    (void)study;
    (void)p;
    return JOINT_COST;
}

/* A random choice costs nothing. */
static double method_cost(const gonio_i_study *study, const part *p)
{
    const gonio_i_method_entry *method = gonio_i_method_at(p->index);
    if (is_of_full_grid(study, p)) {
        return method->channels == GONIO_JOINT ? JOINT_COST : SEPARATE_COST;
    }
    return strcmp(method->plan, "random") == 0
               ? 0.1
               : 0.1 + size_cost(gonio_i_method_size(study, method));
}

static double left_out_cost(const gonio_i_study *study, const part *p)
{
    (void)p;
    double cost = 0.2;
    for (size_t k = 0; k < GONIO_I_CHOSEN; k++) {
        cost += size_cost(study->chosen[k]);
    }
    return cost;
}

/* ---- the kinds of pieces ---- */

typedef struct kind {
    gonio_i_experiment experiment;
    bool by_split;
    size_t (*count)(const gonio_i_study *study); /* for each split; NULL for one */
    char *(*name)(const gonio_i_study *study, const part *p);
    double (*cost)(const gonio_i_study *study, const part *p);
    gonio_status (*compute)(const gonio_i_study *study, gonio_context *context, const part *p,
                            json_t *result);
    bool (*one_at_a_time)(const gonio_i_study *study, const part *p); /* NULL for no */
} kind;

enum { KINDS = 7 };

static const kind kinds[KINDS];

/* ---- names ---- */

static char *plain_name(const gonio_i_study *study, const part *p)
{
    (void)study;
    return strdup(gonio_experiment_name((int)kinds[p->kind].experiment));
}

static char *grid_name(const gonio_i_study *study, const part *p)
{
    return gonio_i_format("fig3a-split-%02zu-basis-%zu", p->split + 1,
                          study->grid_component[p->index]);
}

static char *method_name(const gonio_i_study *study, const part *p)
{
    (void)study;
    return gonio_i_format("fig3b-%s-split-%02zu", gonio_i_method_at(p->index)->name, p->split + 1);
}

static char *directions_name(const gonio_i_study *study, const part *p)
{
    return gonio_i_format("fig4-samples-%zu", study->chosen[p->index].samples);
}

static char *left_out_name(const gonio_i_study *study, const part *p)
{
    return gonio_i_format("fig5-%s",
                          gonio_i_name_of(&study->collection, study->left_out[p->index]));
}

static char *quoted_name(const gonio_i_study *study, const part *p)
{
    return gonio_i_format("fig5-%s-%s", gonio_i_quoted_method()->name,
                          gonio_i_name_of(&study->collection, study->quoted[p->index].material));
}

/* ---- how many ---- */

static size_t grid_count(const gonio_i_study *study)
{
    return study->grid_components;
}

static size_t chosen_count(const gonio_i_study *study)
{
    (void)study;
    return GONIO_I_CHOSEN;
}

static size_t left_out_count(const gonio_i_study *study)
{
    return study->left_out_count;
}

static size_t quoted_count(const gonio_i_study *study)
{
    return study->quoted_count;
}

/* ---- the table ---- */

static const kind kinds[KINDS] = {
    {GONIO_I_SPECTRUM, false, NULL, plain_name, spectrum_cost, compute_spectrum, NULL},
    {GONIO_I_CONVERGENCE, false, NULL, plain_name, shown_cost, compute_convergence, NULL},
    {GONIO_I_GRID, true, grid_count, grid_name, grid_cost, compute_grid, NULL},
    {GONIO_I_METHODS, true, gonio_i_methods, method_name, method_cost, compute_method,
     is_of_full_grid},
    {GONIO_I_DIRECTIONS, false, chosen_count, directions_name, shown_cost, compute_directions,
     NULL},
    {GONIO_I_LEFT_OUT, false, left_out_count, left_out_name, left_out_cost, compute_left_out, NULL},
    {GONIO_I_LEFT_OUT, false, quoted_count, quoted_name, quoted_cost, compute_quoted, is_always},
};

static size_t splits_of(const gonio_i_study *study, int k)
{
    return kinds[k].by_split ? study->splits.count : 1;
}

static size_t indices_of(const gonio_i_study *study, int k)
{
    return kinds[k].count != NULL ? kinds[k].count(study) : 1;
}

static size_t parts_of(const gonio_i_study *study, int k)
{
    return study->wanted[kinds[k].experiment] ? splits_of(study, k) * indices_of(study, k) : 0;
}

static gonio_status list_parts(gonio_context *context, plan_of_work *work)
{
    size_t count = 0;
    for (int k = 0; k < KINDS; k++) {
        count += parts_of(work->study, k);
    }
    work->part = gonio_i_allocate(context, count, sizeof *work->part);
    if (work->part == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (int k = 0; k < KINDS; k++) {
        const size_t indices = indices_of(work->study, k);
        for (size_t n = 0; n < parts_of(work->study, k); n++) {
            work->part[work->count++] = (part){k, n / indices, n % indices};
        }
    }
    return GONIO_OK;
}

/* ---- as work ---- */

static char *name_of(void *user, size_t piece)
{
    const plan_of_work *work = user;
    const part *p = &work->part[piece];
    return kinds[p->kind].name(work->study, p);
}

static double cost_of(void *user, size_t piece)
{
    const plan_of_work *work = user;
    const part *p = &work->part[piece];
    return kinds[p->kind].cost(work->study, p);
}

static bool is_one_at_a_time(void *user, size_t piece)
{
    const plan_of_work *work = user;
    const part *p = &work->part[piece];
    return kinds[p->kind].one_at_a_time != NULL && kinds[p->kind].one_at_a_time(work->study, p);
}

static gonio_status compute(void *user, gonio_context *context, size_t piece, json_t **result)
{
    const plan_of_work *work = user;
    const part *p = &work->part[piece];
    json_t *made = json_object();
    const gonio_status status = kinds[p->kind].compute(work->study, context, p, made);
    if (status != GONIO_OK) {
        json_decref(made);
        return status;
    }
    *result = made;
    return GONIO_OK;
}

/* ---- results ---- */

void gonio_i_results_free(gonio_i_results *results)
{
    json_decref(results->spectrum);
    json_decref(results->convergence);
    json_decref(results->grid);
    json_decref(results->methods);
    json_decref(results->directions);
    json_decref(results->left_out);
    json_decref(results->quoted);
    *results = (gonio_i_results){0};
}

/* [split][index] of one kind, from the flat list in the order of the parts; [index] where there are
 * no splits, and one result where there is one. */
static json_t *nest(const gonio_i_study *study, int k, json_t **flat)
{
    const size_t indices = indices_of(study, k);
    if (kinds[k].count == NULL) {
        return json_incref(flat[0]);
    }
    json_t *outer = json_array();
    for (size_t s = 0; s < splits_of(study, k); s++) {
        json_t *inner = kinds[k].by_split ? json_array() : json_incref(outer);
        for (size_t n = 0; n < indices; n++) {
            json_array_append(inner, flat[s * indices + n]);
        }
        if (kinds[k].by_split) {
            json_array_append(outer, inner);
        }
        json_decref(inner);
    }
    return outer;
}

static void sort_results(const gonio_i_study *study, json_t **flat, gonio_i_results *results)
{
    json_t **const place[KINDS] = {&results->spectrum, &results->convergence, &results->grid,
                                   &results->methods,  &results->directions,  &results->left_out,
                                   &results->quoted};
    for (int k = 0; k < KINDS; k++) {
        if (study->wanted[kinds[k].experiment]) {
            *place[k] = nest(study, k, flat);
            flat += parts_of(study, k);
        }
    }
}

gonio_status gonio_i_run_experiments(gonio_context *context, const gonio_i_study *study,
                                     const gonio_i_pieces *pieces, gonio_i_results *results)
{
    plan_of_work work = {.study = study};
    *results = (gonio_i_results){0};
    gonio_status status = list_parts(context, &work);
    json_t **flat = gonio_i_allocate(context, work.count, sizeof(json_t *));
    if (status == GONIO_OK && flat == NULL) {
        status = GONIO_ERROR_MEMORY;
    }
    if (status == GONIO_OK) {
        const gonio_i_work described = {.title = "reproducing",
                                        .count = work.count,
                                        .user = &work,
                                        .name = name_of,
                                        .cost = cost_of,
                                        .compute = compute,
                                        .one_at_a_time = is_one_at_a_time};
        status = gonio_i_pieces_run(context, pieces, &described, flat);
    }
    if (status == GONIO_OK) {
        sort_results(study, flat, results);
    }
    for (size_t k = 0; status == GONIO_OK && k < work.count; k++) {
        json_decref(flat[k]);
    }
    free(flat);
    free(work.part);
    return status;
}
