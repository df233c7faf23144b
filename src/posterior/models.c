/* The choice and the weights of models by leave-one-out prediction: see models.h. */
#include "models.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "parallel_for.h"

/* Models with narrow peaks need a large alpha: for materials like the database's own, peaks
 * increase the error by a tenth. */
static const struct remainder {
    double alpha, peak, retro;
} REMAINDERS[] = {{0.0, 0.0, 0.0},  {0.03, 0.0, 0.0}, {0.06, 0.0, 0.0}, {0.12, 0.0, 0.0},
                  {0.25, 0.0, 0.0}, {0.25, 8.0, 0.0}, {0.5, 0.0, 0.0},  {0.5, 8.0, 0.0},
                  {1.0, 0.0, 0.0},  {1.0, 8.0, 0.0},  {0.25, 0.0, 8.0}, {0.5, 0.0, 8.0}};

/* The share of the score that counts. Channels and neighbouring readings are not independent, so
 * the sum over all of them is overconfident. */
static const double SHARE = 1.0 / 8.0;

/* The log prior ratio of a plain Gaussian and a mixture. Chosen, like the share and the prior of
 * alpha, on two splits of the neural MERL materials (docs/experiments.md). */
static const double FOR_PLAIN = 2.0 / 3.0;

/* Models with less than this fraction of the largest weight are left out. */
static const double NEGLIGIBLE = 0.02;

enum {
    ALL_REMAINDERS = sizeof REMAINDERS / sizeof *REMAINDERS,
    CHOICES = 2 * ALL_REMAINDERS, /* as a mixture around the columns and as a plain Gaussian */
};

static gonio_i_model choice(int k, size_t readings)
{
    const struct remainder remainder = REMAINDERS[k % ALL_REMAINDERS];
    const double h = k < ALL_REMAINDERS ? gonio_i_kernel_width(readings) : 1.0;
    return (gonio_i_model){h, remainder.alpha, remainder.peak, remainder.retro};
}

/* The log prior of a model, up to a constant. */
static double log_prior(int k)
{
    const double least = REMAINDERS[1].alpha;
    const double alpha = fmax(REMAINDERS[k % ALL_REMAINDERS].alpha, least);
    const bool retro = REMAINDERS[k % ALL_REMAINDERS].retro > 0.0;
    return -SHARE * GONIO_I_FOR_REMAINDERS * log(alpha / least) -
           (retro ? SHARE * GONIO_I_FOR_RETRO : 0.0) - (k < ALL_REMAINDERS ? 0.0 : FOR_PLAIN);
}

/* The gain in score from which outliers are set aside, for each direction's worth of them. Right
 * readings of unusual materials gain up to 29 a direction. Readings that are wrong in all channels
 * are found before (wrong_directions.h). */
static const double FOR_WRONG_DIRECTION = 30.0;

/* Scores of every model given the readings, with outliers judged or not. */
typedef struct subset_scores {
    double score[CHOICES];
    size_t outlying;
} subset_scores;

/* The densities of one column's readings under every model. */
typedef struct scores {
    double *score; /* [CHOICES][n] */
    size_t outlying;
} scores;

typedef struct scoring {
    const gonio_i_subset *subset;
    bool judge_outliers;
    scores column[GONIO_I_SUBSET_COLUMNS];
} scoring;

static gonio_status score_models(gonio_i_fit *e, size_t readings, bool judge_outliers, scores *s)
{
    gonio_status status = gonio_i_fit_solve(e, &GONIO_I_SETTLING);
    if (status == GONIO_OK) {
        status = gonio_i_fit_settle(e, judge_outliers, &s->outlying);
    }
    for (int k = 0; k < CHOICES && status == GONIO_OK; k++) {
        const gonio_i_model model = choice(k, readings);
        status = gonio_i_leave_one_out_score(e, &model, s->score + (size_t)k * e->n);
    }
    return status;
}

static gonio_status score_column(void *data, gonio_context *context, size_t k)
{
    scoring *all = data;
    const gonio_i_subset *subset = all->subset;
    scores *s = &all->column[k];
    if (subset->readings[k] <= 1) {
        return GONIO_OK;
    }
    gonio_i_fit e = {0};
    s->score = gonio_i_allocate(context, CHOICES * subset->column[k].count, sizeof *s->score);
    gonio_status status = s->score == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = gonio_i_fit_begin(context, subset->sites[k], false, &subset->column[k], &e);
    }
    if (status == GONIO_OK) {
        status = score_models(&e, subset->readings[k], all->judge_outliers, s);
    }
    gonio_i_fit_end(&e);
    return status;
}

