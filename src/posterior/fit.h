/* The readings of one column as a Gaussian problem: see posterior.h for the symbols. */
#ifndef GONIO_FIT_H
#define GONIO_FIT_H

#include "posterior.h"

/* What the readings choose of the model; see posterior.h. */
typedef struct gonio_i_model {
    double h;     /* how much of the database's covariance each column keeps; 1 without samples */
    double alpha; /* of the remainder, log units */
    double peak;  /* of the remainder */
} gonio_i_model;

/* An h that does well when nothing is known of it. */
static const double GONIO_I_KERNEL_WIDTH = 0.7;

typedef struct gonio_i_fit {
    gonio_context *context;
    const gonio_i_prior *prior;
    size_t n;
    size_t components;
    double *f;            /* [n][K] */
    gonio_i_place *place; /* [n] */
    double *mean;         /* [n]: m */
    double *y;            /* [n]: g - m */
    double *variance;     /* [n]: D */
    int *bound;           /* [n] */
    bool *left_out;       /* [n]: a bound that is kept anyway, which says nothing */
    double *seen;         /* [samples][n]: F z_j */
    double *gram;         /* [n][n]: F F' */
    double *smooth;       /* [n][n]: the parts of k */
    double *peaked;       /* [n][n] */
    gonio_i_model model;
    double *lower;   /* [n][n]: L of S */
    double *white;   /* [samples][n]: L^-1 (y - a F z_j) */
    double *weight;  /* [samples]: q */
    double *centre;  /* [K]: z */
    double *rest;    /* [n]: y - F z */
    double *solved;  /* [n]: S^-1 rest */
    double evidence; /* ln p(y) */
    double misfit;   /* what the variances are multiplied by, see below */
} gonio_i_fit;

/* h of a mixture for a column of n readings: (n/(n + 5))^(1/2). The more there are, the less it
 * helps to stay near single columns of the database: a plain Gaussian is worse by 15 % at five
 * readings of the neural MERL materials and better by 3 % at forty. */
double gonio_i_kernel_width(size_t n);

/* Fills in everything up to `peaked`. To be freed in any case. Errors: _MEMORY. */
gonio_status gonio_i_fit_begin(gonio_context *context, const gonio_i_prior *prior,
                               const gonio_i_column *column, gonio_i_fit *gaussian);
void gonio_i_fit_end(gonio_i_fit *gaussian);

/* The rest, for a model. Errors: _NUMERICAL, _MEMORY. */
gonio_status gonio_i_fit_solve(gonio_i_fit *gaussian, const gonio_i_model *model);

/* The variance that a reading counts with: so large that it has no say if it is left out. */
double gonio_i_fit_noise(const gonio_i_fit *gaussian, size_t reading);

/* What the other readings say of each one: the difference to it, and its variance (noise
 * included), difference[n], variance[n]. Exactly, samples weighted by the other readings only. */
gonio_status gonio_i_fit_leave_one_out(const gonio_i_fit *gaussian, double *difference,
                                       double *variance);

/* Takes out bounds that hold anyway and, if there is doubt, gives readings that the others
 * contradict a variance to match, until nothing changes. outlying: how many of the latter. */
gonio_status gonio_i_fit_settle(gonio_i_fit *gaussian, bool doubt, size_t *outlying);

/* Sum over the readings of (reading - what the others say)^2 / its variance; and sets misfit to its
 * mean, held towards 1 by `PRIOR_READINGS` readings that are as expected: a material that surprises
 * where it was read will elsewhere. */
gonio_status gonio_i_fit_surprise(gonio_i_fit *gaussian, double *sum);

#endif
