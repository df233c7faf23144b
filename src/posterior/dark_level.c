/* The dark level: see dark_level.h.
 *
 * Candidate levels are compared by leave-one-out likelihood: the density of readings above zero,
 * per 1/sr, and the probability of zeros. The likelihood is the largest over models of usual and of
 * unusual materials. Plain Gaussians are sufficient. */
#include "dark_level.h"

#include <math.h>
#include <stdlib.h>

#include "parallel_for.h"
#include "leave_one_out.h"

/* Levels in units of s, 2^(1/2) apart, and none. The smallest has no effect; the largest makes an
 * instrument useless. */
static const double LEAST_LEVEL = 0.125;

enum { LEVELS = 14 };

static double level(int k)
{
    return k == 0 ? 0.0 : LEAST_LEVEL * pow(2.0, 0.5 * (k - 1));
}

/* The gain in log likelihood from which levels are accepted, for three channels and a few readings.
 * Further channels are not independent, so it grows with the square root of their number. The
 * leave-one-out errors of a material unlike the database are those of its model. They are common to
 * neighbouring readings, so it grows with the number of readings. Readings without a dark level
 * have a gain below 1 if the database resembles the material, and up to 5 for 20 readings if it
 * does not (docs/experiments.md). */
static const double CONVINCING = 8.0;
static const double FEW = 20.0;

/* How much worse than none a level on the way to the best may be. */
static const double TOLERANCE = 2.0;

/* alpha of the models, from a usual material to the most unusual one. */
static const gonio_i_model MODELS[] = {
    {1.0, 0.12, 0.0, 0.0}, {1.0, 0.25, 8.0, 0.0}, {1.0, 0.5, 8.0, 0.0}};

enum { MODELS_COUNT = sizeof MODELS / sizeof *MODELS };

/* The probability that a zero has another cause. */
static const double OTHERWISE = 0.03;

/* ln of the probability that a reading is at most its bound, from the leave-one-out prediction. */
static double log_probability(double difference, double variance)
{
    const double below = 0.5 * erfc(-difference / sqrt(2.0 * variance));
    return log((1.0 - OTHERWISE) * below + OTHERWISE);
}

