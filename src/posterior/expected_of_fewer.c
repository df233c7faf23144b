/* The error to expect of columns of many readings: see expected_of_fewer.h. */
#include "expected_of_fewer.h"

#include <stdlib.h>

#include "merge.h"

/* Columns that were merged to fewer readings. Those over the same sites are a group. */
typedef struct fewer {
    gonio_i_finding all;
    size_t groups;
    size_t *number; /* [all.count]: of each column's group */
} fewer;

/* A group at work. */
typedef struct group {
    const fewer *of;
    size_t number;
    gonio_i_sites *sites;
    gonio_i_folds *folds;
} group;

static gonio_status expect_column(void *data, gonio_context *context, size_t k)
{
    const group *g = data;
    const gonio_i_finding *all = &g->of->all;
    double outlying = 0.0;
    gonio_i_fit e = {0};
    if (g->of->number[k] != g->number || !gonio_i_is_fitted(all->neighbours, k)) {
        return GONIO_OK;
    }
    gonio_status status = gonio_i_column_begin(all, context, g->sites, k, &e);
    if (status == GONIO_OK) {
        status = gonio_i_column_settle(all, &e, &outlying);
    }
    if (status == GONIO_OK) {
        status = gonio_i_learned_error_find(g->folds, &e, &all->found[k].expected);
    }
    gonio_i_fit_end(&e);
    return status;
}

static size_t first_of(const fewer *f, size_t number)
{
    size_t k = 0;
    while (f->number[k] != number) {
        k++;
    }
    return k;
}

static gonio_status expect_group(void *data, gonio_context *context, size_t number)
{
    const fewer *f = data;
    const gonio_i_finding *all = &f->all;
    gonio_i_steps steps = {.task = NULL};
    group g = {.of = f, .number = number};
    const gonio_i_column *column = &all->column[first_of(f, number)];
    if (column->count == 0) {
        return GONIO_OK; /* not one of many readings */
    }
    gonio_status status = gonio_i_sites_create(context, all->prior, column, &g.sites);
    if (status == GONIO_OK) {
        status = gonio_i_folds_create(context, all->learned, g.sites, &g.folds);
    }
    if (status == GONIO_OK) {
        status = gonio_i_parallel_for(context, &steps, all->count, expect_column, &g);
    }
    gonio_i_folds_free(&g.folds);
    gonio_i_sites_free(&g.sites);
    return status;
}

static void follow_expected(const gonio_i_finding *all)
{
    for (size_t k = 0; k < all->count; k++) {
        const gonio_i_neighbours *n = &all->neighbours[k];
        all->found[k].expected = n->weight[0] * all->found[n->fit[0]].expected +
                                 n->weight[1] * all->found[n->fit[1]].expected;
    }
}

/* Sites are often not the same: merged readings lie where the bounds among them leave them. */
static gonio_status expect_all(fewer *f)
{
    gonio_i_finding *all = &f->all;
    gonio_i_steps steps = {.task = NULL};
    f->groups = gonio_i_sites_group(all->prior, all->column, all->count, f->number);
    gonio_status status = GONIO_OK;
    if (all->plain) {
        status = gonio_i_learned_error_prepare(all->context, all->learned);
    }
    if (status == GONIO_OK) {
        status = gonio_i_parallel_for(all->context, &steps, f->groups, expect_group, f);
    }
    if (status == GONIO_OK) {
        follow_expected(all);
    }
    return status;
}

gonio_status gonio_i_expect_of_fewer(gonio_i_finding *all, const gonio_i_column *columns)
{
    fewer f = {.all = *all};
    bool any = false;
    f.number = gonio_i_allocate(all->context, all->count, sizeof *f.number);
    f.all.column = gonio_i_allocate(all->context, all->count, sizeof *f.all.column);
    gonio_status status = f.number == NULL || f.all.column == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t k = 0; k < all->count && status == GONIO_OK; k++) {
        if (all->column[k].count > GONIO_I_LEARNED_ERROR_MOST) {
            any = true;
            status = gonio_i_merge(all->context, &columns[k], GONIO_I_LEARNED_ERROR_MOST,
                                   &f.all.column[k]);
        }
    }
    if (status == GONIO_OK && any) {
        status = expect_all(&f);
    }
    for (size_t k = 0; f.all.column != NULL && k < all->count; k++) {
        free(f.all.column[k].observation);
    }
    free(f.all.column);
    free(f.number);
    return status;
}
