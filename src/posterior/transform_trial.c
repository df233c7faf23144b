/* The trial of a transform of readings: see transform_trial.h. */
#include "transform_trial.h"

#include <math.h>
#include <stdlib.h>

#include "albedo.h"
#include "leave_one_out.h"
#include "parallel_for.h"

/* alpha and peak of the remainder, from usual to most unusual materials. */
static const struct remainder {
    double alpha;
    double peak;
} MODELS[] = {{0.03, 0.0}, {0.12, 0.0}, {0.25, 8.0}, {0.5, 8.0}, {1.0, 8.0}};

enum { MODELS_COUNT = sizeof MODELS / sizeof *MODELS, MOST_TRIED = 64 };

/* What a reading counts at most, in ln of its density. */
static const double MOST_OF_A_READING = 3.0;

static gonio_i_model model_of(const gonio_i_column *column, int model)
{
    return (gonio_i_model){gonio_i_kernel_width(column->count), MODELS[model].alpha,
                           MODELS[model].peak, 0.0};
}

gonio_status gonio_i_transform_trial_begin(gonio_context *context, const gonio_i_prior *prior,
                                           const gonio_readings *readings,
                                           const gonio_i_noise *noise,
                                           const gonio_i_columns *columns,
                                           gonio_i_transform_trial *t)
{
    const size_t tried =
        columns->count < GONIO_I_TRIAL_COLUMNS ? columns->count : GONIO_I_TRIAL_COLUMNS;
    gonio_status status = GONIO_OK;
    *t = (gonio_i_transform_trial){
        .context = context, .prior = prior, .readings = readings, .noise = noise};
    for (size_t k = 0; k < tried && status == GONIO_OK; k++) {
        const size_t channel = k * columns->count / tried;
        if (columns->column[channel].count > 0) {
            status = gonio_i_thin_copy(context, &columns->column[channel], MOST_TRIED,
                                       &t->column[t->count]);
            t->channel[t->count++] = channel;
        }
    }
    return status == GONIO_OK ? gonio_i_sites_share(context, prior, t->column, t->count, t->sites)
                              : status;
}

void gonio_i_transform_trial_end(gonio_i_transform_trial *t)
{
    gonio_i_sites_release(t->sites, t->count);
    for (size_t k = 0; k < t->count; k++) {
        free(t->column[k].observation);
    }
    *t = (gonio_i_transform_trial){0};
}

bool gonio_i_transform_trial_is_possible(const gonio_i_transform_trial *t,
                                         const gonio_i_transform *transform)
{
    const gonio_readings_view *view = gonio_readings_describe(t->readings);
    for (size_t k = 0; k < view->count && transform->change != NULL; k++) {
        const gonio_pair changed = transform->change(view->pair[k]);
        const double largest = fmax(changed.incident.theta, changed.outgoing.theta);
        const double least = fmin(changed.incident.theta, changed.outgoing.theta);
        if (!(largest < M_PI / 2.0 && least >= 0.0)) {
            return false;
        }
    }
    return true;
}

/* Sets the columns to a transform, and makes its sites; those of the trial where no direction
 * changes. To be released with release_sites. */
static gonio_status take(gonio_i_transform_trial *t, const gonio_i_transform *transform,
                         gonio_i_sites *sites[GONIO_I_TRIAL_COLUMNS])
{
    for (size_t k = 0; k < t->count; k++) {
        sites[k] = transform->change == NULL ? t->sites[k] : NULL;
        gonio_i_column_transform(t->readings, t->noise, transform, &t->column[k]);
    }
    return transform->change == NULL
               ? GONIO_OK
               : gonio_i_sites_share(t->context, t->prior, t->column, t->count, sites);
}

static void release_sites(const gonio_i_transform_trial *t, const gonio_i_transform *transform,
                          gonio_i_sites *sites[GONIO_I_TRIAL_COLUMNS])
{
    if (transform->change != NULL) {
        gonio_i_sites_release(sites, t->count);
    }
}

/* Every column under every model. */
typedef struct scoring {
    const gonio_i_transform_trial *t;
    const gonio_i_transform *transform;
    gonio_i_sites *const *sites;
    size_t readings;
    double *score; /* [columns][MODELS][readings] */
} scoring;

static gonio_status score_model(const scoring *s, gonio_i_fit *e, size_t column, int k,
                                double *score)
{
    const gonio_i_column *tried = &s->t->column[column];
    const gonio_i_model model = model_of(tried, k);
    double *to = s->score + (column * MODELS_COUNT + (size_t)k) * s->readings;
    size_t outlying = 0;
    gonio_i_fit_read(e, tried);
    gonio_status status = gonio_i_fit_solve(e, &model);
    if (status == GONIO_OK) {
        status = gonio_i_fit_settle(e, false, &outlying);
    }
    if (status == GONIO_OK) {
        status = gonio_i_leave_one_out_score(e, &model, score);
    }
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        const gonio_i_observation *o = &tried->observation[i];
        to[o->reading] =
            o->bound != 0 ? 0.0
                          : score[i] + gonio_i_transform_slope(s->t->readings, o->reading,
                                                               s->t->channel[column], s->transform);
    }
    return status;
}

