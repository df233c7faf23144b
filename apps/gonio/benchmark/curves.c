/* Curves of mean errors against directions: see curves.h. */
#include "curves.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "figures/figure.h"
#include "core/core.h"

enum { MOST_CURVES = 64 };

typedef struct curve_points {
    char name[64];
    size_t count;
    double x[BENCHMARK_MOST_SIZES], y[BENCHMARK_MOST_SIZES];
} curve_points;

static bool same_curve(const benchmark_mean *a, const benchmark_mean *b)
{
    return a->ways == b->ways && strcmp(a->method, b->method) == 0;
}

/* Means of a curve are neighbours, by ascending n. */
static size_t gather(const benchmark_summary *summary, const char *set, curve_points *points)
{
    const benchmark_mean *last = NULL;
    size_t count = 0;
    for (size_t k = 0; k < summary->count; k++) {
        const benchmark_mean *m = &summary->mean[k];
        if (m->set != set || !(m->error.value[GONIO_E6] > 0.0)) {
            continue;
        }
        if (last == NULL || !same_curve(last, m)) {
            if (count == MOST_CURVES) {
                break;
            }
            snprintf(points[count].name, sizeof points[count].name, "%s, %s", m->ways->name,
                     m->method);
            points[count++].count = 0;
        }
        curve_points *c = &points[count - 1];
        c->x[c->count] = (double)m->n;
        c->y[c->count++] = m->error.value[GONIO_E6];
        last = m;
    }
    return count;
}

bool benchmark_has_curves(const benchmark_summary *summary)
{
    bool several = false;
    for (size_t k = 1; k < summary->count; k++) {
        several = several || summary->mean[k].n != summary->mean[0].n;
    }
    return several;
}

/* A logarithmic axis a little longer than the data; gnuplot would lengthen it to powers of ten. */
static gonio_i_axis axis_of(const char *name, const char *unit, const curve_points *points,
                            size_t count, bool of_y)
{
    const double wider = 1.15;
    gonio_i_axis axis = {
        .name = name, .unit = unit, .logarithmic = true, .low = INFINITY, .high = 0.0};
    for (size_t k = 0; k < count; k++) {
        for (size_t i = 0; i < points[k].count; i++) {
            const double value = of_y ? points[k].y[i] : points[k].x[i];
            axis.low = fmin(axis.low, value);
            axis.high = fmax(axis.high, value);
        }
    }
    axis.low /= wider;
    axis.high *= wider;
    return axis;
}

static gonio_status draw(gonio_context *context, gonio_i_figures *figures,
                         const benchmark_summary *summary, size_t number, curve_points *points)
{
    char name[32];
    gonio_i_curve curves[MOST_CURVES];
    const size_t count = gather(summary, summary->set[number], points);
    if (!benchmark_has_curves(summary)) {
        return GONIO_OK;
    }
    for (size_t k = 0; k < count; k++) {
        curves[k] = (gonio_i_curve){
            .name = points[k].name, .count = points[k].count, .x = points[k].x, .y = points[k].y};
    }
    snprintf(name, sizeof name, "e6-%zu", number + 1);
    const gonio_i_curves figure = {.name = name,
                                   .title = summary->set[number],
                                   .x = axis_of("directions read", NULL, points, count, false),
                                   .y = axis_of("mean error E6", "%", points, count, true),
                                   .count = count,
                                   .curves = curves};
    return count > 0 ? gonio_i_figure_curves(context, figures, &figure) : GONIO_OK;
}

gonio_status benchmark_draw_curves(gonio_context *context, const benchmark_summary *summary,
                                   const char *folder)
{
    char *path = gonio_i_format("%s/figures", folder);
    curve_points *points = gonio_i_allocate(context, MOST_CURVES, sizeof *points);
    gonio_i_figures figures = {.folder = path};
    gonio_status status = path != NULL && points != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < summary->sets && status == GONIO_OK; k++) {
        status = draw(context, &figures, summary, k, points);
    }
    free(points);
    free(path);
    return status;
}
