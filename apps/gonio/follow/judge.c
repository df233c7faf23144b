/* What the readings of a run say so far: see judge.h. */
#include "judge.h"

#include <math.h>
#include <stdlib.h>

/* The readings that count, and the row of each. rows[count] is the caller's. */
static gonio_status read_rows(const judge *j, const run *r, gonio_readings **readings,
                              size_t **rows)
{
    size_t size = 0;
    size_t *line_row = NULL;
    char *text = run_text(r, &size, &line_row);
    gonio_readings_options how = r->how;
    how.average_repeats = true;
    gonio_status status = text == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = gonio_readings_read_text(j->silent, r->path, text, size, &how, readings);
    }
    if (status == GONIO_OK && gonio_basis_describe(j->basis)->channels == GONIO_SEPARATE) {
        status = gonio_readings_drop_empty_channels(j->silent, *readings);
    }
    if (status == GONIO_OK) {
        const gonio_readings_view *view = gonio_readings_describe(*readings);
        *rows = calloc(view->count, sizeof **rows);
        for (size_t k = 0; *rows != NULL && k < view->count; k++) {
            (*rows)[k] = line_row[view->line[k]];
        }
        status = *rows == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    }
    free(line_row);
    free(text);
    return status;
}

static double sum_of(const double *value, size_t count)
{
    double sum = 0.0;
    for (size_t k = 0; k < count; k++) {
        sum += isnan(value[k]) ? 0.0 : value[k];
    }
    return sum;
}

/* A reading over its prediction, all channels together. */
static double ratio_of(const judge *j, const gonio_reconstruction *made,
                       const gonio_readings_view *view, size_t reading)
{
    double *predicted = calloc(made->columns + GONIO_CHANNELS, sizeof *predicted);
    double ratio = NAN;
    if (predicted != NULL &&
        gonio_reconstruction_predict(j->basis, made,
                                     gonio_half_difference_from_pair(view->pair[reading]),
                                     predicted, NULL)) {
        ratio = sum_of(view->value + reading * view->channels, view->channels) /
                sum_of(predicted, view->channels);
    }
    free(predicted);
    return ratio;
}

static gonio_status list_doubts(const judge *j, const gonio_reconstruction *made,
                                const gonio_readings *readings, const size_t *rows,
                                judge_verdict *verdict)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    verdict->doubt = calloc(view->count, sizeof *verdict->doubt);
    if (verdict->doubt == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < view->count && made->contradicted != NULL; k++) {
        if (made->contradicted[k]) {
            verdict->doubt[verdict->doubts++] = (judge_doubt){rows[k], ratio_of(j, made, view, k)};
        }
    }
    return GONIO_OK;
}

/* Only errors that say nothing of the readings end a run. */
static gonio_status survive(gonio_status status)
{
    return status == GONIO_ERROR_MEMORY || status == GONIO_ERROR_CANCELLED ? status : GONIO_OK;
}

gonio_status judge_run(const judge *j, const run *r, judge_verdict *verdict)
{
    gonio_readings *readings = NULL;
    gonio_reconstruction *made = NULL;
    size_t *rows = NULL;
    *verdict = (judge_verdict){.expected = NAN};
    if (j->basis == NULL || run_counted(r) == 0) {
        return GONIO_OK;
    }
    gonio_status status = read_rows(j, r, &readings, &rows);
    if (status == GONIO_OK) {
        status = gonio_reconstruct(j->context, j->basis, readings, &j->how, &made);
    }
    if (status == GONIO_OK) {
        verdict->expected = made->predicted_e6;
        status = list_doubts(j, made, readings, rows, verdict);
    }
    gonio_reconstruction_free(&made);
    gonio_readings_free(&readings);
    free(rows);
    return survive(status);
}

static gonio_status copy_degrees(const gonio_plan *plan, double (**degrees)[4], size_t *count)
{
    const double scale = 180.0 / M_PI;
    *count = plan->count;
    *degrees = calloc(plan->count + 1, sizeof **degrees);
    for (size_t k = 0; *degrees != NULL && k < plan->count; k++) {
        const gonio_pair *pair = &plan->entries[k].pair;
        (*degrees)[k][0] = pair->incident.theta * scale;
        (*degrees)[k][1] = pair->incident.phi * scale;
        (*degrees)[k][2] = pair->outgoing.theta * scale;
        (*degrees)[k][3] = pair->outgoing.phi * scale;
    }
    return *degrees != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

gonio_status judge_plan(const judge *j, const run *r, double (**degrees)[4], size_t *count)
{
    gonio_readings *readings = NULL;
    gonio_plan *plan = NULL;
    size_t *rows = NULL;
    gonio_plan_options what = j->plan;
    what.count = run_unread(r);
    what.target = 0.0;
    *degrees = NULL;
    *count = 0;
    if (what.count == 0) {
        return GONIO_OK;
    }
    gonio_status status = read_rows(j, r, &readings, &rows);
    if (status == GONIO_OK) {
        status = gonio_plan_next(j->context, j->basis, readings, &j->how, &what, NULL, NULL, &plan);
    }
    if (status == GONIO_OK && plan != NULL) {
        status = copy_degrees(plan, degrees, count);
    }
    gonio_plan_free(&plan);
    gonio_readings_free(&readings);
    free(rows);
    return survive(status);
}
