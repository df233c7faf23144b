/* Learning from materials by a recipe: the default one, the paper's and variants of them. */
#include <gonio/basis.h>

#include <string.h>

#include "../core/core.h"

void gonio_recipe_default(gonio_recipe *recipe)
{
    gonio_recipe_for_grid(recipe, GONIO_SECTORED);
}

void gonio_recipe_paper(gonio_recipe *recipe)
{
    gonio_recipe_for_grid(recipe, GONIO_BIVARIATE);
}

void gonio_recipe_for_grid(gonio_recipe *recipe, gonio_representation representation)
{
    *recipe = (gonio_recipe){
        .size = sizeof *recipe,
        .representation = representation,
        .channels = representation == GONIO_SECTORED ? GONIO_SEPARATE : GONIO_JOINT,
        .mapping = GONIO_LOG,
        .mixtures = GONIO_USUAL_MIXTURES,
    };
}

/* The recipe with the default of what a caller of an older build does not know of. */
static gonio_recipe complete(const gonio_recipe *given)
{
    gonio_recipe recipe;
    gonio_recipe_default(&recipe);
    if (given != NULL) {
        memcpy(&recipe, given, given->size < sizeof recipe ? given->size : sizeof recipe);
    }
    return recipe;
}

gonio_status gonio_learn(gonio_context *context, const char *const *paths, size_t count,
                         const gonio_recipe *recipe, gonio_basis **basis)
{
    if (recipe != NULL && recipe->size < sizeof recipe->size) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a recipe begins with gonio_recipe_default or another of its kind");
    }
    const gonio_recipe how = complete(recipe);
    const gonio_database_options grid = {.representation = how.representation,
                                         .channels = how.channels,
                                         .mapping = how.mapping,
                                         .scratch = how.scratch};
    const gonio_basis_options options = {.components = how.components,
                                         .without_mean = how.without_mean,
                                         .mixtures = how.mixtures,
                                         .seed = how.seed};
    gonio_database *database = NULL;
    gonio_status status = gonio_database_create(context, paths, count, &grid, &database);
    if (status == GONIO_OK) {
        status = gonio_basis_learn(context, database, &options, basis);
    }
    gonio_database_free(&database);
    return status;
}
