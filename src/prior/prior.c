/* The prior: see prior.h. */
#include "prior.h"

#include <math.h>
#include <stdlib.h>

#include "../direction/grid.h"

#define DEGREE (M_PI / 180.0)

/* Of the mirror direction, of what comes back, and where that begins to differ from the mirror
 * direction. */
static const double WIDTH = 1.0 * DEGREE;
static const double MOST_OBLIQUE = 0.15; /* cos theta_d */
static const double BACK_WIDTH = 3.0 * DEGREE;
static const double BACK_FROM = 10.0 * DEGREE;

/* b from which on a place is near the light. */
static const double BACK = 0.05;

/* How much the azimuth matters in narrow peaks, and from where on. */
static const double PEAK_TURN = 0.6;
static const double PEAK_TURN_FROM = 0.5 * DEGREE;

static double bell(double angle, double width)
{
    return exp(-0.5 * angle * angle / (width * width));
}

/* The weight of a column in learning, on average 1 (docs/method.md, mixtures). */
static double weight_of(const gonio_basis_view *view, size_t column)
{
    const size_t measured = gonio_i_measured_columns(view);
    const gonio_i_column_weights weights =
        gonio_i_weights_of_columns(measured, view->mixtures, view->analytic);
    return column < measured                         ? weights.measured
           : column < view->columns - view->analytic ? weights.mixture
                                                     : weights.analytic;
}

/* H - m = V S W' with every column times the root of its weight. So z of column j is
 * W_j ((columns - 1) / weight)^(1/2). */
static void find_samples(gonio_i_prior *prior)
{
    const gonio_basis_view *view = prior->view;
    for (size_t j = 0; j < prior->samples; j++) {
        const double weight = weight_of(view, j);
        const double factor = sqrt((double)(view->columns - 1) / weight);
        prior->share[j] = weight / (double)view->columns;
        for (size_t k = 0; k < prior->components; k++) {
            prior->sample[j * prior->components + k] =
                factor * view->loadings[j * prior->components + k];
        }
    }
}

gonio_status gonio_i_prior_create(gonio_context *context, const gonio_basis *basis,
                                  gonio_i_prior **prior)
{
    gonio_i_prior *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->basis = basis;
    made->view = gonio_basis_describe(basis);
    made->components = made->view->components;
    made->samples = made->view->loadings != NULL ? made->view->columns : 0;
    made->deviation = gonio_i_allocate(context, made->components, sizeof *made->deviation);
    made->sample =
        gonio_i_allocate(context, made->samples * made->components, sizeof *made->sample);
    made->share = gonio_i_allocate(context, made->samples, sizeof *made->share);
    if (made->deviation == NULL || made->sample == NULL || made->share == NULL) {
        gonio_i_prior_free(&made);
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < made->components; k++) {
        made->deviation[k] = sqrt(made->view->variances[k]);
    }
    find_samples(made);
    *prior = made;
    return GONIO_OK;
}

void gonio_i_prior_free(gonio_i_prior **prior)
{
    if (prior == NULL || *prior == NULL) {
        return;
    }
    free((*prior)->deviation);
    free((*prior)->sample);
    free((*prior)->share);
    free(*prior);
    *prior = NULL;
}

static void scale(const gonio_i_prior *prior, double *f)
{
    for (size_t k = 0; k < prior->components; k++) {
        f[k] *= prior->deviation[k];
    }
}

void gonio_i_prior_at(const gonio_i_prior *prior, gonio_half_difference at, int channel,
                      double *mean, double *f)
{
    gonio_i_basis_row_at(prior->basis, at, channel, prior->components, mean, f);
    scale(prior, f);
}

void gonio_i_prior_row(const gonio_i_prior *prior, size_t row, double *f)
{
    gonio_i_basis_rows(prior->basis, row, 1, prior->components, f);
    scale(prior, f);
}

gonio_i_place gonio_i_place_of(gonio_half_difference at)
{
    const double quarter = M_PI / 2.0;
    const double turn = sqrt(fmax(sin(at.theta_h) * sin(at.theta_d), 0.0)) / 1.5;
    const double peak_turn = PEAK_TURN * sin(at.theta_d) * (1.0 - bell(at.theta_h, PEAK_TURN_FROM));
    const double width = WIDTH / sqrt(fmax(cos(at.theta_d), MOST_OBLIQUE));
    return (gonio_i_place){{GONIO_THETA_H_BINS / 10.0 * sqrt(fmax(at.theta_h, 0.0) / quarter),
                            at.theta_d / quarter * 90.0 / 20.0, turn * cos(2.0 * at.phi_d),
                            turn * sin(2.0 * at.phi_d)},
                           {peak_turn * cos(2.0 * at.phi_d), peak_turn * sin(2.0 * at.phi_d)},
                           bell(at.theta_h, width),
                           bell(at.theta_d, BACK_WIDTH) * (1.0 - bell(at.theta_h, BACK_FROM))};
}

double gonio_i_place_distance(const gonio_i_place *a, const gonio_i_place *b)
{
    double square = 0.0;
    for (int k = 0; k < 4; k++) {
        square += (a->p[k] - b->p[k]) * (a->p[k] - b->p[k]);
    }
    return square;
}

double gonio_i_smooth(const gonio_i_place *a, const gonio_i_place *b)
{
    return exp(-0.5 * gonio_i_place_distance(a, b));
}

double gonio_i_peaked(const gonio_i_place *a, const gonio_i_place *b)
{
    const double both = a->peak * b->peak;
    const double across = a->u[0] - b->u[0];
    const double along = a->u[1] - b->u[1];
    const double square = gonio_i_place_distance(a, b) + across * across + along * along;
    return both > 1e-12 ? both * exp(-2.0 * square) : 0.0;
}

/* Peaks towards the light change little with the angle of incidence. */
double gonio_i_back(const gonio_i_place *a, const gonio_i_place *b)
{
    const double both = a->retro * b->retro;
    const double far = a->p[0] - b->p[0];
    return both > 1e-12 ? both * exp(-0.125 * far * far) : 0.0;
}

double gonio_i_remainder(const gonio_i_place *a, const gonio_i_place *b, double peak, double retro)
{
    double k = gonio_i_smooth(a, b);
    k += peak > 0.0 ? peak * peak * gonio_i_peaked(a, b) : 0.0;
    k += retro > 0.0 ? retro * retro * gonio_i_back(a, b) : 0.0;
    return k;
}

bool gonio_i_place_is_back(const gonio_i_place *place)
{
    return place->retro > BACK;
}

size_t gonio_i_sample_step(size_t rows)
{
    /* Without a divisor of 3 channels and 12 sectors. */
    size_t step = rows / 4096 + 1;
    while (step > 1 && (step % 2 == 0 || step % 3 == 0)) {
        step--;
    }
    return step;
}
