/* Bases that trials share: see basis_cache.h. */
#include "basis_cache.h"

void gonio_i_shelf_clear(gonio_i_shelf *shelf)
{
    gonio_basis_free(&shelf->basis);
    gonio_database_free(&shelf->database);
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

/* Whether the basis on the shelf, which is of its matrix, was learned in that way. */
static bool is_basis(const gonio_i_shelf *shelf, const gonio_basis_options *options)
{
    if (shelf->basis == NULL) {
        return false;
    }
    const gonio_basis_view *view = gonio_basis_describe(shelf->basis);
    const uint64_t *fingerprints = gonio_database_describe(shelf->database)->fingerprints;
    bool same = view->components == options->components &&
                view->without_mean == options->without_mean &&
                view->materials == options->subset_count;
    for (size_t k = 0; k < options->subset_count && same; k++) {
        same = view->fingerprints[k] == fingerprints[options->subset[k]];
    }
    return same;
}

gonio_status gonio_i_shelf_learn(gonio_context *context, gonio_i_shelf *shelf,
                                 const char *const *paths, size_t count,
                                 const gonio_database_options *how,
                                 const gonio_basis_options *options, const gonio_basis **basis)
{
    gonio_status status = GONIO_OK;
    if (!is_matrix(shelf->database, how)) {
        gonio_i_shelf_clear(shelf);
        status = gonio_database_create(context, paths, count, how, &shelf->database);
    }
    if (status == GONIO_OK && !is_basis(shelf, options)) {
        gonio_basis_free(&shelf->basis);
        status = gonio_basis_learn(context, shelf->database, options, &shelf->basis);
    }
    if (status == GONIO_OK) {
        *basis = shelf->basis;
    }
    return status;
}
