/* Where a material was read, and what the prior knows of it before any value.
 *
 * All that depends on directions alone is here, so that it is made once and shared: by channels and
 * wavelengths that were read at the same directions, and by every model, dark level and mistake
 * that is tried on them. Sites do not change once they are made; any number of threads may use
 * them. */
#ifndef GONIO_SITES_H
#define GONIO_SITES_H

#include "posterior.h"

typedef struct gonio_i_sites {
    const gonio_i_prior *prior;
    size_t n;             /* directions */
    size_t components;    /* K */
    double *f;            /* [n][K]: F */
    gonio_i_place *place; /* [n] */
    double *mean;         /* [n]: m */
    double *seen;         /* [samples][n]: F z_j */
    double *gram;         /* [n][n]: F F' */
    double *smooth;       /* [n][n]: the first parts of k */
    double *peaked;       /* [n][n] */
    double *back;         /* [n][n]: the third part; NULL if no direction is near the light */
} gonio_i_sites;

/* The sites of a column's observations, whose values do not matter. The prior must outlive them.
 * Errors: _MEMORY. */
gonio_status gonio_i_sites_create(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_i_column *column, gonio_i_sites **sites);
void gonio_i_sites_free(gonio_i_sites **sites);

/* Numbers that a column's field over the sites is made of (fields.h). */
static inline size_t gonio_i_terms(const gonio_i_sites *sites)
{
    return sites->components + (sites->back != NULL ? 3 : 2) * sites->n;
}

/* Whether two columns were read at the same directions in the same order, so that sites of one are
 * those of the other. */
bool gonio_i_sites_are_same(const gonio_i_prior *prior, const gonio_i_column *a,
                            const gonio_i_column *b);

/* The sites of a few columns, sites[count]: columns that were read at the same directions share
 * one. To be released in any case. Errors: _MEMORY. */
gonio_status gonio_i_sites_share(gonio_context *context, const gonio_i_prior *prior,
                                 const gonio_i_column *columns, size_t count,
                                 gonio_i_sites **sites);
void gonio_i_sites_release(gonio_i_sites **sites, size_t count);

/* Numbers columns by their directions: columns that can share sites have the same number,
 * group[count], counted from 0 in the order in which they are met. Returns how many groups. */
size_t gonio_i_sites_group(const gonio_i_prior *prior, const gonio_i_column *columns, size_t count,
                           size_t *group);

#endif
