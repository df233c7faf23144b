/* The readings of one column as a Gaussian problem: see posterior.h for the symbols. */
#ifndef GONIO_EQUATIONS_H
#define GONIO_EQUATIONS_H

#include "posterior.h"

/* h: how much of the database's covariance each of its columns keeps around itself. 1 would be a
 * plain Gaussian, better by 2 % at 170 readings of the neural MERL materials and worse by 8 % at 5.
 */
static const double GONIO_I_KERNEL_WIDTH = 0.7;

typedef struct gonio_i_gaussian {
    gonio_context *context;
    const gonio_i_prior *prior;
    size_t n;
    size_t components;
    double h;             /* 1 without samples */
    double *f;            /* [n][K] */
    gonio_i_place *place; /* [n] */
    double *y;            /* [n]: g - m */
    double *variance;     /* [n]: D */
    int *bound;           /* [n] */
    bool *left_out;       /* [n]: a bound that is kept anyway, which says nothing */
    double *seen;         /* [samples][n]: a F z_j */
    double *gram;         /* [n][n]: F F' */
    double *smooth;       /* [n][n]: the parts of k */
    double *peaked;       /* [n][n] */
    double alpha;
    double peak;
    double *lower;   /* [n][n]: L of S */
    double *weight;  /* [samples]: q */
    double *centre;  /* [K]: z */
    double *rest;    /* [n]: y - F z */
    double *solved;  /* [n]: S^-1 rest */
    double evidence; /* ln p(y) */
    double misfit;   /* what the variances are multiplied by, see below */
} gonio_i_gaussian;

/* Fills in everything up to `peaked`. To be freed in any case. Errors: _MEMORY. */
gonio_status gonio_i_gaussian_begin(gonio_context *context, const gonio_i_prior *prior,
                                    const gonio_i_column *column, gonio_i_gaussian *gaussian);
void gonio_i_gaussian_end(gonio_i_gaussian *gaussian);

/* The rest, for an alpha and a peak. Errors: _NUMERICAL, _MEMORY. */
gonio_status gonio_i_gaussian_solve(gonio_i_gaussian *gaussian, double alpha, double peak);

/* What the other readings say of each one: the difference to it, and its variance (noise
 * included), difference[n], variance[n]. */
gonio_status gonio_i_gaussian_leave_one_out(const gonio_i_gaussian *gaussian, double *difference,
                                            double *variance);

/* Takes out bounds that hold anyway and gives readings that the others contradict a variance to
 * match, until nothing changes. outlying: how many of the latter. */
gonio_status gonio_i_gaussian_settle(gonio_i_gaussian *gaussian, size_t *outlying);

/* Sum over the readings of (reading - what the others say)^2 / its variance; and sets misfit to its
 * mean, held towards 1 by `PRIOR_READINGS` readings that are as expected: a material that surprises
 * where it was read will elsewhere. */
gonio_status gonio_i_gaussian_surprise(gonio_i_gaussian *gaussian, double *sum);

#endif
