/* The posterior of all columns: see posterior.h. */
#include "posterior.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "wrong_directions.h"
#include "fit.h"
#include "learned_error.h"
#include "merge.h"
#include "models.h"
#include "predict.h"

/* Of a reading that is set aside, in ln of the density: one in a hundred is wrong. */
static const double FOR_OUTLYING = 4.6;

enum { MOST_READINGS = 3000 /* of a column that are not merged */ };

gonio_status gonio_i_posterior_evidence(gonio_context *context, const gonio_i_prior *prior,
                                        const gonio_i_column *column, double alpha, double peak,
                                        double *evidence)
{
    gonio_i_fit e;
    gonio_status status = gonio_i_fit_begin(context, prior, column, &e);
    if (status == GONIO_OK) {
        const gonio_i_model model = {GONIO_I_KERNEL_WIDTH, alpha, peak};
        status = gonio_i_fit_solve(&e, &model);
    }
    size_t outlying = 0;
    if (status == GONIO_OK) {
        status = gonio_i_fit_settle(&e, true, &outlying);
    }
    *evidence = e.evidence - (double)outlying * FOR_OUTLYING;
    gonio_i_fit_end(&e);
    return status;
}

/* ---- one column ---- */

/* c = z + h^2 F' S^-1 (y - F z), in units of the prior. */
static void find_coefficients(const gonio_i_fit *e, double *c)
{
    memcpy(c, e->centre, e->components * sizeof *c);
    for (size_t i = 0; i < e->n; i++) {
        for (size_t k = 0; k < e->components; k++) {
            c[k] += e->model.h * e->model.h * e->solved[i] * e->f[i * e->components + k];
        }
    }
}

/* Root mean square of what is left between the readings and the field at them: D S^-1 (y - F z). */
static double square_left(const gonio_i_fit *e)
{
    double sum = 0.0;
    for (size_t i = 0; i < e->n; i++) {
        const double left = e->left_out[i] ? 0.0 : e->variance[i] * e->solved[i];
        sum += left * left;
    }
    return sum;
}

/* What the columns have in common, and the sums over them. */
typedef struct finding {
    gonio_context *context;
    const gonio_i_prior *prior;
    gonio_i_models models;
    size_t most;                        /* readings of a column that are not merged */
    gonio_i_learned_error *expectation; /* NULL: the Gaussian's own */
    gonio_i_posterior *p;
    gonio_i_predicted_sums sums;
    double expected; /* the square of the error to expect, over the bins */
    size_t readings; /* after merging */
} finding;

