/* The bases that a lesson teaches: see bases.h. */
#include "bases.h"

#include "core/core.h"

static bool same_kind(const gonio_plan_basis *a, const gonio_plan_basis *b)
{
    return a->representation == b->representation && a->channels == b->channels &&
           a->mapping == b->mapping && a->without_mean == b->without_mean &&
           a->mixtures == b->mixtures;
}

/* Reads a basis file, which must be of the kind that a planning method is meant for. */
static gonio_status check_kind(gonio_context *context, const char *path, const gonio_basis *basis,
                               const char *method)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const gonio_plan_basis is = {view->representation, view->channels, view->mapping,
                                 view->without_mean, view->mixtures > 0};
    return same_kind(&is, gonio_plan_method_basis(method))
               ? GONIO_OK
               : gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                              "%s: %s needs another kind of basis: give --learn a folder of "
                              "materials",
                              path, method);
}

gonio_status benchmark_check_basis(gonio_context *context, const char *path,
                                   const char *const *method, size_t count)
{
    gonio_basis *basis = NULL;
    gonio_status status = gonio_basis_read(context, path, &basis);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = check_kind(context, path, basis, method[k]);
    }
    gonio_basis_free(&basis);
    return status;
}

static gonio_status read_basis(gonio_context *context, const char *path, const char *method,
                               gonio_basis **basis)
{
    gonio_status status = gonio_basis_read(context, path, basis);
    if (status == GONIO_OK) {
        status = check_kind(context, path, *basis, method);
    }
    if (status != GONIO_OK) {
        gonio_basis_free(basis);
    }
    return status;
}

void benchmark_bases_free(benchmark_bases *bases)
{
    for (size_t k = 0; k < bases->count; k++) {
        gonio_basis_free(&bases->basis[k]);
    }
    bases->count = 0;
}

static gonio_status learn(gonio_context *context, const benchmark_bases *bases,
                          const gonio_plan_basis *kind, gonio_basis **basis)
{
    const benchmark_lesson *lesson = bases->lesson;
    gonio_recipe recipe;
    gonio_recipe_for_grid(&recipe, kind->representation);
    recipe.channels = kind->channels;
    recipe.mapping = kind->mapping;
    recipe.without_mean = kind->without_mean;
    if (!kind->mixtures) {
        const size_t columns = lesson->count * (kind->channels == GONIO_SEPARATE ? 3 : 1);
        const size_t wanted = kind->representation == GONIO_FULL ? bases->most : 45;
        recipe.mixtures = 0;
        recipe.components = kind->without_mean ? 0 : wanted < columns ? wanted : columns - 1;
    }
    return gonio_learn(context, lesson->path, lesson->count, &recipe, basis);
}

static gonio_status find_or_make(gonio_context *context, benchmark_bases *bases, const char *method,
                                 const gonio_basis **basis)
{
    const gonio_plan_basis *kind = gonio_plan_method_basis(method);
    for (size_t k = 0; k < bases->count; k++) {
        if (same_kind(&bases->kind[k], kind)) {
            *basis = bases->basis[k];
            return GONIO_OK;
        }
    }
    gonio_basis *made = NULL;
    const gonio_status status = bases->lesson->basis != NULL
                                    ? read_basis(context, bases->lesson->basis, method, &made)
                                    : learn(context, bases, kind, &made);
    if (status == GONIO_OK) {
        bases->basis[bases->count] = made;
        bases->kind[bases->count++] = *kind;
        *basis = made;
    }
    return status;
}

gonio_status benchmark_basis(gonio_context *context, benchmark_bases *bases, const char *method,
                             const gonio_basis **basis)
{
    gonio_status status = GONIO_OK;
#pragma omp critical(benchmark_bases)
    status = find_or_make(context, bases, method, basis);
    return status;
}
