/* The posterior of all columns: see posterior.h. */
#include "posterior.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "equations.h"
#include "merge.h"
#include "spread.h"

/* Narrow peaks only where there is much that the database does not know: for materials like its own
 * they cost a tenth. */
static const struct remainder {
    double alpha;
    double peak;
} REMAINDERS[] = {{0.0, 0.0},  {0.03, 0.0}, {0.06, 0.0}, {0.12, 0.0}, {0.25, 0.0},
                  {0.25, 8.0}, {0.5, 0.0},  {0.5, 8.0},  {1.0, 0.0},  {1.0, 8.0}};

/* What a choice must gain, in ln of the density of what is left out, over one that supposes less: a
 * few readings choose badly. Found on two splits of the neural MERL materials. */
static const double FOR_REMAINDERS = 2.0; /* for each factor of e from the smallest alpha on */
static const double FOR_PLAIN = 2.0;      /* for a plain Gaussian instead of a mixture */

enum {
    ALL_REMAINDERS = sizeof REMAINDERS / sizeof *REMAINDERS,
    CHOICES = 2 * ALL_REMAINDERS, /* as a mixture around the columns and as a plain Gaussian */
    MOST_TRIED = 128,             /* readings of a column that the model is chosen by */
    MOST_COLUMNS_TRIED = 8,       /* columns that it is chosen by */
    MOST_READINGS = 3000,         /* of a column that are not merged */
};

static gonio_i_model choice(int k, size_t readings)
{
    const struct remainder remainder = REMAINDERS[k % ALL_REMAINDERS];
    const double h = k < ALL_REMAINDERS ? gonio_i_kernel_width(readings) : 1.0;
    return (gonio_i_model){h, remainder.alpha, remainder.peak};
}

static double handicap(int k)
{
    const double least = REMAINDERS[1].alpha;
    const double alpha = fmax(REMAINDERS[k % ALL_REMAINDERS].alpha, least);
    return FOR_REMAINDERS * log(alpha / least) + (k < ALL_REMAINDERS ? 0.0 : FOR_PLAIN);
}

/* The model while wrong readings are looked for: found only afterwards, they would pass for a
 * remainder. */
static const gonio_i_model SETTLING = {GONIO_I_KERNEL_WIDTH, 0.12, 0.0};

/* Of a reading that is set aside, in ln of the density: one in a hundred is wrong. */
static const double FOR_OUTLYING = 4.6;

/* Readings are wrong more often than Gaussians say: what is left out is scored by Student's t with
 * this many degrees of freedom. */
static const double FREEDOM = 4.0;

/* ---- choosing the model ---- */

/* ln of Student's density of a difference, but for a constant. */
static double score_of(double difference, double variance)
{
    const double square = difference * difference / variance;
    return -0.5 * log(variance) - 0.5 * (FREEDOM + 1.0) * log1p(square / FREEDOM);
}

static gonio_status add_scores(gonio_i_gaussian *e, size_t readings, double score[CHOICES])
{
    double *difference = gonio_i_allocate(e->context, e->n, sizeof *difference);
    double *variance = gonio_i_allocate(e->context, e->n, sizeof *variance);
    gonio_status status = difference == NULL || variance == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (int k = 0; k < CHOICES && status == GONIO_OK; k++) {
        const gonio_i_model model = choice(k, readings);
        status = gonio_i_gaussian_solve(e, &model);
        if (status == GONIO_OK) {
            status = gonio_i_gaussian_leave_one_out(e, difference, variance);
        }
        for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
            score[k] += score_of(difference[i], variance[i]);
        }
    }
    free(difference);
    free(variance);
    return status;
}

/* At most MOST_TRIED readings of a column, evenly spaced. */
static gonio_status thin(gonio_context *context, const gonio_i_column *column,
                         gonio_i_column *thinned)
{
    const size_t count = column->count < MOST_TRIED ? column->count : MOST_TRIED;
    thinned->observation = gonio_i_allocate(context, count, sizeof *thinned->observation);
    thinned->count = count;
    if (thinned->observation == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t i = 0; i < count; i++) {
        thinned->observation[i] = column->observation[i * column->count / count];
    }
    return GONIO_OK;
}

