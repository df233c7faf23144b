/* The paper's experiments as pieces of work: see experiments.h. */
#include "experiments.h"

#include <stdlib.h>
#include <string.h>

#include "methods.h"
#include "computations.h"
#include "kept_results.h"
#include "renderings.h"

typedef struct plan_of_work {
    const gonio_i_study *study;
    size_t count;
    gonio_i_piece *pieces; /* [count] */
} plan_of_work;

/* ---- costs, roughly in seconds ---- */

/* The cost of a plan, as measured for K = 5 .. 60 and L = 10 .. 200. */
static double plan_cost(size_t components, size_t samples)
{
    const double k = (double)components;
    return samples < components ? 0.0 : (double)samples * (0.0016 + 6e-5 * k + 1e-6 * k * k);
}

static double size_cost(gonio_i_size size)
{
    return plan_cost(size.components, size.samples);
}

static double spectrum_cost(const gonio_i_study *study, const gonio_i_piece *p)
{
    (void)p;
    return 0.05 * (double)(1 + study->splits.count);
}

static double shown_cost(const gonio_i_study *study, const gonio_i_piece *p)
{
    return 0.05 + GONIO_I_STARTS * size_cost(study->chosen[p->index]);
}

static double grid_cost(const gonio_i_study *study, const gonio_i_piece *p)
{
    const double tests = (double)study->splits.split[p->split].test_count;
    double cost = 0.1;
    for (size_t l = 0; l < study->grid_samples; l++) {
        cost += plan_cost(study->grid_component[p->index], study->grid_sample[l]) + 0.001 * tests;
    }
    return cost;
}

/* Methods of the full grid. Methods with the same basis have the same cost. So they follow each
 * other in each split, and the second finds the basis of the first in the cache. */
static const double JOINT_COST = 40.0;
static const double SEPARATE_COST = 15.0;

static bool is_of_full_grid(const gonio_i_study *study, const gonio_i_piece *p)
{
    (void)study;
    return gonio_i_method_at(p->index)->representation == GONIO_FULL;
}

static bool is_always(const gonio_i_study *study, const gonio_i_piece *p)
{
    (void)study;
    (void)p;
    return true;
}

static double quoted_cost(const gonio_i_study *study, const gonio_i_piece *p)
{
    (void)study;
    (void)p;
    return JOINT_COST;
}

/* A random choice costs nothing. */
static double method_cost(const gonio_i_study *study, const gonio_i_piece *p)
{
    const gonio_i_method_entry *method = gonio_i_method_at(p->index);
    if (is_of_full_grid(study, p)) {
        return method->channels == GONIO_JOINT ? JOINT_COST : SEPARATE_COST;
    }
    return strcmp(method->plan, "random") == 0
               ? 0.1
               : 0.1 + size_cost(gonio_i_method_size(study, method));
}

static double left_out_cost(const gonio_i_study *study, const gonio_i_piece *p)
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
    char *(*name)(const gonio_i_study *study, const gonio_i_piece *p);
    double (*cost)(const gonio_i_study *study, const gonio_i_piece *p);
    gonio_i_compute *compute;
    gonio_i_accept *accept; /* of its results that were kept */
    bool (*one_at_a_time)(const gonio_i_study *study, const gonio_i_piece *p); /* NULL for no */
} kind;

enum { KINDS = 9 };

static const kind kinds[KINDS];

/* ---- names ---- */

static char *plain_name(const gonio_i_study *study, const gonio_i_piece *p)
{
    (void)study;
    return strdup(gonio_experiment_name((int)kinds[p->kind].experiment));
}

static char *grid_name(const gonio_i_study *study, const gonio_i_piece *p)
{
    return gonio_i_format("fig3a-split-%02zu-basis-%zu", p->split + 1,
                          study->grid_component[p->index]);
}

static char *method_name(const gonio_i_study *study, const gonio_i_piece *p)
{
    (void)study;
    return gonio_i_format("fig3b-%s-split-%02zu", gonio_i_method_at(p->index)->name, p->split + 1);
}

static char *directions_name(const gonio_i_study *study, const gonio_i_piece *p)
{
    return gonio_i_format("fig4-samples-%zu", study->chosen[p->index].samples);
}

static char *left_out_name(const gonio_i_study *study, const gonio_i_piece *p)
{
    return gonio_i_format("fig5-%s",
                          gonio_i_name_of(&study->collection, study->left_out[p->index]));
}

static char *quoted_name(const gonio_i_study *study, const gonio_i_piece *p)
{
    return gonio_i_format("fig5-%s-%s", gonio_i_quoted_method()->name,
                          gonio_i_name_of(&study->collection, study->quoted[p->index].material));
}

/* ---- Fig. 6 and Fig. 7 ---- */

static double rendering_cost(const gonio_i_study *study, const gonio_i_piece *p)
{
    return gonio_i_rendering_cost(study, kinds[p->kind].experiment, p->index);
}

static char *rendering_name(const gonio_i_study *study, const gonio_i_piece *p)
{
    return gonio_i_rendering_name(study, kinds[p->kind].experiment, p->index);
}

static gonio_status compute_rendering(const gonio_i_study *study, gonio_context *context,
                                      const gonio_i_piece *p, json_t *result)
{
    return gonio_i_compute_rendering(study, context, kinds[p->kind].experiment, p->index, result);
}

