/* The posterior of all columns: see posterior.h. */
#include "posterior.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "equations.h"
#include "merge.h"
#include "models.h"
#include "spread.h"

/* Of a reading that is set aside, in ln of the density: one in a hundred is wrong. */
static const double FOR_OUTLYING = 4.6;

enum { MOST_READINGS = 3000 /* of a column that are not merged */ };

gonio_status gonio_i_posterior_evidence(gonio_context *context, const gonio_i_prior *prior,
                                        const gonio_i_column *column, double alpha, double peak,
                                        double *evidence)
{
    gonio_i_gaussian e;
    gonio_status status = gonio_i_gaussian_begin(context, prior, column, &e);
    if (status == GONIO_OK) {
        const gonio_i_model model = {GONIO_I_KERNEL_WIDTH, alpha, peak};
        status = gonio_i_gaussian_solve(&e, &model);
    }
    size_t outlying = 0;
    if (status == GONIO_OK) {
        status = gonio_i_gaussian_settle(&e, true, &outlying);
    }
    *evidence = e.evidence - (double)outlying * FOR_OUTLYING;
    gonio_i_gaussian_end(&e);
    return status;
}

/* ---- one column ---- */

/* c = z + h^2 F' S^-1 (y - F z), in units of the prior. */
static void find_coefficients(const gonio_i_gaussian *e, double *c)
{
    memcpy(c, e->centre, e->components * sizeof *c);
    for (size_t i = 0; i < e->n; i++) {
        for (size_t k = 0; k < e->components; k++) {
            c[k] += e->model.h * e->model.h * e->solved[i] * e->f[i * e->components + k];
        }
    }
}

/* Root mean square of what is left between the readings and the field at them: D S^-1 (y - F z). */
static double square_left(const gonio_i_gaussian *e)
{
    double sum = 0.0;
    for (size_t i = 0; i < e->n; i++) {
        const double left = e->left_out[i] ? 0.0 : e->variance[i] * e->solved[i];
        sum += left * left;
    }
    return sum;
}

/* The sums over rows and columns that the predicted error is made of. */
typedef struct predicted_sums {
    double error;
    double square;
    size_t readings; /* after merging */
} predicted_sums;

