/* The setup of the experiments: see setup.h. */
#include "setup.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[GONIO_I_EXPERIMENTS] = {"fig2a", "fig2b", "fig3a", "fig3b",
                                                       "fig4",  "fig5",  "fig6",  "fig7"};

const gonio_i_size gonio_i_paper_sizes[GONIO_I_CHOSEN] = {{35, 80}, {40, 120}, {45, 170}};

const gonio_i_quoted gonio_i_quoted_materials[GONIO_I_QUOTED] = {{"dark-red-paint", 4.5, 2.6},
                                                                 {"gold-paint", 3.2, 2.9},
                                                                 {"alum-bronze", 5.7, 5.2},
                                                                 {"red-plastic", 4.9, 4.5}};

enum { SPLITS = 10, STEP_COMPONENTS = 5, STEP_SAMPLES = 10 };

const char *gonio_experiment_name(int index)
{
    return index >= 0 && index < GONIO_I_EXPERIMENTS ? names[index] : NULL;
}

void gonio_reproduce_options_default(gonio_reproduce_options *options)
{
    *options = (gonio_reproduce_options){0};
}

/* ---- which experiments ---- */

/* Whether this library can run an experiment: pictures need the renderer. */
static bool can_run(int experiment)
{
#ifdef GONIO_WITHOUT_RENDER
    return experiment != GONIO_I_RENDERED && experiment != GONIO_I_LIT;
#else
    (void)experiment;
    return true;
#endif
}

static int find_experiment(const char *name, size_t length)
{
    for (int k = 0; k < GONIO_I_EXPERIMENTS; k++) {
        if (strlen(names[k]) == length && strncmp(names[k], name, length) == 0) {
            return k;
        }
    }
    return -1;
}

static gonio_status choose_experiments(gonio_context *context, const char *only,
                                       gonio_i_study *study)
{
    for (int k = 0; k < GONIO_I_EXPERIMENTS; k++) {
        study->wanted[k] = only == NULL && can_run(k);
    }
    while (only != NULL) {
        const size_t length = strcspn(only, ",");
        const int experiment = find_experiment(only, length);
        if (experiment < 0) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                "no experiment is called '%.*s': there are fig2a, fig2b, fig3a, "
                                "fig3b, fig4, fig5, fig6, fig7",
                                (int)length, only);
        }
        if (!can_run(experiment)) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                "%s needs the renderer, but this gonio was built without it",
                                names[experiment]);
        }
        study->wanted[experiment] = true;
        only = only[length] == ',' ? only + length + 1 : NULL;
    }
    return GONIO_OK;
}

/* ---- sizes ---- */

/* The most components that every basis has: of every split, and of all materials but one. */
static size_t most_components(const gonio_i_study *study)
{
    size_t least = study->collection.count - 1;
    for (size_t s = 0; s < study->splits.count; s++) {
        const size_t basis = study->splits.split[s].basis_count;
        least = basis < least ? basis : least;
    }
    return least - 1;
}

static void choose_grid(gonio_i_study *study, size_t most)
{
    static const size_t quick_components[] = {20, 35, 40, 45};
    static const size_t quick_samples[] = {20, 40, 80, 120, 170, 200};
    const size_t components = study->quick ? sizeof quick_components / sizeof(size_t) : 12;
    study->grid_samples = study->quick ? sizeof quick_samples / sizeof(size_t) : 20;
    for (size_t k = 0; k < components; k++) {
        const size_t size = study->quick ? quick_components[k] : STEP_COMPONENTS * (k + 1);
        if (size <= most) {
            study->grid_component[study->grid_components++] = size;
        }
    }
    if (study->grid_components < 2) { /* a map needs two lines */
        study->grid_component[0] = most / 2;
        study->grid_component[1] = most;
        study->grid_components = 2;
    }
    for (size_t k = 0; k < study->grid_samples; k++) {
        study->grid_sample[k] = study->quick ? quick_samples[k] : STEP_SAMPLES * (k + 1);
    }
}

static void choose_sizes(gonio_i_study *study)
{
    const size_t most = most_components(study);
    for (size_t k = 0; k < GONIO_I_CHOSEN; k++) {
        study->chosen[k] = gonio_i_paper_sizes[k];
        if (study->chosen[k].components > most) {
            study->chosen[k].components = most;
            study->cut = true;
        }
    }
    choose_grid(study, most);
}