/* What a column's field is made of, kept until all columns are solved: of no model yet. */
static gonio_status keep_places(const gonio_i_fit *e, size_t column, gonio_i_posterior *p,
                                gonio_i_predicted_column *kept)
{
    *kept = (gonio_i_predicted_column){
        .n = e->n,
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

static void forget(gonio_i_predicted_column *kept)
{
    free(kept->place);
    free(kept->smooth);
    free(kept->peaked);
}

/* Adds what a model says, by its weight. c: scratch of K. */
static void add_model(const gonio_i_fit *e, double weight, double *c, double *sum,
                      gonio_i_predicted_column *kept)
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
static gonio_status mix_models(gonio_i_fit *e, const gonio_i_models *models, double *sum,
                               gonio_i_predicted_column *kept)
{
    double *c = gonio_i_allocate(e->context, e->components, sizeof *c);
    gonio_status status = c == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    memset(sum, 0, e->components * sizeof *sum);
    for (size_t k = 0; k < models->count && status == GONIO_OK; k++) {
        status = gonio_i_fit_solve(e, &models->model[k]);
        if (status == GONIO_OK) {
            add_model(e, models->weight[k], c, sum, kept);
        }
    }
    free(c);
    return status;
}

static gonio_status begin_column(const finding *found, const gonio_i_column *column, size_t most,
                                 gonio_i_fit *e)
{
    gonio_i_column merged = {0};
    const bool many = column->count > most;
    gonio_status status = GONIO_OK;
    if (many) {
        status = gonio_i_merge(found->context, column, most, &merged);
    }
    if (status == GONIO_OK) {
        status = gonio_i_fit_begin(found->context, found->prior, many ? &merged : column, e);
    }
    free(merged.observation);
    return status;
}

/* The best model, with readings that the others contradict set aside. */
static gonio_status settle(const finding *found, gonio_i_fit *e, size_t *outlying)
{
    const gonio_status status = gonio_i_fit_solve(e, &found->models.best);
    return status == GONIO_OK ? gonio_i_fit_settle(e, true, outlying) : status;
}

/* The variance, of the best model; it is in e. */
static gonio_status find_variance(finding *found, const gonio_i_fit *e, size_t column,
                                  gonio_i_predicted_sums *sums)
{
    gonio_i_posterior *p = found->p;
    double *c = p->coefficients + column * e->components;
    double *deviation = p->deviation != NULL ? p->deviation + column * e->prior->view.rows : NULL;
    find_coefficients(e, c);
    return gonio_i_predict_variance(e, c, deviation, p->covariance, sums);
}

/* The mean square of the error to expect of a column that is in e, with fewer readings if there are
 * many. */
static gonio_status expect(const finding *found, const gonio_i_column *column, const gonio_i_fit *e,
                           double *square)
{
    if (e->n <= GONIO_I_LEARNED_ERROR_MOST) {
        return gonio_i_learned_error_find(found->expectation, e, square);
    }
    gonio_i_fit fewer = {0};
    size_t outlying = 0;
    gonio_status status = begin_column(found, column, GONIO_I_LEARNED_ERROR_MOST, &fewer);
    if (status == GONIO_OK) {
        status = settle(found, &fewer, &outlying);
    }
    if (status == GONIO_OK) {
        status = gonio_i_learned_error_find(found->expectation, &fewer, square);
    }
    gonio_i_fit_end(&fewer);
    return status;
}

static gonio_status sum_up(finding *found, const gonio_i_column *column, const gonio_i_fit *e,
                           size_t number)
{
    gonio_i_predicted_sums sums = {0};
    double square = 0.0;
    gonio_status status = find_variance(found, e, number, &sums);
    if (status == GONIO_OK && found->expectation != NULL) {
        status = expect(found, column, e, &square);
    }
    found->sums.bins += sums.bins;
    found->sums.error += sums.error;
    found->sums.square += sums.square;
    found->expected += found->expectation != NULL ? square * sums.bins : sums.error;
    return status;
}

static gonio_status solve_column(finding *found, const gonio_i_column *column, gonio_i_fit *e,
                                 size_t number, gonio_i_predicted_column *kept)
{
    gonio_i_posterior *p = found->p;
    size_t outlying = 0;
    double surprise = 0.0;
    gonio_status status = settle(found, e, &outlying);
    if (status == GONIO_OK) {
        status = gonio_i_fit_surprise(e, &surprise);
    }
    if (status == GONIO_OK) {
        p->outlying += outlying;
        p->residual += square_left(e);
        p->surprise += surprise;
        found->readings += e->n;
        status = sum_up(found, column, e, number);
    }
    if (status == GONIO_OK) {
        status = keep_places(e, number, p, kept);
    }
    return status == GONIO_OK
               ? mix_models(e, &found->models, p->coefficients + number * e->components, kept)
               : status;
}

static gonio_status find_column(finding *found, const gonio_i_column *column, size_t number,
                                gonio_i_predicted_column *kept)
{
    gonio_i_fit e = {0};
    gonio_status status = begin_column(found, column, found->most, &e);
    if (status == GONIO_OK) {
        status = solve_column(found, column, &e, number, kept);
    }
    gonio_i_fit_end(&e);
    return status;
}

static gonio_status find_columns(finding *found, const gonio_i_column *columns, size_t count)
{
    gonio_i_predicted_column *kept = gonio_i_allocate(found->context, count, sizeof *kept);
    gonio_status status = kept == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = find_column(found, &columns[k], k, &kept[k]);
        if (status == GONIO_OK) {
            status =
                gonio_i_progress(found->context, "reconstructing", (double)(k + 1) / (double)count);
        }
    }
    if (status == GONIO_OK) {
        status = gonio_i_predict_fields(found->context, found->prior, kept, count);
    }
    for (size_t k = 0; kept != NULL && k < count; k++) {
        forget(&kept[k]);
    }
    free(kept);
    return status;
}

/* 100 times the root of an error's square by g's: the estimate is shorter than g by the error. */
static double relative(const finding *found, double error)
{
    return 100.0 * sqrt(error / (found->sums.square + error));
}

/* From sums over the columns to what they stand for. Of the error the Gaussian of the likeliest
 * model has one opinion and the database another; the geometric mean of both is nearer to the truth
 * than either, in and out of the database (docs/accuracy.md). */
static void conclude(const finding *found, size_t count)
{
    const size_t components = found->prior->components;
    gonio_i_posterior *p = found->p;
    for (size_t k = 0; k < count * components; k++) {
        p->coefficients[k] *= found->prior->deviation[k % components];
    }
    for (size_t k = 0; p->covariance != NULL && k < components * components; k++) {
        p->covariance[k] /= (double)count;
    }
    const double readings = fmax((double)found->readings, 1.0);
    p->norm = sqrt((found->sums.square + found->sums.error) / (double)count);
    p->predicted_by_variance = relative(found, found->sums.error);
    p->predicted = sqrt(p->predicted_by_variance * relative(found, found->expected));
    p->residual = sqrt(p->residual / readings);
    p->surprise = sqrt(p->surprise / readings);
    p->smoothness = found->models.best.alpha;
}

/* Copies, as what is read wrongly gets another variance. */
static gonio_status copy_columns(gonio_context *context, const gonio_i_column *columns,
                                 size_t count, gonio_i_column *copies)
{
    for (size_t k = 0; k < count; k++) {
        const size_t bytes = columns[k].count * sizeof *copies[k].observation;
        copies[k].observation =
            gonio_i_allocate(context, columns[k].count, sizeof *copies[k].observation);
        if (copies[k].observation == NULL) {
            return GONIO_ERROR_MEMORY;
        }
        copies[k].count = columns[k].count;
        if (bytes > 0) {
            memcpy(copies[k].observation, columns[k].observation, bytes);
        }
    }
    return GONIO_OK;
}

static gonio_status find(finding *found, const gonio_i_column *columns, size_t count)
{
    const gonio_status status =
        gonio_i_learned_error_create(found->context, found->prior, &found->expectation);
    return status == GONIO_OK ? find_columns(found, columns, count) : status;
}

/* Directions that were read wrongly are set aside and models weighed without them first. */
static gonio_status doubt_and_find(finding *found, const gonio_i_column *columns, size_t count)
{
    gonio_context *context = found->context;
    gonio_i_column *copies = gonio_i_allocate(context, count, sizeof *copies);
    size_t wrong = 0;
    gonio_status status =
        copies == NULL ? GONIO_ERROR_MEMORY : copy_columns(context, columns, count, copies);
    if (status == GONIO_OK) {
        status = gonio_i_wrong_directions_find(context, found->prior, copies, count, &wrong);
    }
    if (status == GONIO_OK) {
        status = gonio_i_models_weigh(context, found->prior, copies, count, &found->models);
    }
    found->p->outlying += wrong;
    if (status == GONIO_OK) {
        status = find(found, copies, count);
    }
    for (size_t k = 0; copies != NULL && k < count; k++) {
        free(copies[k].observation);
    }
    free(copies);
    return status;
}

gonio_status gonio_i_posterior_find(gonio_context *context, const gonio_i_prior *prior,
                                    const gonio_i_column *columns, size_t count,
                                    const gonio_i_posterior_options *options, gonio_i_posterior *p)
{
    finding found = {.context = context,
                     .prior = prior,
                     .models = gonio_i_models_of(
                         (gonio_i_model){GONIO_I_KERNEL_WIDTH, options->smoothness, 0.0}),
                     .most = options->most > 0 ? options->most : MOST_READINGS,
                     .p = p};
    p->outlying = 0;
    p->residual = 0.0;
    p->surprise = 0.0;
    const gonio_status status = options->smoothness >= 0.0 ? find(&found, columns, count)
                                                           : doubt_and_find(&found, columns, count);
    if (status == GONIO_OK) {
        conclude(&found, count);
    }
    gonio_i_learned_error_free(&found.expectation);
    return status;
}
