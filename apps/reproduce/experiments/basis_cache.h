/* Bases of any kind, learned from some of many materials. Trials with different methods and splits
 * share them. */
#ifndef GONIO_REPRODUCE_BASIS_CACHE_H
#define GONIO_REPRODUCE_BASIS_CACHE_H

#include <gonio/basis.h>

/* The last matrix of all materials, and the last basis. */
typedef struct gonio_i_basis_cache {
    gonio_database *database;
    gonio_basis *basis;
} gonio_i_basis_cache;

/* A basis of the materials options->subset of those at `paths`, which are always the same for a
 * cache. It is learned from the cells with data in all materials, unless it is the last basis
 * again. It belongs to the cache and lasts until the next call. For one thread at a time. Errors:
 * those of gonio_database_create and gonio_basis_learn. */
gonio_status gonio_i_basis_cache_learn(gonio_context *context, gonio_i_basis_cache *cache,
                                       const char *const *paths, size_t count,
                                       const gonio_database_options *how,
                                       const gonio_basis_options *options,
                                       const gonio_basis **basis);
void gonio_i_basis_cache_clear(gonio_i_basis_cache *cache);

#endif
