/* What folds hold, and what makes them: for learned_error.c, whose header has what others need. */
#ifndef GONIO_FOLDS_H
#define GONIO_FOLDS_H

#include "learned_error.h"

/* Parts of the database that are left out in turn. */
enum { GONIO_I_FOLDS = 10 };

/* The Gaussian of the columns that are not left out, at the readings. */
typedef struct gonio_i_fold {
    double *mean_seen;  /* [n] */
    double *mean;       /* [K] */
    double *covariance; /* [n][n], without noise */
    double *cross;      /* [n][K]: of the readings and z */
    /* Of the columns that it leaves out, in their order, with a = z - mean, M the metric and C the
     * cross covariance: a M a', a M C' and C M C'. NULL for the last fold, and where n > K, as more
     * work than they save. */
    double *square;       /* [left out] */
    double *mixed;        /* [left out][n] */
    double *cross_square; /* [n][n] */
} gonio_i_fold;

struct gonio_i_learned_error {
    const gonio_i_prior *prior;
    size_t components;
    size_t measured;     /* columns of materials */
    size_t each;         /* columns of a material */
    double *means;       /* [GONIO_I_FOLDS + 1][K]: of z in each fold; or NULL, if not prepared */
    double *covariances; /* [GONIO_I_FOLDS + 1][K][K]: the same */
    double *metric;      /* [K][K]: mean over the targets of f' f */
};

struct gonio_i_folds {
    const gonio_i_learned_error *of;
    const gonio_i_sites *sites;
    gonio_i_fold fold[GONIO_I_FOLDS + 1]; /* the last one leaves out nothing */
    double *noise;                        /* [measured][n]: of variance 1, the same every time */
};

/* The columns of materials that fold k leaves out; column: room for all of them. Returns how many.
 */
size_t gonio_i_folds_list(const gonio_i_learned_error *learned, size_t k, size_t *column);

/* The room for the columns that any fold leaves out. */
size_t gonio_i_folds_most(const gonio_i_learned_error *learned);

#endif
