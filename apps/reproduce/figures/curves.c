/* Figures of curves: see figure.h. */
#include "figure.h"

#include <math.h>

#include "figure_writer.h"

enum { MOST_MARKERS = 30, MARKERS = 12 };

static gonio_status find_ranges(gonio_context *context, const gonio_i_curves *figure,
                                gonio_i_range *x, gonio_i_range *y)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < figure->count && status == GONIO_OK; k++) {
        const gonio_i_curve *c = &figure->curves[k];
        const double *const heights[] = {c->y, c->low, c->high};
        status = gonio_i_find_range(context, figure->name, &figure->x, c->x, c->count, x);
        for (int i = 0; i < 3 && status == GONIO_OK; i++) {
            status = gonio_i_find_range(context, figure->name, &figure->y, heights[i], c->count, y);
        }
    }
    if (status == GONIO_OK && (x->low > x->high || y->low > y->high)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "figure %s: nothing to show",
                            figure->name);
    }
    return status;
}

/* Names stand last: gnuplot reads quoted text less well than numbers. */
static void put_data(FILE *data, const gonio_i_curves *figure)
{
    gonio_i_put_heading(data, &figure->x);
    fputc(',', data);
    gonio_i_put_heading(data, &figure->y);
    fputs(",\"low\",\"high\",\"curve\",\"name\"\n", data);
    for (size_t k = 0; k < figure->count; k++) {
        const gonio_i_curve *c = &figure->curves[k];
        for (size_t i = 0; i < c->count; i++) {
            const double row[] = {c->x[i], c->y[i], c->low != NULL ? c->low[i] : NAN,
                                  c->high != NULL ? c->high[i] : NAN, (double)(k + 1)};
            for (size_t column = 0; column < sizeof row / sizeof *row; column++) {
                gonio_i_put_number(data, row[column]);
                fputc(',', data);
            }
            gonio_i_put_cell(data, c->name != NULL ? c->name : "");
            fputc('\n', data);
        }
    }
}

/* Counts the curves that are told apart, so that each has its line type. */
static int line_type_of(const gonio_i_curves *figure, size_t curve)
{
    int type = 1;
    for (size_t k = 0; k < curve; k++) {
        type += !figure->curves[k].faint;
    }
    return type;
}

static bool has_intervals(const gonio_i_curves *figure, size_t k, gonio_i_interval_style intervals)
{
    return figure->intervals == intervals && figure->curves[k].low != NULL &&
           figure->curves[k].high != NULL && !figure->curves[k].faint;
}

static void put_title(FILE *script, const char *name)
{
    if (name == NULL) {
        fputs(" notitle", script);
    } else {
        fputs(" title ", script);
        gonio_i_put_quoted(script, name);
    }
}

static void put_curve(FILE *script, const gonio_i_curves *figure, size_t k)
{
    const gonio_i_curve *c = &figure->curves[k];
    const int type = line_type_of(figure, k);
    if (has_intervals(figure, k, GONIO_I_ERROR_BARS)) {
        fprintf(script,
                ", \\\n    data skip 1 using (x_of(%zu)):2:3:4 with yerrorbars lt %d lw 0.8 dt 1 "
                "pt 0 notitle",
                k + 1, type);
    }
    fprintf(script, ", \\\n    data skip 1 using (x_of(%zu)):2 with ", k + 1);
    if (c->faint) {
        fputs("lines lw 0.7 dt 1 lc rgb '#A8A8A8'", script);
    } else if (figure->dots) {
        fprintf(script, "linespoints lt %d dt 1 lw 1.2 pt 7 ps 0.4", type);
    } else if (c->count > MOST_MARKERS) {
        fprintf(script, "linespoints lt %d pointinterval %zu", type, c->count / MARKERS);
    } else {
        fprintf(script, "linespoints lt %d", type);
    }
    put_title(script, c->name);
}

/* Bands lie below all curves, and faint curves below the others. */
static void put_plot(FILE *script, const gonio_i_curves *figure)
{
    fputs("  plot NaN notitle", script);
    for (size_t k = 0; k < figure->count; k++) {
        if (has_intervals(figure, k, GONIO_I_BAND)) {
            fprintf(script,
                    ", \\\n    data skip 1 using (x_of(%zu)):3:4 with filledcurves lt %d "
                    "fs transparent solid 0.16 noborder notitle",
                    k + 1, line_type_of(figure, k));
        }
    }
    for (int faint = 1; faint >= 0; faint--) {
        for (size_t k = 0; k < figure->count; k++) {
            if (figure->curves[k].faint == (faint == 1)) {
                put_curve(script, figure, k);
            }
        }
    }
    fputc('\n', script);
}

/* The horizontal shift of a curve, if curves are drawn apart. */
static void put_place(FILE *script, const gonio_i_curves *figure)
{
    const double middle = 0.5 * (double)(figure->count + 1);
    fputs("x_of(curve) = column(5) == curve ? column(1)", script);
    if (figure->apart != 0.0) {
        fprintf(script,
                figure->x.logarithmic ? " * %.10g ** (curve - %.10g)"
                                      : " + %.10g * (curve - %.10g)",
                figure->apart, middle);
    }
    fputs(" : NaN\n", script);
}

gonio_status gonio_i_figure_curves(gonio_context *context, gonio_i_figures *figures,
                                   const gonio_i_curves *figure)
{
    gonio_i_figure_output output;
    gonio_i_range x = GONIO_I_NO_RANGE;
    gonio_i_range y = GONIO_I_NO_RANGE;
    gonio_status status = find_ranges(context, figure, &x, &y);
    if (status == GONIO_OK) {
        status = gonio_i_figure_output_begin(context, figure->name, figure->title, &output);
    }
    if (status != GONIO_OK) {
        return status;
    }
    put_data(output.data, figure);
    gonio_i_put_axis(output.script, "x", &figure->x, &x);
    gonio_i_put_axis(output.script, "y", &figure->y, &y);
    fprintf(output.script, "\ndata = '%s.csv'\n", figure->name);
    put_place(output.script, figure);
    gonio_i_figure_output_begin_drawing(&output, 640, 420);
    put_plot(output.script, figure);
    gonio_i_figure_output_end_drawing(&output);
    return gonio_i_figure_output_end(&output, figures, GONIO_OK);
}
