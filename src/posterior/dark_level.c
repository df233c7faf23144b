/* The dark level: see dark_level.h.
 *
 * Levels are tried, and each is as likely as the readings of its column are when they are left out
 * one at a time: those above zero by their density, per 1/sr, and zeros by the probability of
 * reading nothing. Of usual and of unusual materials, the likelier one; plain Gaussians do. */
#include "dark_level.h"

#include <math.h>
#include <stdlib.h>

#include "leave_one_out.h"

/* Levels in units of s, and none: from what makes no difference to what makes an instrument
 * useless, 2^(1/2) apart. */
static const double LEAST_LEVEL = 0.125;

enum { LEVELS = 14 };

static double level(int k)
{
    return k == 0 ? 0.0 : LEAST_LEVEL * pow(2.0, 0.5 * (k - 1));
}

/* ln of how much likelier levels make all readings before they are believed, of three channels; of
 * more, which say the same again, as their number's square root. Of readings that lack nothing the
 * best levels explain less than 1 (docs/accuracy.md). */
static const double CONVINCING = 8.0;

/* From a usual material's to that of the most unusual one. */
static const gonio_i_model MODELS[] = {{1.0, 0.12, 0.0}, {1.0, 0.25, 8.0}, {1.0, 0.5, 8.0}};

enum { MODELS_COUNT = sizeof MODELS / sizeof *MODELS };

/* A zero is read for another reason. */
static const double OTHERWISE = 0.03;

/* ln of the probability that a reading is as far down as its bound, from what the others say. */
static double log_probability(double difference, double variance)
{
    const double below = 0.5 * erfc(-difference / sqrt(2.0 * variance));
    return log((1.0 - OTHERWISE) * below + OTHERWISE);
}

/* ln of how likely the readings of a column are, but for a constant. */
static gonio_status score_readings(gonio_i_fit *e, const gonio_i_model *model,
                                   const gonio_i_column *column, double *score)
{
    double *difference = NULL;
    const gonio_status status = gonio_i_leave_one_out_differences(e, model, &difference);
    *score = 0.0;
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        /* What is left out or set aside is judged like all others. */
        const double others = difference[e->n + i] - gonio_i_fit_noise(e, i);
        const double variance = fmax(others, 0.0) + column->observation[i].variance;
        if (e->bound[i] < 0) {
            *score += log_probability(difference[i], variance);
        } else if (e->bound[i] == 0) {
            *score +=
                gonio_i_leave_one_out_density(difference[i], variance) - column->observation[i].g;
        }
    }
    free(difference);
    return status;
}

static gonio_status score_model(gonio_context *context, const gonio_i_prior *plain,
                                const gonio_i_model *model, const gonio_i_column *column,
                                double *score)
{
    gonio_i_fit e = {0};
    size_t outlying = 0;
    gonio_status status = gonio_i_fit_begin(context, plain, column, &e);
    if (status == GONIO_OK) {
        status = gonio_i_fit_solve(&e, model);
    }
    if (status == GONIO_OK) {
        status = gonio_i_fit_settle(&e, true, &outlying);
    }
    if (status == GONIO_OK) {
        status = score_readings(&e, model, column, score);
    }
    gonio_i_fit_end(&e);
    return status;
}

/* By the likeliest model. */
static gonio_status score_column(gonio_context *context, const gonio_i_prior *prior,
                                 gonio_i_column *column, double *score)
{
    gonio_i_prior plain = *prior;
    gonio_status status = GONIO_OK;
    plain.samples = 0;
    *score = -INFINITY;
    column->count = gonio_i_thin(column, GONIO_I_SUBSET_READINGS, column->observation);
    for (int k = 0; k < MODELS_COUNT && status == GONIO_OK; k++) {
        double mine = 0.0;
        status = score_model(context, &plain, &MODELS[k], column, &mine);
        *score = fmax(*score, mine);
    }
    return status;
}

/* What is looked at. */
typedef struct search {
    gonio_context *context;
    const gonio_i_prior *prior;
    const gonio_readings *readings;
    const gonio_i_noise *noise;
    size_t columns;
    double *dark;  /* [columns] */
    double *score; /* [columns][LEVELS] */
} search;

