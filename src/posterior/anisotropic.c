/* The posterior of an anisotropic material: see anisotropic.h.
 *
 * How it is solved for; anisotropic_at.c predicts. */
#include "anisotropic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "anisotropic_parts.h"
#include "leave_one_out.h"
#include "parallel_for.h"

/* Samples of less weight do not count in the variance. */
static const double NEGLIGIBLE = 1e-3;

/* What fits take in all, bytes. */
static const double MOST_BYTES = 6e8;

enum { MOST_READINGS = 1200 };

size_t gonio_i_anisotropic_most_readings(size_t columns)
{
    const double most = sqrt(MOST_BYTES / (8.0 * fmax((double)columns, 1.0)));
    return most < MOST_READINGS ? (size_t)most : MOST_READINGS;
}

/* ---- one column under one hypothesis ---- */

/* The samples that explain the readings, and how far they are from the mean. */
static gonio_status keep_samples(gonio_i_solution *s)
{
    const gonio_i_fit *e = &s->fit;
    const size_t k = e->components;
    const double a = sqrt(1.0 - e->model.h * e->model.h);
    if (!(e->model.h < 1.0)) {
        return GONIO_OK;
    }
    for (size_t j = 0; j < e->samples; j++) {
        s->samples += e->weight[j] > NEGLIGIBLE;
    }
    s->weight = gonio_i_allocate(e->context, s->samples, sizeof *s->weight);
    s->move = gonio_i_allocate(e->context, s->samples * k, sizeof *s->move);
    s->answered = gonio_i_allocate(e->context, s->samples * e->n, sizeof *s->answered);
    if (s->weight == NULL || s->move == NULL || s->answered == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    size_t kept = 0;
    for (size_t j = 0; j < e->samples; j++) {
        if (e->weight[j] > NEGLIGIBLE) {
            s->weight[kept] = e->weight[j];
            for (size_t c = 0; c < k; c++) {
                s->move[kept * k + c] = a * e->prior->sample[j * k + c] - e->centre[c];
            }
            kept++;
        }
    }
    const gonio_status status = gonio_i_product_transposed(e->context, s->move, s->samples, k,
                                                           e->sites->f, e->n, s->answered, e->n);
    gonio_i_divide_triangle(s->answered, s->samples, e->n, e->lower);
    gonio_i_divide_lower(s->answered, s->samples, e->n, e->lower);
    return status;
}

static void find_linear(const gonio_i_stretch *stretch, gonio_i_solution *s)
{
    const gonio_i_fit *e = &s->fit;
    const double common = e->model.h * e->model.h * (1.0 - stretch->share);
    memcpy(s->linear, e->centre, e->components * sizeof *s->linear);
    for (size_t i = 0; i < e->n; i++) {
        for (size_t k = 0; k < e->components; k++) {
            s->linear[k] += common * e->solved[i] * e->sites->f[i * e->components + k];
        }
    }
}

/* The variances that the likeliest hypothesis gives to outliers hold under the others too. */
static void judge_alike(const gonio_i_anisotropic *a, size_t p, size_t c)
{
    const gonio_i_fit *judged = &a->part[0].solution[c].fit;
    const gonio_i_stretch *first = &a->part[0].hypothesis.stretch;
    const gonio_i_stretch *own = &a->part[p].hypothesis.stretch;
    gonio_i_fit *e = &a->part[p].solution[c].fit;
    memcpy(e->left_out, judged->left_out, e->n * sizeof *e->left_out);
    for (size_t i = 0; i < e->n; i++) {
        const gonio_i_observation *o = &a->given->column[c].observation[i];
        const double slope = gonio_i_stretched_slope(o, a->given->pair, own) /
                             gonio_i_stretched_slope(o, a->given->pair, first);
        e->variance[i] = judged->variance[i] * slope * slope;
    }
}

/* Begins the fit of a column under a hypothesis. */
static gonio_status begin_fit(const gonio_i_anisotropic *a, gonio_context *context,
                              const gonio_i_part *p, size_t c, gonio_i_fit *fit)
{
    gonio_i_column there = {0};
    gonio_status status = gonio_i_stretched_column(context, &a->given->column[c], a->given->pair,
                                                   &p->hypothesis.stretch, &there);
    if (status == GONIO_OK) {
        status = gonio_i_fit_begin(context, p->sites[c], p->hypothesis.model.h >= 1.0, &there, fit);
    }
    free(there.observation);
    return status;
}

static gonio_status solve_part(gonio_i_anisotropic *a, gonio_context *context, size_t p, size_t c)
{
    gonio_i_part *here = &a->part[p];
    gonio_i_solution *s = &here->solution[c];
    const gonio_i_model *model = &here->hypothesis.model;
    double sum = 0.0;
    s->sites = here->sites[c];
    s->azimuth = here->azimuth[c];
    s->linear = gonio_i_allocate(context, a->prior->components, sizeof *s->linear);
    gonio_status status =
        s->linear == NULL ? GONIO_ERROR_MEMORY : begin_fit(a, context, here, c, &s->fit);
    if (status == GONIO_OK && p > 0) {
        judge_alike(a, p, c);
    }
    if (status == GONIO_OK) {
        status = gonio_i_fit_solve(&s->fit, model);
    }
    if (status == GONIO_OK && p == 0) {
        status = gonio_i_fit_settle(&s->fit, a->judge, &a->outlying[c]);
    }
    if (status == GONIO_OK) {
        status = gonio_i_fit_surprise(&s->fit, &sum);
    }
    if (status == GONIO_OK) {
        find_linear(&here->hypothesis.stretch, s);
        status = keep_samples(s);
    }
    free(s->fit.white);
    s->fit.white = NULL;
    return status;
}

static gonio_status solve_column(void *data, gonio_context *context, size_t c)
{
    gonio_i_anisotropic *a = data;
    gonio_status status = GONIO_OK;
    for (size_t p = 0; p < a->parts && status == GONIO_OK; p++) {
        status = solve_part(a, context, p, c);
    }
    return status;
}

/* ---- outliers ---- */

/* As in models.c: the gain in score from which outliers are set aside, for each direction's worth
 * of them. */
static const double FOR_WRONG_DIRECTION = 30.0;

static gonio_status score_settled(gonio_i_fit *e, const gonio_i_model *model, bool judge,
                                  double *sum, size_t *outlying)
{
    double *score = gonio_i_allocate(e->context, e->n, sizeof *score);
    gonio_status status = score == NULL ? GONIO_ERROR_MEMORY : gonio_i_fit_solve(e, model);
    if (status == GONIO_OK) {
        status = gonio_i_fit_settle(e, judge, outlying);
    }
    if (status == GONIO_OK) {
        status = gonio_i_leave_one_out_score(e, model, score);
    }
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        *sum += judge ? score[i] : -score[i];
    }
    free(score);
    return status;
}

