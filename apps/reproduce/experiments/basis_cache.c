/* Bases that trials share: see basis_cache.h. */
#include "basis_cache.h"

void gonio_i_basis_cache_clear(gonio_i_basis_cache *cache)
{
    gonio_basis_free(&cache->basis);
    gonio_database_free(&cache->database);
}

static bool is_matrix(const gonio_database *database, const gonio_database_options *how)
{
    if (database == NULL) {
        return false;
    }
    const gonio_database_view *view = gonio_database_describe(database);
    return view->representation == how->representation && view->channels == how->channels &&
           view->mapping == how->mapping;
}

/* Whether the basis in the cache was learned with these options. */
static bool is_basis(const gonio_i_basis_cache *cache, const gonio_basis_options *options)
{
    if (cache->basis == NULL) {
        return false;
    }
    const gonio_basis_view *view = gonio_basis_describe(cache->basis);
    const uint64_t *fingerprints = gonio_database_describe(cache->database)->fingerprints;
    bool same = view->components == options->components &&
                view->without_mean == options->without_mean &&
                view->materials == options->subset_count;
    for (size_t k = 0; k < options->subset_count && same; k++) {
        same = view->fingerprints[k] == fingerprints[options->subset[k]];
    }
    return same;
}

gonio_status gonio_i_basis_cache_learn(gonio_context *context, gonio_i_basis_cache *cache,
                                       const char *const *paths, size_t count,
                                       const gonio_database_options *how,
                                       const gonio_basis_options *options,
                                       const gonio_basis **basis)
{
    gonio_status status = GONIO_OK;
    if (!is_matrix(cache->database, how)) {
        gonio_i_basis_cache_clear(cache);
        status = gonio_database_create(context, paths, count, how, &cache->database);
    }
    if (status == GONIO_OK && !is_basis(cache, options)) {
        gonio_basis_free(&cache->basis);
        status = gonio_basis_learn(context, cache->database, options, &cache->basis);
    }
    if (status == GONIO_OK) {
        *basis = cache->basis;
    }
    return status;
}
