/* Directions that were read wrongly: see wrong_directions.h. */
#include "wrong_directions.h"

#include <math.h>
#include <stdlib.h>

#include "parallel_for.h"

/* Remainders that an unknown kind of material may have: smooth ones, and with narrow peaks;
 * those towards the light where it was read near it. */
static const struct remainder {
    double alpha, peak, retro;
} REMAINDERS[] = {{0.03, 0.0, 0.0}, {0.12, 0.0, 0.0}, {0.5, 0.0, 0.0}, {0.12, 8.0, 0.0},
                  {0.5, 8.0, 0.0},  {0.25, 0.0, 8.0}, {0.5, 0.0, 8.0}};

/* Directions that are as far off as this, in deviations, may be left out; this many of the worst
 * are tried. */
static const double SUSPECT = 1.5;

enum { SUSPECTS = 6, MODELS = sizeof REMAINDERS / sizeof *REMAINDERS };

/* A variance, in squares of log units: far more than any mistake has. */
static const double HARDLY_A_SAY = 1e3;

/* Mistakes are gross: a factor of more than three, in log units. */
static const double GROSS = 1.2;

/* If more of the directions than this seem wrong, and one, it is the material that is unusual. */
static const double MOST_WRONG = 0.1;

/* What leaving out a direction has to explain, in ln of the density of three columns. Right
 * readings of unusual materials explain up to 23 (docs/experiments.md). */
static const double DUE = 23.0;

/* Fewer directions than this know less of each other, and more is asked of them. */
static const double ENOUGH = 40.0;

/* Fewer directions have too few others to be judged by. */
enum { FEW = 5 };

/* A direction, in all columns of the subset. */
typedef struct direction {
    gonio_half_difference at;
    size_t readings;
    bool wrong;
    double off; /* mean square of the readings' differences to what the others say, in deviations */
    double gap; /* the same in log units */
} direction;

typedef struct direction_search {
    gonio_context *context;
    const gonio_i_subset *subset;
    gonio_i_fit column[GONIO_I_SUBSET_COLUMNS];
    double *score[GONIO_I_SUBSET_COLUMNS];  /* [MODELS][n]: scratch */
    size_t *number[GONIO_I_SUBSET_COLUMNS]; /* of each reading's direction */
    size_t directions;
    direction *direction; /* [directions] */
} direction_search;

static bool same(const gonio_half_difference *a, const gonio_half_difference *b)
{
    return a->theta_h == b->theta_h && a->theta_d == b->theta_d && a->phi_d == b->phi_d;
}

/* The number of a reading's direction; a new one if it was not met before. */
static size_t number_of(direction_search *d, const gonio_half_difference *at)
{
    size_t k = 0;
    while (k < d->directions && !same(&d->direction[k].at, at)) {
        k++;
    }
    if (k == d->directions) {
        d->direction[d->directions++].at = *at;
    }
    d->direction[k].readings++;
    return k;
}