static gonio_status score_column(gonio_context *context, const gonio_i_prior *prior,
                                 const gonio_i_column *column, double score[CHOICES])
{
    gonio_i_column thinned = {0};
    gonio_i_gaussian e = {0};
    gonio_status status = thin(context, column, &thinned);
    if (status == GONIO_OK) {
        status = gonio_i_gaussian_begin(context, prior, &thinned, &e);
    }
    if (status == GONIO_OK) {
        status = gonio_i_gaussian_solve(&e, &SETTLING);
    }
    if (status == GONIO_OK) {
        size_t outlying = 0;
        status = gonio_i_gaussian_settle(&e, &outlying);
    }
    if (status == GONIO_OK) {
        status = add_scores(&e, column->count, score);
    }
    gonio_i_gaussian_end(&e);
    free(thinned.observation);
    return status;
}

static gonio_status choose_model(gonio_context *context, const gonio_i_prior *prior,
                                 const gonio_i_column *columns, size_t count, gonio_i_model *model)
{
    double score[CHOICES] = {0.0};
    const size_t tried = count < MOST_COLUMNS_TRIED ? count : MOST_COLUMNS_TRIED;
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < tried && status == GONIO_OK; k++) {
        const gonio_i_column *column = &columns[k * count / tried];
        status = column->count > 1 ? score_column(context, prior, column, score) : GONIO_OK;
    }
    int best = 0;
    for (int k = 1; k < CHOICES; k++) {
        best = score[k] - handicap(k) > score[best] - handicap(best) ? k : best;
    }
    *model = choice(best, columns[0].count);
    return status;
}

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
        status = gonio_i_gaussian_settle(&e, &outlying);
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

/* What a column's field is made of, kept until all columns are solved. */
static gonio_status keep_column(gonio_i_gaussian *e, size_t column, gonio_i_posterior *p,
                                gonio_i_spread_column *kept)
{
    const size_t n = e->model.alpha > 0.0 ? e->n : 0;
    *kept = (gonio_i_spread_column){.peak = e->model.peak,
                                    .n = n,
                                    .place = gonio_i_allocate(e->context, n, sizeof *kept->place),
                                    .weight = gonio_i_allocate(e->context, n, sizeof *kept->weight),
                                    .c = p->coefficients + column * e->components,
                                    .field = p->field + column * e->prior->view.rows};
    if (kept->place == NULL || kept->weight == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        kept->place[i] = e->place[i];
        kept->weight[i] = e->model.alpha * e->model.alpha * e->solved[i];
    }
    return GONIO_OK;
}

static gonio_status solve_column(gonio_i_gaussian *e, size_t column, gonio_i_posterior *p,
                                 predicted_sums *sums, gonio_i_spread_column *kept)
{
    double *c = p->coefficients + column * e->components;
    double *deviation = p->deviation != NULL ? p->deviation + column * e->prior->view.rows : NULL;
    find_coefficients(e, c);
    const gonio_status status = keep_column(e, column, p, kept);
    return status == GONIO_OK ? gonio_i_spread_variance(e, c, deviation, p->covariance,
                                                        &sums->error, &sums->square)
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
                                const gonio_i_model *model, size_t most, gonio_i_posterior *p,
                                predicted_sums *sums, gonio_i_spread_column *kept)
{
    gonio_i_gaussian e = {0};
    size_t outlying = 0;
    double surprise = 0.0;
    gonio_status status = begin_column(context, prior, &columns[column], most, &e);
    if (status == GONIO_OK) {
        status = gonio_i_gaussian_solve(&e, model);
    }
    if (status == GONIO_OK) {
        status = gonio_i_gaussian_settle(&e, &outlying);
    }
    if (status == GONIO_OK) {
        status = gonio_i_gaussian_surprise(&e, &surprise);
    }
    if (status == GONIO_OK) {
        status = solve_column(&e, column, p, sums, kept);
        p->outlying += outlying;
        p->residual += square_left(&e);
        p->surprise += surprise;
        sums->readings += e.n;
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
    gonio_i_model model = {GONIO_I_KERNEL_WIDTH, options->smoothness, 0.0};
    gonio_i_spread_column *kept = gonio_i_allocate(context, count, sizeof *kept);
    gonio_status status = kept == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    p->outlying = 0;
    p->residual = 0.0;
    p->surprise = 0.0;
    if (status == GONIO_OK && !(options->smoothness >= 0.0)) {
        status = choose_model(context, prior, columns, count, &model);
    }
    p->smoothness = model.alpha;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = find_column(context, prior, columns, k, &model, most, p, &sums, &kept[k]);
        if (status == GONIO_OK) {
            status = gonio_i_progress(context, "reconstructing", (double)(k + 1) / (double)count);
        }
    }
    if (status == GONIO_OK) {
        status = gonio_i_spread_fields(context, prior, kept, count);
    }
    for (size_t k = 0; kept != NULL && k < count; k++) {
        free(kept[k].place);
        free(kept[k].weight);
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