static size_t rendered_count(const gonio_i_study *study)
{
    return gonio_i_renderings(study, GONIO_I_RENDERED);
}

static size_t lit_count(const gonio_i_study *study)
{
    return gonio_i_renderings(study, GONIO_I_LIT);
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
    {GONIO_I_SPECTRUM, false, NULL, plain_name, spectrum_cost, gonio_i_compute_spectrum,
     gonio_i_accept_spectrum, NULL},
    {GONIO_I_CONVERGENCE, false, NULL, plain_name, shown_cost, gonio_i_compute_convergence,
     gonio_i_accept_convergence, NULL},
    {GONIO_I_GRID, true, grid_count, grid_name, grid_cost, gonio_i_compute_grid,
     gonio_i_accept_grid, NULL},
    {GONIO_I_METHODS, true, gonio_i_methods, method_name, method_cost, gonio_i_compute_method,
     gonio_i_accept_method, is_of_full_grid},
    {GONIO_I_DIRECTIONS, false, chosen_count, directions_name, shown_cost,
     gonio_i_compute_directions, gonio_i_accept_directions, NULL},
    {GONIO_I_LEFT_OUT, false, left_out_count, left_out_name, left_out_cost,
     gonio_i_compute_left_out, gonio_i_accept_left_out, NULL},
    {GONIO_I_LEFT_OUT, false, quoted_count, quoted_name, quoted_cost, gonio_i_compute_quoted,
     gonio_i_accept_quoted, is_always},
    {GONIO_I_RENDERED, false, rendered_count, rendering_name, rendering_cost, compute_rendering,
     gonio_i_accept_rendering, is_always},
    {GONIO_I_LIT, false, lit_count, rendering_name, rendering_cost, compute_rendering,
     gonio_i_accept_rendering, is_always},
};

static size_t splits_of(const gonio_i_study *study, int k)
{
    return kinds[k].by_split ? study->splits.count : 1;
}

static size_t indices_of(const gonio_i_study *study, int k)
{
    return kinds[k].count != NULL ? kinds[k].count(study) : 1;
}

static size_t pieces_of(const gonio_i_study *study, int k)
{
    return study->wanted[kinds[k].experiment] ? splits_of(study, k) * indices_of(study, k) : 0;
}

static gonio_status list_pieces(gonio_context *context, plan_of_work *work)
{
    size_t count = 0;
    for (int k = 0; k < KINDS; k++) {
        count += pieces_of(work->study, k);
    }
    work->pieces = gonio_i_allocate(context, count, sizeof *work->pieces);
    if (work->pieces == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (int k = 0; k < KINDS; k++) {
        const size_t indices = indices_of(work->study, k);
        for (size_t n = 0; n < pieces_of(work->study, k); n++) {
            work->pieces[work->count++] = (gonio_i_piece){k, n / indices, n % indices};
        }
    }
    return GONIO_OK;
}

/* ---- as work ---- */

static char *name_of(void *user, size_t piece)
{
    const plan_of_work *work = user;
    const gonio_i_piece *p = &work->pieces[piece];
    return kinds[p->kind].name(work->study, p);
}

static double cost_of(void *user, size_t piece)
{
    const plan_of_work *work = user;
    const gonio_i_piece *p = &work->pieces[piece];
    return kinds[p->kind].cost(work->study, p);
}

static bool accept(void *user, size_t piece, const json_t *result, char *complaint)
{
    const plan_of_work *work = user;
    const gonio_i_piece *p = &work->pieces[piece];
    return kinds[p->kind].accept(work->study, p, result, complaint);
}

static bool is_one_at_a_time(void *user, size_t piece)
{
    const plan_of_work *work = user;
    const gonio_i_piece *p = &work->pieces[piece];
    return kinds[p->kind].one_at_a_time != NULL && kinds[p->kind].one_at_a_time(work->study, p);
}

static gonio_status compute(void *user, gonio_context *context, size_t piece, json_t **result)
{
    const plan_of_work *work = user;
    const gonio_i_piece *p = &work->pieces[piece];
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
    json_decref(results->rendered);
    json_decref(results->lit);
    *results = (gonio_i_results){0};
}

/* Nests the results of one kind, a flat list in the order of the pieces: [split][index]. Without
 * splits it is [index]; a single result is not in an array. */
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
                                   &results->quoted,   &results->rendered,    &results->lit};
    for (int k = 0; k < KINDS; k++) {
        if (study->wanted[kinds[k].experiment]) {
            *place[k] = nest(study, k, flat);
            flat += pieces_of(study, k);
        }
    }
}

gonio_status gonio_i_run_experiments(gonio_context *context, const gonio_i_study *study,
                                     const gonio_i_checkpoint *checkpoint, gonio_i_results *results)
{
    plan_of_work work = {.study = study};
    *results = (gonio_i_results){0};
    gonio_status status = list_pieces(context, &work);
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
                                        .accept = accept,
                                        .one_at_a_time = is_one_at_a_time};
        status = gonio_i_checkpoint_run(context, checkpoint, &described, flat);
    }
    if (status == GONIO_OK) {
        sort_results(study, flat, results);
    }
    for (size_t k = 0; status == GONIO_OK && k < work.count; k++) {
        json_decref(flat[k]);
    }
    free(flat);
    free(work.pieces);
    return status;
}