/* The gain of a column under the likeliest hypothesis. */
static gonio_status judge_column(void *data, gonio_context *context, size_t c)
{
    gonio_i_anisotropic *a = data;
    const gonio_i_part *first = &a->part[0];
    const gonio_i_model *model = &first->hypothesis.model;
    size_t none = 0;
    gonio_i_fit fit = {0};
    gonio_status status = begin_fit(a, context, first, c, &fit);
    if (status == GONIO_OK) {
        status = score_settled(&fit, model, true, &a->gain[c], &a->outlying[c]);
    }
    if (status == GONIO_OK && a->outlying[c] > 0) {
        gonio_i_fit_end(&fit);
        status = begin_fit(a, context, first, c, &fit);
    }
    if (status == GONIO_OK && a->outlying[c] > 0) {
        status = score_settled(&fit, model, false, &a->gain[c], &none);
    }
    gonio_i_fit_end(&fit);
    return status;
}

/* Whether outliers are wrong readings rather than right readings of an unusual material. */
static gonio_status judge_outliers(gonio_i_anisotropic *a)
{
    gonio_i_steps steps = {.task = NULL};
    double gain = 0.0;
    size_t outlying = 0;
    const gonio_status status =
        gonio_i_parallel_for(a->context, &steps, a->columns, judge_column, a);
    for (size_t c = 0; c < a->columns; c++) {
        gain += a->outlying[c] > 0 ? a->gain[c] : 0.0;
        outlying += a->outlying[c];
        a->outlying[c] = 0;
    }
    a->judge = outlying > 0 &&
               gain > FOR_WRONG_DIRECTION * (double)outlying / fmax((double)a->columns, 1.0);
    return status;
}

/* ---- all of them ---- */