/* Reading by reading, in order. */
static void add_up(const scoring *all, subset_scores *o)
{
    for (size_t c = 0; c < all->subset->count; c++) {
        const scores *s = &all->column[c];
        const size_t n = all->subset->column[c].count;
        o->outlying += s->outlying;
        for (size_t i = 0; s->score != NULL && i < CHOICES * n; i++) {
            o->score[i / n] += s->score[i];
        }
    }
}

static gonio_status score_columns(gonio_context *context, const gonio_i_subset *subset,
                                  bool judge_outliers, subset_scores *o)
{
    scoring all = {.subset = subset, .judge_outliers = judge_outliers};
    gonio_i_steps steps = {.task = NULL};
    const gonio_status status =
        gonio_i_parallel_for(context, &steps, subset->count, score_column, &all);
    if (status == GONIO_OK) {
        add_up(&all, o);
    }
    for (size_t c = 0; c < subset->count; c++) {
        free(all.column[c].score);
    }
    return status;
}

/* The best score of the models, with the log prior added. */
static double best_score(const subset_scores *o)
{
    double best = -INFINITY;
    for (int k = 0; k < CHOICES; k++) {
        best = fmax(best, o->score[k] + log_prior(k) / SHARE);
    }
    return best;
}

gonio_i_models gonio_i_models_of(gonio_i_model model)
{
    return (gonio_i_models){
        .count = 1, .model = {model}, .weight = {1.0}, .best = model, .judge_outliers = true};
}

void gonio_i_models_make_plain(gonio_i_models *models)
{
    const gonio_i_models given = *models;
    models->count = 0;
    models->best.h = 1.0;
    for (size_t k = 0; k < given.count; k++) {
        gonio_i_model plain = given.model[k];
        plain.h = 1.0;
        size_t j = 0;
        while (j < models->count && !gonio_i_model_is_same(&models->model[j], &plain)) {
            j++;
        }
        models->model[j] = plain;
        models->weight[j] = given.weight[k] + (j < models->count ? models->weight[j] : 0.0);
        models->count += j == models->count;
    }
}

/* log_weight[CHOICES], but for a constant, as shares of those that are not negligible. */
static gonio_i_models normalise(const double log_weight[CHOICES], size_t readings)
{
    gonio_i_models models = {0};
    double most = -INFINITY;
    double sum = 0.0;
    for (int k = 0; k < CHOICES; k++) {
        models.best = log_weight[k] > most ? choice(k, readings) : models.best;
        most = fmax(most, log_weight[k]);
    }
    for (int k = 0; k < CHOICES; k++) {
        const double weight = exp(log_weight[k] - most);
        if (weight > NEGLIGIBLE) {
            models.model[models.count] = choice(k, readings);
            models.weight[models.count++] = weight;
            sum += weight;
        }
    }
    for (size_t k = 0; k < models.count; k++) {
        models.weight[k] /= sum;
    }
    return models;
}

/* Whether outliers are wrong readings rather than right readings of an unusual material. */
static bool outliers_are_wrong(const gonio_i_prior *prior, size_t columns,
                               const subset_scores *judged, const subset_scores *unjudged)
{
    const double values = (double)(gonio_i_rows_per_cell(prior->view->channels) * columns);
    const double directions = (double)judged->outlying / values;
    return best_score(judged) - best_score(unjudged) > FOR_WRONG_DIRECTION * directions;
}

gonio_status gonio_i_models_weigh(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_i_subset *subset, gonio_i_models *models)
{
    static_assert((int)CHOICES <= (int)GONIO_I_MOST_MODELS, "room for all choices");
    double log_weight[CHOICES];
    subset_scores judged = {0};
    subset_scores unjudged = {0};
    gonio_status status = score_columns(context, subset, true, &judged);
    if (status == GONIO_OK && judged.outlying > 0) {
        status = score_columns(context, subset, false, &unjudged);
    }
    const bool wrong =
        judged.outlying == 0 || outliers_are_wrong(prior, subset->count, &judged, &unjudged);
    const subset_scores *chosen = wrong ? &judged : &unjudged;
    for (int k = 0; k < CHOICES; k++) {
        const gonio_i_model model = choice(k, subset->readings[0]);
        log_weight[k] = gonio_i_sites_tell_of(subset->sites[0], &model)
                            ? SHARE * chosen->score[k] + log_prior(k)
                            : -INFINITY;
    }
    *models = normalise(log_weight, subset->readings[0]);
    models->judge_outliers = wrong;
    return status;
}
