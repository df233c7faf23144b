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
    const gonio_database_options how = {.representation = representation, .channels = channels};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(NULL, made_paths, MADE_MATERIALS, &how, &database),
                     GONIO_OK);
    return database;
}

/* On any number of threads; all components that there are. */
static inline gonio_basis *made_basis(gonio_context *context, gonio_representation representation,
                                      gonio_channel_model channels, uint64_t seed)
{
    const gonio_basis_options options = {.mixtures = MADE_MIXTURES, .seed = seed};
    gonio_database *database = made_database(representation, channels);
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_basis_learn(context, database, &options, &basis), GONIO_OK);
    gonio_database_free(&database);
    return basis;
}

#endif
