/* The materials that experiments run on: read once, kept as digests and as a database. */
#ifndef GONIO_REPRODUCE_COLLECTION_H
#define GONIO_REPRODUCE_COLLECTION_H

#include "core/core.h"
#include "evaluate/digest.h"
#include "basis_cache.h"

typedef struct gonio_i_collection {
    size_t count;
    char **path;
    gonio_i_digest **digest;
    double **mean;              /* gonio_i_digest_mean of each: the values of bivariate readings */
    gonio_database *database;   /* bivariate, joint; in the same order */
    gonio_i_basis_cache *cache; /* other matrices and bases, made when they are needed */
} gonio_i_collection;

/* Reads materials, several at a time. Materials are refused if they cannot be read, have no data,
 * or have the name or the values of an earlier one. The message names all of them. With `skip_bad`
 * they are left out with a warning. Errors: _DATA; those of gonio_database_create; _CANCELLED;
 * _MEMORY. The collection is to be freed in any case. */
gonio_status gonio_i_collect(gonio_context *context, const char *const *paths, size_t count,
                             bool skip_bad, gonio_i_collection *collection);
void gonio_i_collection_free(gonio_i_collection *collection);

static inline const char *gonio_i_name_of(const gonio_i_collection *c, size_t material)
{
    return c->digest[material]->name;
}

/* The index of a name; `count` if there is none. */
size_t gonio_i_find_material(const gonio_i_collection *collection, const char *name);

#endif
