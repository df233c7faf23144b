/* Databases and bases of a few built-in materials. */
#ifndef LEARNED_BASIS_H
#define LEARNED_BASIS_H

#include <math.h>

#include <gonio/gonio.h>

enum { MATERIALS = 6 };

static const char *const paths[MATERIALS] = {"atlas:gold-polished",   "atlas:red-glossy-plastic",
                                             "atlas:burgundy-velvet", "atlas:oak-sawn",
                                             "atlas:plaster-cast",    "atlas:steel-brushed"};

static inline void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

static inline gonio_database *make_database(gonio_context *context, size_t count,
                                            gonio_representation representation,
                                            gonio_channel_model channels)
{
    const gonio_database_options options = {
        .size = sizeof options, .representation = representation, .channels = channels};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(context, paths, count, &options, &database), GONIO_OK);
    return database;
}

static inline gonio_basis *learn(gonio_context *context, const gonio_database *database,
                                 size_t components)
{
    const gonio_basis_options options = {.size = sizeof options, .components = components};
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_basis_learn(context, database, &options, &basis), GONIO_OK);
    return basis;
}

#endif