static gonio_status number_directions(direction_search *d)
{
    size_t readings = 0;
    for (size_t c = 0; c < d->subset->count; c++) {
        readings += d->subset->column[c].count;
    }
    d->direction = gonio_i_allocate(d->context, readings, sizeof *d->direction);
    bool done = d->direction != NULL;
    for (size_t c = 0; c < d->subset->count && done; c++) {
        const gonio_i_column *column = &d->subset->column[c];
        d->number[c] = gonio_i_allocate(d->context, column->count, sizeof *d->number[c]);
        done = d->number[c] != NULL;
        for (size_t i = 0; i < column->count && done; i++) {
            d->number[c][i] = number_of(d, &column->observation[i].at);
        }
    }
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status begin_column(void *data, gonio_context *context, size_t c)
{
    direction_search *d = data;
    gonio_i_fit *e = &d->column[c];
    size_t outlying = 0;
    gonio_status status =
        gonio_i_fit_begin(context, d->subset->sites[c], false, &d->subset->column[c], e);
    if (status == GONIO_OK) {
        e->context = d->context; /* it outlives this call */
        d->score[c] = gonio_i_allocate(context, MODELS * e->n, sizeof *d->score[c]);
        status = d->score[c] == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    }
    if (status == GONIO_OK) {
        status = gonio_i_fit_solve(e, &GONIO_I_SETTLING);
    }
    return status == GONIO_OK ? gonio_i_fit_settle(e, false, &outlying) : status;
}

static gonio_status begin(direction_search *d)
{
    gonio_i_steps steps = {.task = NULL};
    const gonio_status status = number_directions(d);
    return status == GONIO_OK
               ? gonio_i_parallel_for(d->context, &steps, d->subset->count, begin_column, d)
               : status;
}

static void end(direction_search *d)
{
    for (size_t c = 0; c < d->subset->count; c++) {
        gonio_i_fit_end(&d->column[c]);
        free(d->score[c]);
        free(d->number[c]);
    }
    free(d->direction);
}

/* Takes a direction out, or back in. */
static void leave_out(direction_search *d, size_t number, bool out)
{
    d->direction[number].wrong = out;
    for (size_t c = 0; c < d->subset->count; c++) {
        gonio_i_fit *e = &d->column[c];
        for (size_t i = 0; i < e->n; i++) {
            if (d->number[c][i] == number) {
                e->variance[i] = out ? HARDLY_A_SAY : d->subset->column[c].observation[i].variance;
            }
        }
    }
}

static gonio_i_model model_of(const direction_search *d, size_t column, size_t k)
{
    return (gonio_i_model){gonio_i_kernel_width(d->subset->readings[column]), REMAINDERS[k].alpha,
                           REMAINDERS[k].peak, REMAINDERS[k].retro};
}

static gonio_status score_column(void *data, gonio_context *context, size_t c)
{
    (void)context;
    direction_search *d = data;
    gonio_i_fit *e = &d->column[c];
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < MODELS && status == GONIO_OK; k++) {
        const gonio_i_model model = model_of(d, c, k);
        status = gonio_i_leave_one_out_score(e, &model, d->score[c] + k * e->n);
    }
    return status;
}

/* How well the readings explain each other by model k: reading by reading, in order. */
static double score_of(const direction_search *d, size_t k)
{
    double sum = -GONIO_I_FOR_REMAINDERS * log(REMAINDERS[k].alpha / REMAINDERS[0].alpha) -
                 (REMAINDERS[k].retro > 0.0 ? GONIO_I_FOR_RETRO : 0.0);
    for (size_t c = 0; c < d->subset->count; c++) {
        const size_t n = d->column[c].n;
        for (size_t i = 0; i < n; i++) {
            sum += d->score[c][k * n + i];
        }
    }
    return sum;
}

/* How well the readings explain each other, with the remainder that they like best: that of model
 * `best`. */
static gonio_status score(direction_search *d, double *value, size_t *best)
{
    gonio_i_steps steps = {.task = NULL};
    const gonio_status status =
        gonio_i_parallel_for(d->context, &steps, d->subset->count, score_column, d);
    *value = -INFINITY;
    for (size_t k = 0; k < MODELS && status == GONIO_OK; k++) {
        const double sum = score_of(d, k);
        *best = sum > *value ? k : *best;
        *value = fmax(*value, sum);
    }
    return status;
}

static gonio_status add_off(direction_search *d, size_t c, const gonio_i_model *model)
{
    gonio_i_fit *e = &d->column[c];
    double *difference = NULL;
    const gonio_status status = gonio_i_leave_one_out_differences(e, model, &difference);
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        direction *at = &d->direction[d->number[c][i]];
        const double square = difference[i] * difference[i] / (double)at->readings;
        at->off += square / difference[e->n + i];
        at->gap += square;
    }
    free(difference);
    return status;
}

