/* From loss to expected error: see expected_error_scale.h. */
#include "expected_error_scale.h"

#include <math.h>
#include <stdlib.h>

#include "../linalg/linalg.h"

/* Standard deviation, log units, of the error that remains whatever is read. Chosen so that the
 * expected error is that of left-out materials (docs/experiments.md). */
static const double LEFT_OPEN = 0.05;

/* The mean of 1/|g| over the measured columns of the database; |g| with the weights of the rows. */
static gonio_status mean_reciprocal(const gonio_i_choices *p, double *mean)
{
    const gonio_i_prior *prior = p->prior;
    const size_t measured = gonio_i_measured_columns(prior->view);
    const size_t used = prior->samples > 0 ? measured : 0;
    double *f = gonio_i_allocate(p->context, prior->components, sizeof *f);
    double *square = gonio_i_allocate(p->context, used + 1, sizeof *square);
    if (f == NULL || square == NULL) {
        free(f);
        free(square);
        return GONIO_ERROR_MEMORY;
    }
    const size_t step = p->rows / 4096 + 1; /* a sample of the rows is enough */
    for (size_t row = 0; row < p->rows; row += step) {
        double m = 0.0;
        gonio_i_prior_at(prior, p->at[row], 0, &m, f);
        for (size_t j = 0; j < used; j++) {
            const double g =
                m + gonio_i_dot(f, prior->sample + j * prior->components, prior->components);
            square[j] += (double)step * p->loss[row] * g * g;
        }
        square[used] += (double)step * p->loss[row] * m * m;
    }
    *mean = used > 0 ? 0.0 : 1.0 / sqrt(square[used]);
    for (size_t j = 0; j < used; j++) {
        *mean += 1.0 / sqrt(fmax(square[j], 1e-300)) / (double)used;
    }
    free(f);
    free(square);
    return GONIO_OK;
}

/* The part of E6, per cent, that remains whatever is read; `reciprocal`: 1/|g|. */
static double open_part(const gonio_i_choices *p, double reciprocal)
{
    double all = 0.0;
    for (size_t row = 0; row < p->rows; row++) {
        all += p->loss[row];
    }
    return 100.0 * LEFT_OPEN * sqrt(all) * reciprocal;
}

gonio_status gonio_i_find_error_of_loss(const gonio_i_choices *p, gonio_i_error_of_loss *e)
{
    double reciprocal = 0.0;
    gonio_status status = GONIO_OK;
    if (p->known != NULL) {
        reciprocal = 1.0 / p->known->norm;
    } else {
        status = mean_reciprocal(p, &reciprocal);
    }
    e->factor = 1.0;
    e->scale = 100.0 * 100.0 * reciprocal * reciprocal;
    e->open = open_part(p, reciprocal);
    return status;
}

void gonio_i_scale_to_known(const gonio_i_known *known, double loss, gonio_i_error_of_loss *e)
{
    e->scale = fmax(known->variance * known->variance - e->open * e->open, 0.0) / loss;
    e->factor = known->expected / known->variance;
}

double gonio_i_enough_for(const gonio_i_error_of_loss *e, double target)
{
    return target > e->open ? (target * target - e->open * e->open) / e->scale : 0.0;
}

double gonio_i_expected_error_of(const gonio_i_error_of_loss *e, double loss)
{
    return e->factor * sqrt(e->scale * fmax(loss, 0.0) + e->open * e->open);
}
