/* What a basis says of a material before anything of it was read.
 *
 * In the basis's log space a channel of a material is
 *
 *     g(x) = m(x) + f(x) z + r(x),   f(x) = row x of V diag(lambda)^(1/2),
 *
 * z the database's part, of mean 0 and covariance I; r a smooth remainder that the database has
 * never seen, of mean 0 and covariance alpha^2 k(x, x') below. The columns that the basis was
 * learned from are samples of z. */
#ifndef GONIO_PRIOR_H
#define GONIO_PRIOR_H

#include "../basis/basis.h"

typedef struct gonio_i_prior {
    const gonio_basis *basis;
    const gonio_basis_view *view;
    size_t components; /* K, all of the basis */
    double *deviation; /* [K]: lambda^(1/2) */
    size_t samples;    /* columns; 0 if the basis has no loadings */
    double *sample;    /* [samples][K]: z of each column */
    double *share;     /* [samples], add up to 1 */
} gonio_i_prior;

/* The basis must outlive it. Errors: _MEMORY. */
gonio_status gonio_i_prior_create(gonio_context *context, const gonio_basis *basis,
                                  gonio_i_prior **prior);
void gonio_i_prior_free(gonio_i_prior **prior);

/* m and f at any directions: f[K]. */
void gonio_i_prior_at(const gonio_i_prior *prior, gonio_half_difference at, int channel,
                      double *mean, double *f);

/* f of a row of the basis. */
void gonio_i_prior_row(const gonio_i_prior *prior, size_t row, double *f);

/* The remainder has covariance alpha^2 k(x, x'),
 *
 *     k = exp(-|p - p'|^2/2) + peak^2 exp(-(theta_h^2 + theta_h'^2)/(2 WIDTH^2)) exp(-2 |p -
 * p'|^2):
 *
 * near the mirror direction, within about a degree (WIDTH), peaks can be narrower than any in the
 * database.
 *
 * Half/difference coordinates in which the remainder is smooth: lengths of 10 bins of theta_h
 * (which crowd around the mirror direction), 20 degrees of theta_d, and phi_d as far as it matters
 * there: two directions that differ in phi_d alone are the closer the nearer h is to the normal or
 * d to h. */
typedef struct gonio_i_place {
    double p[4];
    double peak; /* exp(-theta_h^2/(2 WIDTH^2)) */
} gonio_i_place;

gonio_i_place gonio_i_place_of(gonio_half_difference at);

/* |p - p'|^2. */
double gonio_i_place_distance(const gonio_i_place *a, const gonio_i_place *b);

/* The two parts of k: k = smooth + peak^2 peaked, for a `peak` of 0 or more. */
double gonio_i_smooth(const gonio_i_place *a, const gonio_i_place *b);
double gonio_i_peaked(const gonio_i_place *a, const gonio_i_place *b);
double gonio_i_remainder(const gonio_i_place *a, const gonio_i_place *b, double peak);

/* Every so manieth row makes a sample of some 4,096 rows, of all channels and sectors alike. */
size_t gonio_i_sample_step(size_t rows);

#endif
