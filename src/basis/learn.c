/* Learning a basis: what it is learned from, how many components and mixtures it gets. */
#include <stdlib.h>
#include <string.h>

#include <gonio/atlas.h>

#include "../core/options.h"
#include "../database/tiles.h"
#include "analytic.h"
#include "centred_tiles.h"
#include "principal_components.h"

void gonio_basis_options_default_of(gonio_basis_options *options, size_t size)
{
    const gonio_basis_options usual = {.mixtures = GONIO_USUAL_MIXTURES,
                                       .analytic = GONIO_USUAL_ANALYTIC};
    gonio_i_give(&usual, sizeof usual, options, size);
}

static gonio_status describe_origin(const gonio_i_learner *l)
{
    gonio_basis *basis = l->basis;
    basis->representation = l->view->representation;
    basis->mapping = l->view->mapping;
    memcpy(basis->cell, l->view->cell, basis->cells * sizeof *basis->cell);
    basis->program = gonio_i_format("gonio %s", gonio_version());
    bool done = basis->program != NULL;
    for (size_t k = 0; k < basis->materials; k++) {
        const size_t material = l->subset != NULL ? l->subset[k] : k;
        basis->fingerprints[k] = l->view->fingerprints[material];
        basis->names[k] = strdup(l->view->names[material]);
        done = done && basis->names[k] != NULL;
    }
    return done ? GONIO_OK : gonio_i_fail(l->context, GONIO_ERROR_MEMORY, "out of memory");
}

static gonio_status prepare_mixtures(gonio_i_learner *l, const gonio_basis_options *options,
                                     gonio_i_mixtures **mixtures)
{
    if (options->mixtures == 0) {
        return GONIO_OK;
    }
    const gonio_status status =
        gonio_i_mixtures_create(l->context, l->basis, l->database, options, mixtures);
    l->mixtures = *mixtures;
    if (status == GONIO_OK) {
        gonio_i_mixtures_parents(*mixtures, l->basis->parents);
    }
    return status;
}

static gonio_status learn(gonio_i_learner *l, const gonio_basis_options *options)
{
    gonio_i_mixtures *mixtures = NULL;
    gonio_status status = describe_origin(l);
    l->weight = gonio_i_weights_of_columns(l->measured, options->mixtures, l->analytic);
    if (status == GONIO_OK && (l->analytic > 0 || options->mixtures > 0)) {
        status = gonio_i_basis_map_cells(l->context, l->basis); /* both use rows of other cells */
    }
    if (status == GONIO_OK && l->analytic > 0) {
        status = gonio_i_analytic_columns(l->context, l->basis, l->database, options->analytic,
                                          &l->random);
    }
    if (status == GONIO_OK) {
        status = prepare_mixtures(l, options, &mixtures);
    }
    if (status == GONIO_OK) {
        status = gonio_i_find_components(l);
    }
    gonio_i_mixtures_free(&mixtures);
    free(l->random);
    return status;
}

/* The default number of mixtures, for bases that use mixtures. */
static size_t count_mixtures(const gonio_database_view *view, const gonio_basis_options *options)
{
    const bool usual = view->representation == GONIO_SECTORED && view->mapping == GONIO_LOG &&
                       view->channels == GONIO_SEPARATE && !options->without_mean;
    return options->mixtures != GONIO_USUAL_MIXTURES ? options->mixtures
           : usual                                   ? GONIO_DEFAULT_MIXTURES
                                                     : 0;
}

/* The default number of analytic materials: some beside the usual mixtures. `options` as given. */
static size_t count_analytic(const gonio_database_view *view, const gonio_basis_options *options)
{
    const bool usual =
        options->mixtures == GONIO_USUAL_MIXTURES && count_mixtures(view, options) > 0;
    return options->analytic != GONIO_USUAL_ANALYTIC ? options->analytic
           : usual                                   ? GONIO_DEFAULT_ANALYTIC
                                                     : 0;
}

static gonio_status check_analytic(gonio_context *context, const gonio_basis_options *options)
{
    if (options->analytic > GONIO_ATLAS_RANDOM_COUNT) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu analytic materials asked for, but there are %d", options->analytic,
                            GONIO_ATLAS_RANDOM_COUNT);
    }
    if (options->analytic > 0 && options->without_mean) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "analytic materials need a basis with a mean");
    }
    return GONIO_OK;
}