/* The log likelihood of the readings of a column, up to a constant. */
static gonio_status score_readings(gonio_i_fit *e, const gonio_i_model *model,
                                   const gonio_i_column *column, double *score)
{
    double *difference = NULL;
    const gonio_status status = gonio_i_leave_one_out_differences(e, model, &difference);
    *score = 0.0;
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        /* Readings that are left out or set aside are judged like all others. */
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

static gonio_status score_model(gonio_i_fit *e, const gonio_i_model *model,
                                const gonio_i_column *column, double *score)
{
    size_t outlying = 0;
    gonio_i_fit_read(e, column);
    gonio_status status = gonio_i_fit_solve(e, model);
    if (status == GONIO_OK) {
        status = gonio_i_fit_settle(e, true, &outlying);
    }
    return status == GONIO_OK ? score_readings(e, model, column, score) : status;
}

/* The log likelihood under the most likely model. */
static gonio_status score_values(gonio_i_fit *e, const gonio_i_column *column, double *score)
{
    gonio_status status = GONIO_OK;
    *score = -INFINITY;
    for (int k = 0; k < MODELS_COUNT && status == GONIO_OK; k++) {
        double mine = 0.0;
        status = score_model(e, &MODELS[k], column, &mine);
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
    gonio_i_column *thinned; /* [columns] */
    size_t *group;           /* [columns]: columns of the same sites */
    gonio_i_sites *sites;    /* of the group that is at work, */
    size_t *member;          /* whose columns these are: [columns] */
    double *score;           /* [columns][LEVELS] */
    double *dark;            /* [columns] */
} search;

static double scale_of(const search *s, size_t column)
{
    return gonio_readings_scale(s->readings, column);
}

/* The prior of a level falls with the level: readings that are all zero fit any level that is high
 * enough. dark: scratch of [columns]. */
static gonio_status try_levels(const search *s, size_t c, gonio_i_fit *e, double *dark)
{
    gonio_status status = GONIO_OK;
    for (int k = 0; k < LEVELS && status == GONIO_OK; k++) {
        const gonio_i_transform transform = {.factor = 1.0, .dark = dark};
        double *score = &s->score[c * LEVELS + (size_t)k];
        dark[c] = level(k) * scale_of(s, c);
        gonio_i_column_transform(s->readings, s->noise, &transform, &s->thinned[c]);
        status = score_values(e, &s->thinned[c], score);
        *score -= level(k);
    }
    return status;
}

static gonio_status score_column(void *data, gonio_context *context, size_t k)
{
    const search *s = data;
    const size_t c = s->member[k];
    gonio_i_fit e = {0};
    double *dark = gonio_i_allocate(context, s->columns, sizeof *dark);
    gonio_status status = dark == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = gonio_i_fit_begin(context, s->sites, true, &s->thinned[c], &e);
    }
    if (status == GONIO_OK) {
        status = try_levels(s, c, &e, dark);
    }
    gonio_i_fit_end(&e);
    free(dark);
    return status;
}

/* Columns that were read at the same directions, over the same sites. */
static gonio_status score_group(search *s, size_t number, gonio_i_steps *steps)
{
    size_t count = 0;
    for (size_t c = 0; c < s->columns; c++) {
        if (s->group[c] == number) {
            s->member[count++] = c;
        }
    }
    gonio_status status =
        gonio_i_sites_create(s->context, s->prior, &s->thinned[s->member[0]], &s->sites);
    if (status == GONIO_OK) {
        status = gonio_i_parallel_for(s->context, steps, count, score_column, s);
    }
    gonio_i_sites_free(&s->sites);
    return status;
}

static gonio_status score_columns(search *s, const gonio_i_columns *columns)
{
    gonio_i_steps steps = {.task = "looking for a dark level", .all = s->columns};
    gonio_status status = GONIO_OK;
    for (size_t c = 0; c < s->columns && status == GONIO_OK; c++) {
        status = gonio_i_thin_copy(s->context, &columns->column[c], GONIO_I_SUBSET_READINGS,
                                   &s->thinned[c]);
    }
    const size_t groups =
        status == GONIO_OK ? gonio_i_sites_group(s->prior, s->thinned, s->columns, s->group) : 0;
    for (size_t k = 0; k < groups && status == GONIO_OK; k++) {
        status = score_group(s, k, &steps);
    }
    return status;
}

/* The best level. */
static int best_level(const double score[LEVELS])
{
    int best = 0;
    for (int k = 1; k < LEVELS; k++) {
        best = score[k] > score[best] ? k : best;
    }
    return best;
}

/* Half a dark level explains the readings better than none, and so do all that lead to it. Where
 * one on the way is worse, the scores only scatter, as those of unusual materials do. */
static bool is_led_to(const double score[LEVELS], int best)
{
    bool led = true;
    for (int k = 0; k < best; k++) {
        led = led && score[k] > score[0] - TOLERANCE;
    }
    return led;
}

/* The mean over the levels, weighted by their likelihood. Adds the log likelihood ratio of the best
 * level and none to `gain`, and counts the column, if smaller levels lead to the best. */
static double mean_level(const double score[LEVELS], double *gain, size_t *led_to)
{
    const int level_of_best = best_level(score);
    const double best = score[level_of_best];
    double sum = 0.0;
    double mean = 0.0;
    for (int k = 0; k < LEVELS; k++) {
        const double weight = exp(score[k] - best);
        sum += weight;
        mean += weight * level(k);
    }
    if (is_led_to(score, level_of_best)) {
        *gain += best - score[0];
        (*led_to)++;
    }
    return mean / sum;
}

static double convincing(const search *s)
{
    size_t most = 0;
    for (size_t c = 0; c < s->columns; c++) {
        most = s->thinned[c].count > most ? s->thinned[c].count : most;
    }
    return CONVINCING * fmax((double)most / FEW, 1.0) * sqrt((double)s->columns / GONIO_CHANNELS);
}

/* Sets s->dark. */
static gonio_status find(search *s, const gonio_i_columns *columns, bool *found)
{
    double gain = 0.0;
    size_t led_to = 0;
    const gonio_status status = score_columns(s, columns);
    for (size_t c = 0; c < s->columns && status == GONIO_OK; c++) {
        s->dark[c] = mean_level(&s->score[c * LEVELS], &gain, &led_to) * scale_of(s, c);
    }
    *found = status == GONIO_OK && gain > convincing(s) && 2 * led_to >= s->columns;
    return status;
}

static bool allocate(search *s)
{
    s->thinned = gonio_i_allocate(s->context, s->columns, sizeof *s->thinned);
    s->group = gonio_i_allocate(s->context, s->columns, sizeof *s->group);
    s->member = gonio_i_allocate(s->context, s->columns, sizeof *s->member);
    s->score = gonio_i_allocate(s->context, s->columns * LEVELS, sizeof *s->score);
    s->dark = gonio_i_allocate(s->context, s->columns, sizeof *s->dark);
    return s->thinned && s->group && s->member && s->score && s->dark;
}

/* Frees all except the level. */
static void release(search *s)
{
    for (size_t c = 0; s->thinned != NULL && c < s->columns; c++) {
        free(s->thinned[c].observation);
    }
    free(s->thinned);
    free(s->group);
    free(s->member);
    free(s->score);
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
    if (prior->view->channels == GONIO_JOINT || !has_zeros(columns)) {
        return GONIO_OK;
    }
    const gonio_status status = allocate(&s) ? find(&s, columns, &found) : GONIO_ERROR_MEMORY;
    if (found) {
        *dark = s.dark;
    } else {
        free(s.dark);
    }
    release(&s);
    return status;
}