static gonio_status score_column(void *data, gonio_context *context, size_t column)
{
    const scoring *s = data;
    const gonio_i_column *tried = &s->t->column[column];
    gonio_i_fit e = {0};
    double *score = gonio_i_allocate(context, tried->count, sizeof *score);
    gonio_status status = score == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = gonio_i_fit_begin(context, s->sites[column], false, tried, &e);
    }
    for (int k = 0; k < MODELS_COUNT && status == GONIO_OK; k++) {
        status = score_model(s, &e, column, k, score);
    }
    gonio_i_fit_end(&e);
    free(score);
    return status;
}

/* The mean over the columns of a reading's scores that are known. */
static double mean_score(const scoring *s, int k, size_t reading)
{
    double sum = 0.0;
    size_t known = 0;
    for (size_t c = 0; c < s->t->count; c++) {
        const double score = s->score[(c * MODELS_COUNT + (size_t)k) * s->readings + reading];
        sum += score;
        known += score != 0.0;
    }
    return known > 0 ? sum / (double)known : 0.0;
}

static void choose_model(const scoring *s, gonio_i_verdict *v)
{
    v->sum = -INFINITY;
    for (int k = 0; k < MODELS_COUNT; k++) {
        double sum = 0.0;
        for (size_t i = 0; i < s->readings; i++) {
            sum += mean_score(s, k, i);
        }
        if (sum > v->sum) {
            v->sum = sum;
            v->model = k;
        }
    }
    for (size_t i = 0; i < s->readings; i++) {
        v->score[i] = mean_score(s, v->model, i);
    }
}

gonio_status gonio_i_transform_trial_judge(gonio_i_transform_trial *t,
                                           const gonio_i_transform *transform, gonio_i_verdict *v)
{
    gonio_i_sites *sites[GONIO_I_TRIAL_COLUMNS] = {NULL};
    gonio_i_steps steps = {.task = NULL};
    scoring s = {.t = t,
                 .transform = transform,
                 .sites = sites,
                 .readings = gonio_readings_describe(t->readings)->count};
    *v = (gonio_i_verdict){.score = gonio_i_allocate(t->context, s.readings, sizeof *v->score)};
    s.score = gonio_i_allocate(t->context, t->count * MODELS_COUNT * s.readings, sizeof *s.score);
    gonio_status status =
        v->score == NULL || s.score == NULL ? GONIO_ERROR_MEMORY : take(t, transform, sites);
    if (status == GONIO_OK) {
        status = gonio_i_parallel_for(t->context, &steps, t->count, score_column, &s);
    }
    if (status == GONIO_OK) {
        choose_model(&s, v);
    }
    release_sites(t, transform, sites);
    free(s.score);
    return status;
}

/* ---- albedos ---- */

static gonio_status find_albedo(const gonio_i_transform_trial *t,
                                const gonio_i_hemisphere *hemisphere, const gonio_i_sites *sites,
                                size_t column, int k, double *albedo)
{
    const gonio_i_model model = model_of(&t->column[column], k);
    double of[GONIO_I_ALBEDO_INCIDENCES] = {0.0};
    size_t outlying = 0;
    gonio_i_fit e;
    gonio_status status = gonio_i_fit_begin(t->context, sites, false, &t->column[column], &e);
    if (status == GONIO_OK) {
        status = gonio_i_fit_solve(&e, &model);
    }
    if (status == GONIO_OK) {
        status = gonio_i_fit_settle(&e, true, &outlying);
    }
    if (status == GONIO_OK) {
        const double s = gonio_readings_scale(t->readings, t->channel[column]);
        status = gonio_i_fit_albedo(&e, hemisphere, s, of);
    }
    *albedo = 0.0;
    for (int n = 0; n < GONIO_I_ALBEDO_INCIDENCES; n++) {
        *albedo += of[n] / (double)GONIO_I_ALBEDO_INCIDENCES;
    }
    gonio_i_fit_end(&e);
    return status;
}

gonio_status gonio_i_transform_trial_albedo(gonio_i_transform_trial *t,
                                            const gonio_i_transform *transform,
                                            const gonio_i_verdict *verdict, double *largest,
                                            double *mean)
{
    gonio_i_sites *sites[GONIO_I_TRIAL_COLUMNS] = {NULL};
    gonio_i_hemisphere hemisphere;
    gonio_status status = gonio_i_hemisphere_create(t->context, t->prior, &hemisphere);
    if (status == GONIO_OK) {
        status = take(t, transform, sites);
    }
    *largest = 0.0;
    *mean = 0.0;
    for (size_t k = 0; k < t->count && status == GONIO_OK; k++) {
        double albedo = 0.0;
        status = find_albedo(t, &hemisphere, sites[k], k, verdict->model, &albedo);
        *largest = fmax(*largest, albedo);
        *mean += albedo / (double)t->count;
    }
    release_sites(t, transform, sites);
    gonio_i_hemisphere_release(&hemisphere);
    return status;
}

double gonio_i_transform_trial_margin(const gonio_i_transform_trial *t,
                                      const gonio_i_verdict *verdict, const gonio_i_verdict *other)
{
    double sum = 0.0;
    for (size_t i = 0; i < gonio_readings_describe(t->readings)->count; i++) {
        const double more = verdict->score[i] - other->score[i];
        sum += fmax(-MOST_OF_A_READING, fmin(more, MOST_OF_A_READING));
    }
    return sum;
}