static gonio_status create_azimuths(gonio_i_anisotropic *a, gonio_i_part *p, size_t c)
{
    const gonio_i_column *column = &a->given->column[c];
    gonio_i_azimuth_point *made = gonio_i_allocate(a->context, column->count, sizeof *made);
    for (size_t i = 0; made != NULL && i < column->count; i++) {
        const gonio_i_oriented here =
            gonio_i_oriented_of(a->given->pair[column->observation[i].reading]);
        made[i] = gonio_i_azimuth_of(&p->hypothesis.stretch, here);
    }
    p->azimuth[c] = made;
    return made != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status create_sites(gonio_i_anisotropic *a, gonio_i_part *p)
{
    const gonio_i_oriented_columns *given = a->given;
    p->sites = gonio_i_allocate(a->context, a->columns, sizeof *p->sites);
    p->azimuth = gonio_i_allocate(a->context, a->columns, sizeof *p->azimuth);
    p->solution = gonio_i_allocate(a->context, a->columns, sizeof *p->solution);
    gonio_status status = p->sites == NULL || p->azimuth == NULL || p->solution == NULL
                              ? GONIO_ERROR_MEMORY
                              : GONIO_OK;
    for (size_t c = 0; c < a->columns && status == GONIO_OK; c++) {
        size_t same = 0;
        while (same < c && !gonio_i_columns_are_same(&given->column[same], &given->column[c])) {
            same++;
        }
        p->sites[c] = p->sites[same];
        p->azimuth[c] = p->azimuth[same];
        if (same == c) {
            status =
                gonio_i_stretched_sites_create(a->context, a->prior, &given->column[c], given->pair,
                                               &p->hypothesis.stretch, &p->sites[c]);
        }
        if (same == c && status == GONIO_OK) {
            status = create_azimuths(a, p, c);
        }
    }
    return status;
}

static void release_solution(gonio_i_solution *s)
{
    gonio_i_fit_end(&s->fit);
    free(s->linear);
    free(s->weight);
    free(s->move);
    free(s->answered);
}

static void release_part(gonio_i_part *p, size_t columns)
{
    for (size_t c = 0; p->solution != NULL && c < columns; c++) {
        release_solution(&p->solution[c]);
    }
    for (size_t c = 0; p->azimuth != NULL && c < columns; c++) {
        gonio_i_azimuth_point *one = p->azimuth[c];
        for (size_t j = c; j < columns; j++) {
            p->azimuth[j] = p->azimuth[j] == one ? NULL : p->azimuth[j];
        }
        free(one);
    }
    if (p->sites != NULL) {
        gonio_i_sites_release(p->sites, columns);
    }
    free(p->sites);
    free(p->azimuth);
    free(p->solution);
}

void gonio_i_anisotropic_free(gonio_i_anisotropic **estimate)
{
    if (estimate == NULL || *estimate == NULL) {
        return;
    }
    gonio_i_anisotropic *a = *estimate;
    for (size_t p = 0; p < a->parts; p++) {
        release_part(&a->part[p], a->columns);
    }
    free(a->outlying);
    free(a->gain);
    free(a);
    *estimate = NULL;
}

/* As many hypotheses as there is memory for their fits, one at least. */
static void take_hypotheses(gonio_i_anisotropic *a)
{
    const double each = 8.0 * (double)a->most * (double)a->most * (double)a->columns;
    const size_t room = (size_t)fmax(MOST_BYTES / fmax(each, 1.0), 1.0);
    double sum = 0.0;
    a->parts = a->stretches.count < room ? a->stretches.count : room;
    for (size_t p = 0; p < a->parts; p++) {
        a->part[p].hypothesis = a->stretches.hypothesis[p];
        sum += a->part[p].hypothesis.weight;
    }
    for (size_t p = 0; p < a->parts; p++) {
        a->part[p].hypothesis.weight /= sum;
    }
}

static gonio_status solve_all(gonio_i_anisotropic *a)
{
    gonio_i_steps steps = {.task = "reconstructing", .all = a->columns};
    gonio_status status = gonio_i_stretches_weigh(a->context, a->given, &a->stretches);
    if (status == GONIO_OK) {
        take_hypotheses(a);
    }
    for (size_t p = 0; p < a->parts && status == GONIO_OK; p++) {
        status = create_sites(a, &a->part[p]);
    }
    if (status == GONIO_OK) {
        status = judge_outliers(a);
    }
    return status == GONIO_OK
               ? gonio_i_parallel_for(a->context, &steps, a->columns, solve_column, a)
               : status;
}

gonio_status gonio_i_anisotropic_find(gonio_context *context,
                                      const gonio_i_oriented_columns *columns,
                                      gonio_i_anisotropic **estimate)
{
    gonio_i_anisotropic *a = gonio_i_allocate(context, 1, sizeof *a);
    if (a == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    a->context = context;
    a->given = columns;
    a->prior = columns->prior;
    a->columns = columns->count;
    for (size_t c = 0; c < columns->count; c++) {
        a->most = columns->column[c].count > a->most ? columns->column[c].count : a->most;
    }
    a->outlying = gonio_i_allocate(context, a->columns, sizeof *a->outlying);
    a->gain = gonio_i_allocate(context, a->columns, sizeof *a->gain);
    const gonio_status status =
        a->outlying == NULL || a->gain == NULL ? GONIO_ERROR_MEMORY : solve_all(a);
    a->context = NULL;
    a->given = NULL;
    if (status != GONIO_OK) {
        gonio_i_anisotropic_free(&a);
    }
    *estimate = a;
    return status;
}

const gonio_i_stretches *gonio_i_anisotropic_stretches(const gonio_i_anisotropic *a)
{
    return &a->stretches;
}

size_t gonio_i_anisotropic_outlying(const gonio_i_anisotropic *a)
{
    size_t outlying = 0;
    for (size_t c = 0; c < a->columns; c++) {
        outlying += a->outlying[c];
    }
    return outlying;
}
