/* Readings of nothing: see unmeasured.h. */
#include "unmeasured.h"

#include <math.h>
#include <stdlib.h>

#include "leave_one_out.h"

/* A reading is a suspect if it is zero, or this far below the median of its channel and either a
 * floor or at a direction that instruments hide. Other values were measured, however low: where a
 * retroreflector has no mirror direction, say. */
static const double DIM = 0.2;

/* Instruments hide directions this near to the light, and lose light from this theta on, radians.
 */
static const double NEAR_LIGHT = 10.0 * M_PI / 180.0;
static const double GRAZING = 79.5 * M_PI / 180.0;

/* A floor is a power of ten, to this in its logarithm, or the smallest value if it occurs twice. */
static const double EXACT = 1e-9;

/* A suspect is none if the prediction, less this number of deviations, is this many times the
 * value, and a few s more: less may be what a dark level leaves. */
static const double DEVIATIONS = 3.0;
static const double FAR_BELOW = 5.0;
static const double CLEAR = 4.0; /* in units of s / cos theta_i, as a dark level is */

/* More of the readings are not taken for unmeasured. */
static const double MOST = 0.3;

enum {
    COLUMNS = 3,
    SUSPECTS = 96, /* that are judged in a column, by this many others: */
    OTHERS = 128,
    FEW = 8 /* readings of which none is left out */
};

/* A remainder that does not trust the database. */
static const gonio_i_model MODEL = {GONIO_I_KERNEL_WIDTH, 0.25, 8.0, 0.0};

typedef struct search {
    gonio_context *context;
    const gonio_i_prior *prior;
    const gonio_readings *readings;
    const gonio_i_columns *columns;
    size_t count;     /* of readings */
    bool *suspect;    /* [count]: in all channels */
    bool *unmeasured; /* [count] */
    double *sorted;   /* [count]: scratch */
} search;

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* What is known of the values of a channel that are above zero. */
typedef struct channel_values {
    double median;   /* 0 if there is none */
    double repeated; /* the smallest if it occurs twice, otherwise 0 */
} channel_values;

static channel_values values_of(const search *s, size_t channel)
{
    size_t count = 0;
    for (size_t k = 0; k < s->count; k++) {
        const double value = gonio_readings_value(s->readings, k, channel);
        if (value > 0.0) { /* not for NaN */
            s->sorted[count++] = value;
        }
    }
    qsort(s->sorted, count, sizeof *s->sorted, compare_numbers);
    return (channel_values){count > 0 ? s->sorted[count / 2] : 0.0,
                            count > 1 && s->sorted[1] <= s->sorted[0] ? s->sorted[0] : 0.0};
}

static bool is_floor(double value, const channel_values *channel)
{
    const double power = log10(value);
    const bool smallest = channel->repeated > 0.0 && value <= channel->repeated;
    return smallest || fabs(power - round(power)) < EXACT;
}

/* The angle between light and view is 2 theta_d. */
static bool is_hidden(gonio_pair pair)
{
    return 2.0 * gonio_half_difference_from_pair(pair).theta_d < NEAR_LIGHT ||
           fmax(pair.incident.theta, pair.outgoing.theta) > GRAZING;
}

static bool is_suspect(const search *s, size_t reading, double value, const channel_values *channel)
{
    const gonio_pair pair = gonio_readings_describe(s->readings)->pair[reading];
    return !(value > 0.0) ||
           (value <= DIM * channel->median && (is_floor(value, channel) || is_hidden(pair)));
}

/* Suspects are so in every channel in which they were read. Returns how many there are. */
static size_t find_suspects(const search *s)
{
    size_t suspects = 0;
    for (size_t k = 0; k < s->count; k++) {
        s->suspect[k] = true;
    }
    for (size_t c = 0; c < s->columns->count; c++) {
        const channel_values channel = values_of(s, c);
        for (size_t k = 0; k < s->count; k++) {
            const double value = gonio_readings_value(s->readings, k, c);
            s->suspect[k] = s->suspect[k] && is_suspect(s, k, value, &channel);
        }
    }
    for (size_t k = 0; k < s->count; k++) {
        suspects += s->suspect[k];
    }
    return suspects;
}

/* Some of the suspects of a column, or of the others, evenly spaced. */
static void thin(const search *s, const gonio_i_column *all, bool suspects, size_t most,
                 gonio_i_column *to)
{
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++) {
        count += s->suspect[all->observation[i].reading] == suspects;
    }
    const size_t wanted = count < most ? count : most;
    size_t met = 0;
    size_t taken = 0;
    for (size_t i = 0; i < all->count; i++) {
        const gonio_i_observation *o = &all->observation[i];
        if (s->suspect[o->reading] == suspects) {
            if (taken < wanted && met * wanted >= taken * count) {
                to->observation[to->count++] = *o;
                taken++;
            }
            met++;
        }
    }
}