static double scale_of(const search *s, size_t column)
{
    return gonio_readings_scale(s->readings, column);
}

/* Scores all columns with one level. Beforehand, a level is the likelier the lower it is: readings
 * that are all zero fit any that is high enough. */
static gonio_status try_level(search *s, int k)
{
    gonio_i_columns columns = {0};
    for (size_t c = 0; c < s->columns; c++) {
        s->dark[c] = level(k) * scale_of(s, c);
    }
    gonio_status status = gonio_i_dark_level_apply(s->context, &s->prior->view, s->readings,
                                                   s->noise, s->dark, &columns);
    for (size_t c = 0; c < s->columns && status == GONIO_OK; c++) {
        double *score = &s->score[c * LEVELS + (size_t)k];
        status = score_column(s->context, s->prior, &columns.column[c], score);
        *score -= level(k);
    }
    gonio_i_columns_free(&columns);
    return status == GONIO_OK
               ? gonio_i_progress(s->context, "looking for a dark level", (k + 1.0) / LEVELS)
               : status;
}

/* The mean over the levels by their likelihood; adds to `gain` how much likelier the best one is
 * than none. */
static double mean_level(const double score[LEVELS], double *gain)
{
    double best = score[0];
    double sum = 0.0;
    double mean = 0.0;
    for (int k = 0; k < LEVELS; k++) {
        best = fmax(best, score[k]);
    }
    for (int k = 0; k < LEVELS; k++) {
        const double weight = exp(score[k] - best);
        sum += weight;
        mean += weight * level(k);
    }
    *gain += best - score[0];
    return mean / sum;
}

/* Sets s->dark. */
static gonio_status find(search *s, bool *found)
{
    double gain = 0.0;
    gonio_status status = GONIO_OK;
    for (int k = 0; k < LEVELS && status == GONIO_OK; k++) {
        status = try_level(s, k);
    }
    for (size_t c = 0; c < s->columns && status == GONIO_OK; c++) {
        s->dark[c] = mean_level(&s->score[c * LEVELS], &gain) * scale_of(s, c);
    }
    *found = status == GONIO_OK && gain > CONVINCING * sqrt((double)s->columns / GONIO_CHANNELS);
    return status;
}

static bool has_zeros(const gonio_i_columns *columns)
{
    for (size_t k = 0; k < columns->count; k++) {
        for (size_t i = 0; i < columns->column[k].count; i++) {
            if (columns->column[k].observation[i].bound < 0) {
                return true;
            }
        }
    }
    return false;
}

gonio_status gonio_i_dark_level_find(gonio_context *context, const gonio_i_prior *prior,
                                     const gonio_readings *readings, const gonio_i_noise *noise,
                                     const gonio_i_columns *columns, double **dark)
{
    bool found = false;
    search s = {.context = context,
                .prior = prior,
                .readings = readings,
                .noise = noise,
                .columns = columns->count};
    *dark = NULL;
    if (prior->view.channels == GONIO_JOINT || !has_zeros(columns)) {
        return GONIO_OK;
    }
    s.dark = gonio_i_allocate(context, s.columns, sizeof *s.dark);
    s.score = gonio_i_allocate(context, s.columns * LEVELS, sizeof *s.score);
    const gonio_status status =
        s.dark == NULL || s.score == NULL ? GONIO_ERROR_MEMORY : find(&s, &found);
    if (found) {
        *dark = s.dark;
    } else {
        free(s.dark);
    }
    free(s.score);
    return status;
}

gonio_status gonio_i_dark_level_apply(gonio_context *context, const gonio_basis_view *view,
                                      const gonio_readings *readings, const gonio_i_noise *noise,
                                      const double *dark, gonio_i_columns *columns)
{
    const gonio_i_transform transform = {.factor = 1.0, .dark = dark};
    if (dark == NULL) {
        return GONIO_OK;
    }
    gonio_i_columns_free(columns);
    return gonio_i_columns_create(context, view, readings, noise, &transform, columns);
}
