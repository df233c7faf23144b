/* What the steps of learning share. */
#ifndef GONIO_LEARNER_H
#define GONIO_LEARNER_H

#include "basis.h"
#include "mixtures.h"

typedef struct gonio_i_learner {
    gonio_context *context;
    const gonio_database *database;
    const gonio_database_view *view;
    const size_t *subset; /* of its materials; NULL for all */
    size_t materials;
    size_t columns;                   /* with mixtures and analytic ones */
    size_t measured;                  /* columns of the materials, which come first */
    const gonio_i_mixtures *mixtures; /* NULL without */
    size_t analytic;                  /* columns of random materials, which come last */
    float *random;                    /* [analytic][rows of the database], or NULL */
    gonio_i_column_weights weight;
    bool any_rank; /* fewer components than asked for are accepted */
    gonio_basis *basis;
    double *vectors; /* V before it is rounded */
    size_t tiles;
    size_t batches;
    size_t *finished; /* batches, over all passes */
} gonio_i_learner;

#endif