/* What a column's field is made of, kept until all columns are solved: of no model yet. */
static gonio_status keep_places(const gonio_i_gaussian *e, size_t column, gonio_i_posterior *p,
                                gonio_i_spread_column *kept)
{
    *kept =
        (gonio_i_spread_column){.n = e->n,
                                .place = gonio_i_allocate(e->context, e->n, sizeof *kept->place),
                                .smooth = gonio_i_allocate(e->context, e->n, sizeof *kept->smooth),
                                .peaked = gonio_i_allocate(e->context, e->n, sizeof *kept->peaked),
                                .c = p->coefficients + column * e->components,
                                .field = p->field + column * e->prior->view.rows};
    if (kept->place == NULL || kept->smooth == NULL || kept->peaked == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    if (e->n > 0) {
        memcpy(kept->place, e->place, e->n * sizeof *kept->place);
    }
    return GONIO_OK;
}

static void forget(gonio_i_spread_column *kept)
{
    free(kept->place);
    free(kept->smooth);
    free(kept->peaked);
}

/* Adds what a model says, by its weight. c: scratch of K. */
static void add_model(const gonio_i_gaussian *e, double weight, double *c, double *sum,
                      gonio_i_spread_column *kept)
{
    const gonio_i_model *m = &e->model;
    find_coefficients(e, c);
    for (size_t k = 0; k < e->components; k++) {
        sum[k] += weight * c[k];
    }
    for (size_t i = 0; i < e->n; i++) {
        const double smooth = weight * m->alpha * m->alpha * e->solved[i];
        kept->smooth[i] += smooth;
        kept->peaked[i] += smooth * m->peak * m->peak;
    }
}

/* The mean over the models, with the readings judged as they are. */
static gonio_status mix_models(gonio_i_gaussian *e, const gonio_i_models *models, double *sum,
                               gonio_i_spread_column *kept)
{
    double *c = gonio_i_allocate(e->context, e->components, sizeof *c);
    gonio_status status = c == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    memset(sum, 0, e->components * sizeof *sum);
    for (size_t k = 0; k < models->count && status == GONIO_OK; k++) {
        status = gonio_i_gaussian_solve(e, &models->model[k]);
        if (status == GONIO_OK) {
            add_model(e, models->weight[k], c, sum, kept);
        }
    }
    free(c);
    return status;
}

/* The variance, of the best model; it is in e. */
static gonio_status find_variance(const gonio_i_gaussian *e, size_t column, gonio_i_posterior *p,
                                  predicted_sums *sums)
{
    double *c = p->coefficients + column * e->components;
    double *deviation = p->deviation != NULL ? p->deviation + column * e->prior->view.rows : NULL;
    find_coefficients(e, c);
    return gonio_i_spread_variance(e, c, deviation, p->covariance, &sums->error, &sums->square);
}

static gonio_status solve_column(gonio_i_gaussian *e, const gonio_i_models *models, size_t column,
                                 gonio_i_posterior *p, predicted_sums *sums,
                                 gonio_i_spread_column *kept)
{
    size_t outlying = 0;
    double surprise = 0.0;
    gonio_status status = gonio_i_gaussian_solve(e, &models->best);
    if (status == GONIO_OK) {
        status = gonio_i_gaussian_settle(e, true, &outlying);
    }
    if (status == GONIO_OK) {
        status = gonio_i_gaussian_surprise(e, &surprise);
    }
    if (status == GONIO_OK) {
        p->outlying += outlying;
        p->residual += square_left(e);
        p->surprise += surprise;
        sums->readings += e->n;
        status = find_variance(e, column, p, sums);
    }
    if (status == GONIO_OK) {
        status = keep_places(e, column, p, kept);
    }
    return status == GONIO_OK
               ? mix_models(e, models, p->coefficients + column * e->components, kept)
               : status;
}

static gonio_status begin_column(gonio_context *context, const gonio_i_prior *prior,
                                 const gonio_i_column *column, size_t most, gonio_i_gaussian *e)
{
    gonio_i_column merged = {0};
    const bool many = column->count > most;
    gonio_status status = GONIO_OK;
    if (many) {
        status = gonio_i_merge(context, column, most, &merged);
    }
    if (status == GONIO_OK) {
        status = gonio_i_gaussian_begin(context, prior, many ? &merged : column, e);
    }
    free(merged.observation);
    return status;
}

static gonio_status find_column(gonio_context *context, const gonio_i_prior *prior,
                                const gonio_i_column *columns, size_t column,
                                const gonio_i_models *models, size_t most, gonio_i_posterior *p,
                                predicted_sums *sums, gonio_i_spread_column *kept)
{
    gonio_i_gaussian e = {0};
    gonio_status status = begin_column(context, prior, &columns[column], most, &e);
    if (status == GONIO_OK) {
        status = solve_column(&e, models, column, p, sums, kept);
    }
    gonio_i_gaussian_end(&e);
    return status;
}

gonio_status gonio_i_posterior_find(gonio_context *context, const gonio_i_prior *prior,
                                    const gonio_i_column *columns, size_t count,
                                    const gonio_i_posterior_options *options, gonio_i_posterior *p)
{
    predicted_sums sums = {0};
    const size_t most = options->most > 0 ? options->most : MOST_READINGS;
    gonio_i_models models =
        gonio_i_models_of((gonio_i_model){GONIO_I_KERNEL_WIDTH, options->smoothness, 0.0});
    gonio_i_spread_column *kept = gonio_i_allocate(context, count, sizeof *kept);
    gonio_status status = kept == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    p->outlying = 0;
    p->residual = 0.0;
    p->surprise = 0.0;
    if (status == GONIO_OK && !(options->smoothness >= 0.0)) {
        status = gonio_i_models_weigh(context, prior, columns, count, &models);
    }
    p->smoothness = models.best.alpha;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = find_column(context, prior, columns, k, &models, most, p, &sums, &kept[k]);
        if (status == GONIO_OK) {
            status = gonio_i_progress(context, "reconstructing", (double)(k + 1) / (double)count);
        }
    }
    if (status == GONIO_OK) {
        status = gonio_i_spread_fields(context, prior, kept, count);
    }
    for (size_t k = 0; kept != NULL && k < count; k++) {
        forget(&kept[k]);
    }
    free(kept);
    for (size_t k = 0; k < count * prior->components && status == GONIO_OK; k++) {
        p->coefficients[k] *= prior->deviation[k % prior->components];
    }
    if (status == GONIO_OK) {
        const size_t values = prior->components * prior->components;
        for (size_t k = 0; p->covariance != NULL && k < values; k++) {
            p->covariance[k] /= (double)count;
        }
        p->norm = sqrt(sums.square / (double)count);
        p->predicted = 100.0 * sqrt(sums.error / sums.square);
        const double readings = fmax((double)sums.readings, 1.0);
        p->residual = sqrt(p->residual / readings);
        p->surprise = sqrt(p->surprise / readings);
    }
    return status;
}
