/* A small basis with mixtures, of three built-in materials, for the tests. */
#ifndef MADE_BASIS_H
#define MADE_BASIS_H

#include <gonio/gonio.h>

enum { MADE_MATERIALS = 3, MADE_MIXTURES = 20 };

static const char *const made_paths[MADE_MATERIALS] = {
    "atlas:gold-polished", "atlas:red-glossy-plastic", "atlas:burgundy-velvet"};

static inline gonio_database *made_database(gonio_representation representation,
                                            gonio_channel_model channels)
{
    const gonio_database_options how = {
        .size = sizeof how, .representation = representation, .channels = channels};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(NULL, made_paths, MADE_MATERIALS, &how, &database),
                     GONIO_OK);
    return database;
}

/* On any number of threads; all components that there are. */
static inline gonio_basis *made_basis(gonio_context *context, gonio_representation representation,
                                      gonio_channel_model channels, uint64_t seed)
{
    gonio_recipe recipe;
    gonio_basis *basis = NULL;
    gonio_recipe_for_grid(&recipe, representation);
    recipe.channels = channels;
    recipe.mixtures = MADE_MIXTURES;
    recipe.seed = seed;
    assert_int_equal(gonio_learn(context, made_paths, MADE_MATERIALS, &recipe, &basis), GONIO_OK);
    return basis;
}

#endif
