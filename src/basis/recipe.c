/* Learning from materials by a recipe: the default, the paper's, and variants. */
#include <gonio/basis.h>

#include "../core/options.h"

void gonio_recipe_default_of(gonio_recipe *recipe, size_t size)
{
    gonio_recipe_for_grid_of(recipe, size, GONIO_SECTORED);
}

void gonio_recipe_paper_of(gonio_recipe *recipe, size_t size)
{
    gonio_recipe_for_grid_of(recipe, size, GONIO_BIVARIATE);
}

void gonio_recipe_for_grid_of(gonio_recipe *recipe, size_t size,
                              gonio_representation representation)
{
    const gonio_recipe usual = {
        .representation = representation,
        .channels = representation == GONIO_SECTORED ? GONIO_SEPARATE : GONIO_JOINT,
        .mapping = GONIO_LOG,
        .mixtures = GONIO_USUAL_MIXTURES,
        .analytic = GONIO_USUAL_ANALYTIC,
    };
    gonio_i_give(&usual, sizeof usual, recipe, size);
}

gonio_status gonio_learn(gonio_context *context, const char *const *paths, size_t count,
                         const gonio_recipe *recipe, gonio_basis **basis)
{
    gonio_recipe how;
    gonio_status status = GONIO_I_TAKE(context, gonio_recipe, recipe, &how);
    if (status != GONIO_OK) {
        return status;
    }
    const gonio_database_options grid = {.size = sizeof grid,
                                         .representation = how.representation,
                                         .channels = how.channels,
                                         .mapping = how.mapping,
                                         .scratch = how.scratch};
    const gonio_basis_options options = {.size = sizeof options,
                                         .components = how.components,
                                         .without_mean = how.without_mean,
                                         .mixtures = how.mixtures,
                                         .analytic = how.analytic,
                                         .seed = how.seed};
    gonio_database *database = NULL;
    status = gonio_database_create(context, paths, count, &grid, &database);
    if (status == GONIO_OK) {
        status = gonio_basis_learn(context, database, &options, basis);
    }
    gonio_database_free(&database);
    return status;
}
