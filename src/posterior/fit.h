/* The values of one column as a Gaussian problem over its sites: see posterior.h for the symbols.
 */
#ifndef GONIO_FIT_H
#define GONIO_FIT_H

#include "sites.h"

/* The parameters of the model that the readings choose; see posterior.h. */
typedef struct gonio_i_model {
    double h;     /* kernel width: each kernel's covariance is h^2 I; 1 without samples */
    double alpha; /* of the remainder, log units */
    double peak;  /* of the remainder */
    double retro; /* the same, towards the light */
} gonio_i_model;

static inline bool gonio_i_model_is_same(const gonio_i_model *a, const gonio_i_model *b)
{
    return a->h == b->h && a->alpha == b->alpha && a->peak == b->peak && a->retro == b->retro;
}

/* Whether readings at the sites can tell of a model: of peaks towards the light only those near it
 * can. */
static inline bool gonio_i_sites_tell_of(const gonio_i_sites *sites, const gonio_i_model *model)
{
    return model->retro == 0.0 || sites->back != NULL;
}

/* An h that does well when nothing is known of it. */
static const double GONIO_I_KERNEL_WIDTH = 0.7;

typedef struct gonio_i_fit {
    gonio_context *context;
    const gonio_i_sites *sites; /* the directions; shared with other fits */
    const gonio_i_prior *prior;
    size_t n;
    size_t components;
    size_t samples;   /* of the prior; 0: a plain Gaussian */
    double *y;        /* [n]: g - m */
    double *variance; /* [n]: D */
    int *bound;       /* [n] */
    bool *left_out;   /* [n]: a bound that the prediction satisfies anyway: without information */
    gonio_i_model model;
    double *lower; /* [n][n]: L of S */
    /* Where it is kept (fit_inverse.h), otherwise NULL: */
    double *inverse;  /* [n][n]: of S when its variances were those of `inverted` */
    double *inverted; /* [n] */
    double *diagonal; /* [n]: of S^-1 as it is now */
    bool is_inverted; /* it is there, of this model */
    double *white;    /* [samples][n]: L^-1 (y - a F z_j); not made where h is 1 */
    double *weight;   /* [samples]: q; the same */
    double *centre;   /* [K]: z */
    double *rest;     /* [n]: y - F z */
    double *solved;   /* [n]: S^-1 rest */
    double evidence;  /* ln p(y) */
    double misfit;    /* what the variances are multiplied by, see below */
} gonio_i_fit;

/* h of a mixture for a column of n readings: (n/(n + 5))^(1/2). Narrow kernels help less with more
 * readings: for the neural MERL materials a plain Gaussian is worse by 15 % with five readings, and
 * better by 3 % with forty. */
double gonio_i_kernel_width(size_t n);

/* Begins a fit of a column's values over its sites, which must outlive it. plain: a Gaussian
 * without the samples of the prior. To be ended in any case. Errors: _MEMORY. */
gonio_status gonio_i_fit_begin(gonio_context *context, const gonio_i_sites *sites, bool plain,
                               const gonio_i_column *column, gonio_i_fit *fit);

/* Sets other values at the same sites. The fit is then as after gonio_i_fit_begin. */
void gonio_i_fit_read(gonio_i_fit *fit, const gonio_i_column *column);
void gonio_i_fit_end(gonio_i_fit *fit);

/* Solves the fit for a model. Errors: _NUMERICAL, _MEMORY. */
gonio_status gonio_i_fit_solve(gonio_i_fit *fit, const gonio_i_model *model);

/* Solves for a model without samples (h is 1) over the readings that are not left out, which have
 * next to no say: less work where they are many. Only the mean is found: `solved`, 0 for those left
 * out. L, the evidence and the inverse are those of no model then. Errors: _NUMERICAL, _MEMORY. */
gonio_status gonio_i_fit_solve_kept(gonio_i_fit *fit, const gonio_i_model *model);

/* The mean of the coefficients of a solved fit, in units of the prior: c[K] = z + h^2 F' S^-1 (y -
 * F z).
 */
void gonio_i_fit_coefficients(const gonio_i_fit *fit, double *c);

/* The samples whose weights are not negligible (above 1e-7) in a solved fit with h below 1:
 * listed[samples]. Returns how many. */
size_t gonio_i_fit_samples(const gonio_i_fit *fit, size_t *listed);

/* The variance of a reading in the fit: so large that it has no weight if it is left out. */
double gonio_i_fit_noise(const gonio_i_fit *fit, size_t reading);

/* Leave-one-out prediction: the difference of each reading to its prediction from the others,
 * difference[n], and the variance of that, noise included, variance[n]. Exact: samples are weighted
 * by the other readings only. */
gonio_status gonio_i_fit_leave_one_out(gonio_i_fit *fit, double *difference, double *variance);

/* Leaves out bounds that the prediction satisfies. If judge_outliers is set, gives outliers a
 * variance to match, until nothing changes. outlying: the number of outliers. Where the inverse is
 * kept, L and the evidence are then those from before; gonio_i_fit_solve makes them. */
gonio_status gonio_i_fit_settle(gonio_i_fit *fit, bool judge_outliers, size_t *outlying);

/* Sum over the readings of the squared leave-one-out error over its variance. Sets misfit to its
 * mean, shrunk towards 1 by `PRIOR_READINGS` readings as expected: a material that is predicted
 * badly where it was read is predicted badly elsewhere. */
gonio_status gonio_i_fit_surprise(gonio_i_fit *fit, double *sum);

#endif