/* The index of the paper's quote on a material; -1 if there is none. */
static int find_quote(const char *name)
{
    for (int q = 0; q < GONIO_I_QUOTED; q++) {
        if (strcmp(name, gonio_i_quoted_materials[q].material) == 0) {
            return q;
        }
    }
    return -1;
}

/* Chooses the left-out materials: all, or in a quick run some evenly spaced ones and those that the
 * paper quotes. */
static gonio_status choose_left_out(gonio_context *context, gonio_i_study *study)
{
    const size_t count = study->collection.count;
    const size_t step = study->quick && count > GONIO_I_QUICK_LEFT_OUT
                            ? (count + GONIO_I_QUICK_LEFT_OUT - 1) / GONIO_I_QUICK_LEFT_OUT
                            : 1;
    study->left_out = gonio_i_allocate(context, count, sizeof *study->left_out);
    if (study->left_out == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t m = 0; m < count; m++) {
        const int quote = find_quote(gonio_i_name_of(&study->collection, m));
        if (quote >= 0 && !study->quick) {
            study->quoted[study->quoted_count].material = m;
            study->quoted[study->quoted_count].left_out = study->left_out_count;
            study->quoted[study->quoted_count++].quote = quote;
        }
        if (m % step == 0 || quote >= 0) {
            study->left_out[study->left_out_count++] = m;
        }
    }
    return GONIO_OK;
}

/* ---- the study ---- */

static gonio_status choose_splits(gonio_context *context, const gonio_reproduce_options *options,
                                  gonio_i_study *study)
{
    const size_t count = options->quick ? GONIO_I_QUICK_SPLITS : SPLITS;
    if (options->splits == NULL) {
        return gonio_i_splits_make(context, &study->collection, count, options->seed,
                                   &study->splits);
    }
    const gonio_status status =
        gonio_i_splits_read(context, &study->collection, options->splits, &study->splits);
    while (options->quick && study->splits.count > GONIO_I_QUICK_SPLITS) {
        const gonio_i_split *last = &study->splits.split[--study->splits.count];
        free(last->basis);
        free(last->test);
    }
    return status;
}

gonio_status gonio_i_study_create(gonio_context *context, const char *const *paths, size_t count,
                                  const gonio_reproduce_options *options, gonio_i_study *study)
{
    *study = (gonio_i_study){.seed = options->seed, .quick = options->quick};
    gonio_status status = choose_experiments(context, options->only, study);
    if (status == GONIO_OK) {
        status = gonio_i_collect(context, paths, count, options->skip_bad, &study->collection);
    }
    if (status == GONIO_OK) {
        status = choose_splits(context, options, study);
    }
    if (status == GONIO_OK) {
        choose_sizes(study);
        status = choose_left_out(context, study);
    }
    return status;
}

void gonio_i_study_free(gonio_i_study *study)
{
    gonio_i_splits_free(&study->splits);
    gonio_i_collection_free(&study->collection);
    free(study->left_out);
    *study = (gonio_i_study){0};
}

static json_t *sizes(const size_t *size, size_t count)
{
    json_t *list = json_array();
    for (size_t k = 0; k < count; k++) {
        json_array_append_new(list, json_integer((json_int_t)size[k]));
    }
    return list;
}

/* Experiments that --only leaves out belong to the run, so that they can be added later. */
json_t *gonio_i_study_identity(const gonio_i_study *study)
{
    json_t *materials = json_object();
    for (size_t m = 0; m < study->collection.count; m++) {
        char fingerprint[17];
        snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64,
                 study->collection.digest[m]->fingerprint);
        json_object_set_new(materials, gonio_i_name_of(&study->collection, m),
                            json_string(fingerprint));
    }
    return json_pack("{s:s, s:o, s:o, s:I, s:b, s:o, s:o}", "build", GONIO_FINGERPRINT, "materials",
                     materials, "splits", gonio_i_splits_json(&study->collection, &study->splits),
                     "seed", (json_int_t)study->seed, "quick", study->quick, "components",
                     sizes(study->grid_component, study->grid_components), "samples",
                     sizes(study->grid_sample, study->grid_samples));
}