/* A suspect has no weight, so that its difference is that to what the others predict. */
static gonio_status judge(const search *s, gonio_i_fit *e, const gonio_i_column *column)
{
    const gonio_readings_view *view = gonio_readings_describe(s->readings);
    double *difference = NULL;
    gonio_status status = gonio_i_leave_one_out_differences(e, &MODEL, &difference);
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        const gonio_i_observation *o = &column->observation[i];
        if (s->suspect[o->reading]) {
            const double unknown = difference[e->n + i] - gonio_i_fit_noise(e, i);
            const double predicted = o->g - difference[i];
            const double least = predicted - DEVIATIONS * sqrt(fmax(unknown, 0.0));
            const double cosine = fmax(cos(view->pair[o->reading].incident.theta), 1e-3);
            const bool is_below = least > log1p(FAR_BELOW * expm1(o->g) + CLEAR / cosine);
            s->unmeasured[o->reading] = s->unmeasured[o->reading] || is_below;
        }
    }
    free(difference);
    return status;
}

static gonio_status judge_column(const search *s, const gonio_i_column *all)
{
    gonio_i_column column = {0};
    gonio_i_sites *sites = NULL;
    gonio_i_fit e = {0};
    column.observation =
        gonio_i_allocate(s->context, SUSPECTS + OTHERS, sizeof *column.observation);
    if (column.observation == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    thin(s, all, true, SUSPECTS, &column);
    const size_t suspects = column.count;
    thin(s, all, false, OTHERS, &column);
    gonio_status status = column.count > suspects && suspects > 0
                              ? gonio_i_sites_create(s->context, s->prior, &column, &sites)
                              : GONIO_OK;
    if (sites != NULL && status == GONIO_OK) {
        status = gonio_i_fit_begin(s->context, sites, false, &column, &e);
    }
    for (size_t i = 0; i < suspects && status == GONIO_OK && sites != NULL; i++) {
        e.left_out[i] = true;
    }
    if (sites != NULL && status == GONIO_OK) {
        status = judge(s, &e, &column);
    }
    gonio_i_fit_end(&e);
    gonio_i_sites_free(&sites);
    free(column.observation);
    return status;
}

static gonio_status judge_columns(const search *s)
{
    const size_t columns = s->columns->count < COLUMNS ? s->columns->count : COLUMNS;
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < columns && status == GONIO_OK; k++) {
        status = judge_column(s, &s->columns->column[k * s->columns->count / columns]);
    }
    return status;
}

static void leave_out(const search *s, gonio_i_columns *columns, gonio_interpretation *found)
{
    const size_t *line = gonio_readings_describe(s->readings)->line;
    for (size_t k = 0; k < s->count; k++) {
        if (s->unmeasured[k]) {
            if (found->unmeasured < GONIO_MOST_UNMEASURED_LINES) {
                found->unmeasured_line[found->unmeasured] = line[k];
            }
            found->unmeasured++;
        }
    }
    for (size_t c = 0; c < columns->count; c++) {
        gonio_i_column *column = &columns->column[c];
        size_t kept = 0;
        for (size_t i = 0; i < column->count; i++) {
            if (!s->unmeasured[column->observation[i].reading]) {
                column->observation[kept++] = column->observation[i];
            }
        }
        column->count = kept;
    }
}

static size_t count_unmeasured(const search *s)
{
    size_t count = 0;
    for (size_t k = 0; k < s->count; k++) {
        count += s->unmeasured[k];
    }
    return count;
}

gonio_status gonio_i_unmeasured_leave_out(gonio_context *context, const gonio_i_prior *prior,
                                          const gonio_readings *readings, gonio_i_columns *columns,
                                          gonio_interpretation *interpretation)
{
    search s = {.context = context,
                .prior = prior,
                .readings = readings,
                .columns = columns,
                .count = gonio_readings_describe(readings)->count};
    if (prior->view->channels == GONIO_JOINT || s.count < FEW) {
        return GONIO_OK;
    }
    s.suspect = gonio_i_allocate(context, s.count, sizeof *s.suspect);
    s.unmeasured = gonio_i_allocate(context, s.count, sizeof *s.unmeasured);
    s.sorted = gonio_i_allocate(context, s.count, sizeof *s.sorted);
    const bool done = s.suspect != NULL && s.unmeasured != NULL && s.sorted != NULL;
    gonio_status status = done ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK && find_suspects(&s) > 0) {
        status = judge_columns(&s);
    }
    if (status == GONIO_OK && (double)count_unmeasured(&s) <= MOST * (double)s.count) {
        leave_out(&s, columns, interpretation);
    }
    free(s.suspect);
    free(s.unmeasured);
    free(s.sorted);
    return status;
}
