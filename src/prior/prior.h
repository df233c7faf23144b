/* The prior: the distribution of a material, given a basis and no readings.
 *
 * In the basis's log space a channel of a material is
 *
 *     g(x) = m(x) + f(x) z + r(x),   f(x) = row x of V diag(lambda)^(1/2),
 *
 * z describes the part that the database spans. It has mean 0 and covariance I. r is a smooth
 * remainder that the database does not span. It has mean 0 and covariance alpha^2 k(x, x') (below).
 * The columns that the basis was learned from are samples of z. */
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
 *     k = exp(-|p - p'|^2/2) + peak^2 q q' exp(-2 |p - p'|^2 - 2 |u - u'|^2) + retro^2 b b' r,
 *
 *     q = exp(-(theta_h/1 deg)^2 cos(theta_d)/2),   r = exp(-(p_0 - p_0')^2/8),
 *
 *     b = exp(-(theta_d/3 deg)^2/2) (1 - exp(-(theta_h/10 deg)^2/2)):
 *
 * The second term allows peaks that are narrower than any in the database, within about a degree
 * of the mirror direction; the third those of retroreflectors, towards the light.
 *
 * p are half/difference coordinates scaled by the length scales: 10 bins of theta_h (which are
 * dense around the mirror direction) and 20 degrees of theta_d. The distance in phi_d becomes small
 * where phi_d matters little: where h is near the normal, or d near h.
 *
 * Narrow peaks are an exception. At oblique incidence they are longer across the plane of incidence
 * than along it, by up to 1/cos(theta_d): an instrument that blurs directions by a constant angle
 * makes them so. u is how phi_d matters there,
 *
 *     u = 0.6 sin(theta_d) (1 - exp(-(theta_h/0.5 deg)^2/2)) (cos 2 phi_d, sin 2 phi_d). */
typedef struct gonio_i_place {
    double p[4];
    double u[2];
    double peak;  /* q */
    double retro; /* b */
} gonio_i_place;

gonio_i_place gonio_i_place_of(gonio_half_difference at);

/* |p - p'|^2. */
double gonio_i_place_distance(const gonio_i_place *a, const gonio_i_place *b);

/* The terms of k: k = smooth + peak^2 peaked + retro^2 back, for a `peak` and `retro` of 0 or more.
 */
double gonio_i_smooth(const gonio_i_place *a, const gonio_i_place *b);
double gonio_i_peaked(const gonio_i_place *a, const gonio_i_place *b);
double gonio_i_back(const gonio_i_place *a, const gonio_i_place *b);
double gonio_i_remainder(const gonio_i_place *a, const gonio_i_place *b, double peak, double retro);

/* Whether a place is near enough to the light for the third term to count. */
bool gonio_i_place_is_back(const gonio_i_place *place);

/* The step between rows that gives a sample of some 4,096 rows, evenly of all channels and sectors.
 */
size_t gonio_i_sample_step(size_t rows);

#endif