/* How far each direction is off by a model. */
static gonio_status find_off(direction_search *d, size_t k)
{
    gonio_status status = GONIO_OK;
    for (size_t j = 0; j < d->directions; j++) {
        d->direction[j].off = 0.0;
        d->direction[j].gap = 0.0;
    }
    for (size_t c = 0; c < d->subset->count && status == GONIO_OK; c++) {
        const gonio_i_model model = model_of(d, c, k);
        status = add_off(d, c, &model);
    }
    return status;
}

/* The direction that is off most, and taken off the list; or as many as there are, for none. */
static size_t next_suspect(direction_search *d)
{
    size_t worst = d->directions;
    double most = SUSPECT * SUSPECT;
    for (size_t j = 0; j < d->directions; j++) {
        const direction *at = &d->direction[j];
        if (!at->wrong && at->gap > GROSS * GROSS && at->off > most) {
            most = at->off;
            worst = j;
        }
    }
    if (worst < d->directions) {
        d->direction[worst].off = 0.0;
    }
    return worst;
}

/* Of the suspects the one without which the others explain each other best. */
static gonio_status try_suspects(direction_search *d, size_t *suspect, double *value, size_t *model)
{
    gonio_status status = GONIO_OK;
    *suspect = d->directions;
    *value = -INFINITY;
    for (int k = 0; k < SUSPECTS && status == GONIO_OK; k++) {
        const size_t number = next_suspect(d);
        if (number == d->directions) {
            break;
        }
        double without = 0.0;
        size_t best = 0;
        status = gonio_i_progress(d->context, "reconstructing", 0.0);
        leave_out(d, number, true);
        if (status == GONIO_OK) {
            status = score(d, &without, &best);
        }
        leave_out(d, number, false);
        if (status == GONIO_OK && without > *value) {
            *value = without;
            *suspect = number;
            *model = best;
        }
    }
    return status;
}

/* More columns than three say the same again. */
static double due(const direction_search *d, const direction *at)
{
    const double fewer = fmax(ENOUGH / (double)d->directions, 1.0);
    return DUE * sqrt(fewer) * (double)at->readings / GONIO_CHANNELS;
}

/* One after the other, until none is worth it. found: how many. */
static gonio_status find_wrong(direction_search *d, size_t *found)
{
    const size_t most = 1 + (size_t)(MOST_WRONG * (double)d->directions);
    double value = 0.0;
    size_t model = 0;
    bool more = true;
    gonio_status status = score(d, &value, &model);
    while (more && *found <= most && status == GONIO_OK) {
        size_t suspect = 0;
        size_t then = 0;
        double without = 0.0;
        status = find_off(d, model);
        if (status == GONIO_OK) {
            status = try_suspects(d, &suspect, &without, &then);
        }
        more = status == GONIO_OK && suspect < d->directions &&
               without - value > due(d, &d->direction[suspect]);
        if (more) {
            leave_out(d, suspect, true);
            value = without;
            model = then;
            (*found)++;
        }
    }
    *found = *found > most ? 0 : *found;
    return status;
}

/* Leaves a column's readings of wrong directions hardly a say; how many there are. */
static size_t widen(const direction_search *d, gonio_i_column *column)
{
    size_t count = 0;
    for (size_t i = 0; i < column->count; i++) {
        for (size_t j = 0; j < d->directions; j++) {
            const direction *at = &d->direction[j];
            if (at->wrong && same(&at->at, &column->observation[i].at)) {
                column->observation[i].variance = HARDLY_A_SAY;
                column->observation[i].wrong = true;
                count++;
            }
        }
    }
    return count;
}

gonio_status gonio_i_wrong_directions_find(gonio_context *context, const gonio_i_subset *subset,
                                           gonio_i_column *columns, size_t count, size_t *wrong)
{
    direction_search d = {.context = context, .subset = subset};
    size_t found = 0;
    gonio_status status = begin(&d);
    if (status == GONIO_OK && d.directions >= FEW) {
        status = find_wrong(&d, &found);
    }
    *wrong = 0;
    for (size_t k = 0; k < count && found > 0 && status == GONIO_OK; k++) {
        *wrong += widen(&d, &columns[k]);
    }
    end(&d);
    return status;
}
