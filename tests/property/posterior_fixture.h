/* What the tests of the posterior share: small bases, their priors, materials drawn from them, and
 * dense algebra. */
#ifndef GONIO_TEST_POSTERIOR_FIXTURE_H
#define GONIO_TEST_POSTERIOR_FIXTURE_H

#include "../support.h"

#include "posterior/models.h"
#include "posterior/wrong_directions.h"

enum { MOST = 60 };

static const double ALPHA = 0.1;
static const double PEAK = 0.0; /* the peak of a given alpha */

typedef struct posterior_fixture {
    gonio_context *context;
    gonio_basis *small;      /* bivariate, of which the priors are */
    gonio_basis *basis;      /* sectored */
    gonio_i_prior *gaussian; /* without samples: h = 1 */
    gonio_i_prior *mixture;
} posterior_fixture;

extern posterior_fixture fixture;

int fixture_set_up(void **state);
int fixture_tear_down(void **state);

void assert_close(double value, double expected, double tolerance);

/* A material drawn from the prior, with readings at random rows. */
typedef struct drawn {
    double *z;
    size_t row[MOST];
    gonio_i_observation reading[MOST];
} drawn;

/* g of the material z. */
double truth_at(const double *z, gonio_half_difference at);

/* Whether a row's coordinates are those of its cell. Not if a part of it is below the horizon. */
bool is_whole(size_t row);

/* deviation: the standard deviation of the readings' noise. The caller frees z. */
drawn draw(uint64_t seed, double deviation);

/* The posterior of one column; released by drop(). */
typedef struct found {
    double *field;
    double *deviation;
    gonio_i_posterior posterior;
} found;

/* The posterior of one column, with merged readings if there are more than `most` (0: no limit). */
found find_of(const gonio_i_prior *prior, gonio_i_observation *readings, size_t count, double alpha,
              size_t most);

/* The same without a limit. */
found find(const gonio_i_prior *prior, gonio_i_observation *readings, size_t count, double alpha);

void drop(found *r);

/* Root mean square of the difference of two fields. */
double difference(const found *a, const found *b);

/* ---- dense algebra ---- */

/* Replaces a by its inverse (Gauss and Jordan). Returns the logarithm of its determinant. */
double invert(double *a, size_t n);

/* h^2 f f' + alpha^2 k of two directions. */
double covariance(gonio_half_difference a, gonio_half_difference b, double h, double alpha);

/* The prior mean m. */
double mean_at(gonio_half_difference at);

/* s[n][n]: the inverse of the covariance of readings. Returns the logarithm of the covariance's
 * determinant. */
double invert_covariance(const gonio_i_observation *readings, size_t n, double h, double alpha,
                         double *s);

/* Mean and variance of g at a direction, given readings. s: the inverse of their covariance. */
void textbook(const gonio_i_observation *readings, size_t n, const double *s,
              gonio_half_difference at, double *mean, double *variance);

/* ---- fits ---- */

/* A fit over sites of its own. */
gonio_i_fit begin_fit(const gonio_i_prior *prior, const gonio_i_column *column,
                      gonio_i_sites **sites);

void end_fit(gonio_i_fit *e, gonio_i_sites **sites);

#endif