/* Whether mixtures are implemented for a kind of basis. */
static gonio_status check_mixtures(gonio_context *context, const gonio_database_view *view,
                                   const gonio_basis_options *options)
{
    if (options->mixtures > 0 && (view->representation == GONIO_FULL ||
                                  view->mapping != GONIO_LOG || options->without_mean)) {
        return gonio_i_fail(
            context, GONIO_ERROR_ARGUMENT,
            "mixtures need the log mapping with a mean, on the sectored or the bivariate grid");
    }
    return GONIO_OK;
}

static gonio_status check_subset(gonio_context *context, const gonio_database_view *view,
                                 const gonio_basis_options *options)
{
    for (size_t k = 0; options->subset != NULL && k < options->subset_count; k++) {
        if (options->subset[k] >= view->materials) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                "material %zu is outside a database of %zu", options->subset[k],
                                view->materials);
        }
    }
    return GONIO_OK;
}

/* K: the number that was asked for, or the default, limited by the columns. */
static gonio_status choose_components(gonio_context *context, size_t columns,
                                      const gonio_basis_options *options, size_t *components)
{
    const size_t asked = options->components;
    const size_t most = options->without_mean ? columns : columns - 1;
    if (columns < 2) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a basis needs at least 2 materials, not %zu", columns);
    }
    if (asked > most) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu components asked for, but %zu columns give at most %zu; add "
                            "materials or ask for fewer components",
                            asked, columns, most);
    }
    const size_t usual =
        options->mixtures > 0 ? GONIO_MIXTURE_COMPONENTS : GONIO_DEFAULT_COMPONENTS;
    const bool all = options->without_mean || most < usual;
    *components = asked > 0 ? asked : all ? most : usual;
    return GONIO_OK;
}

gonio_status gonio_i_basis_learn_exact(gonio_context *context, const gonio_database *database,
                                       const gonio_basis_options *options, gonio_basis **basis,
                                       double **vectors)
{
    gonio_basis_options how;
    gonio_status status = GONIO_I_TAKE(context, gonio_basis_options, options, &how);
    if (status != GONIO_OK) {
        return status;
    }
    options = &how;
    gonio_i_learner l = {.context = context, .database = database, .subset = options->subset};
    l.view = gonio_database_describe(database);
    how.analytic = count_analytic(l.view, &how);
    how.mixtures = count_mixtures(l.view, &how);
    l.materials = l.subset != NULL ? options->subset_count : l.view->materials;
    l.measured = l.view->columns / l.view->materials * l.materials;
    l.analytic = l.view->columns / l.view->materials * options->analytic;
    l.columns = l.measured + options->mixtures + l.analytic;
    l.any_rank = options->mixtures > 0 && options->components == 0;
    size_t components = 0;
    status = check_mixtures(context, l.view, options);
    if (status == GONIO_OK) {
        status = check_analytic(context, options);
    }
    if (status == GONIO_OK) {
        status = check_subset(context, l.view, options);
    }
    if (status == GONIO_OK) {
        status = choose_components(context, l.columns, options, &components);
    }
    if (status != GONIO_OK) {
        return status;
    }
    l.tiles = gonio_i_database_tiles(database);
    l.batches = gonio_i_tile_batches(l.tiles);
    size_t finished = 0;
    l.finished = &finished;
    l.basis = gonio_i_basis_allocate(context, l.materials, options->mixtures, l.analytic,
                                     l.view->cells, l.view->channels, components,
                                     options->without_mean ? l.columns : l.columns - 1);
    if (l.basis == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    l.vectors = gonio_i_allocate(context, l.basis->rows * components, sizeof *l.vectors);
    if (l.vectors == NULL) {
        gonio_basis_free(&l.basis);
        return GONIO_ERROR_MEMORY;
    }
    l.basis->without_mean = options->without_mean;
    l.context = gonio_i_shared_context_begin(context);
    status = learn(&l, options);
    gonio_i_shared_context_end(l.context, context);
    if (status != GONIO_OK) {
        free(l.vectors);
        gonio_basis_free(&l.basis);
        return status;
    }
    *basis = l.basis;
    *vectors = l.vectors;
    return GONIO_OK;
}

gonio_status gonio_basis_learn(gonio_context *context, const gonio_database *database,
                               const gonio_basis_options *options, gonio_basis **basis)
{
    gonio_basis *made = NULL;
    double *vectors = NULL;
    gonio_status status = gonio_i_basis_learn_exact(context, database, options, &made, &vectors);
    if (status != GONIO_OK) {
        return status;
    }
    status = gonio_i_basis_keep_vectors(context, made, vectors);
    if (status == GONIO_OK) {
        status = gonio_i_basis_finish(context, made);
    }
    if (status != GONIO_OK) {
        gonio_basis_free(&made);
        return status;
    }
    *basis = made;
    return GONIO_OK;
}
