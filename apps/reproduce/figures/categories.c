/* Figures of many categories: see figure.h. */
#include "figure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "figure_writer.h"

enum { WIDTH = 1120, HEIGHT = 520 };

static gonio_status check(gonio_context *context, const gonio_i_categories *figure,
                          gonio_i_range *y)
{
    gonio_status status = GONIO_OK;
    if (figure->count == 0 || figure->categories == 0 || figure->sorted_by >= figure->count) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "figure %s: nothing to show",
                            figure->name);
    }
    for (size_t k = 0; k < figure->count && status == GONIO_OK; k++) {
        status = gonio_i_find_range(context, figure->name, &figure->y, figure->series[k].values,
                                    figure->categories, y);
    }
    return status;
}

/* ---- the order ---- */

typedef struct place {
    size_t category;
    double value;
} place;

/* Missing values come last, equal ones in the order given. */
static int compare_places(const void *a, const void *b)
{
    const place *p = a;
    const place *q = b;
    if (isnan(p->value) != isnan(q->value)) {
        return isnan(p->value) ? 1 : -1;
    }
    if (p->value != q->value && !isnan(p->value)) {
        return p->value < q->value ? -1 : 1;
    }
    return p->category < q->category ? -1 : 1;
}

static place *sort(gonio_context *context, const gonio_i_categories *figure)
{
    place *order = gonio_i_allocate(context, figure->categories, sizeof *order);
    for (size_t k = 0; order != NULL && k < figure->categories; k++) {
        order[k] = (place){k, figure->series[figure->sorted_by].values[k]};
    }
    if (order != NULL) {
        qsort(order, figure->categories, sizeof *order, compare_places);
    }
    return order;
}

/* ---- the texts ---- */

/* Names stand last: gnuplot reads quoted text less well than numbers. */
static void put_data(FILE *data, const gonio_i_categories *figure, const place *order)
{
    for (size_t k = 0; k < figure->count; k++) {
        char *name = gonio_i_format("%s: %s", figure->series[k].name, figure->y.name);
        gonio_i_axis heading = figure->y;
        heading.name = name != NULL ? name : figure->series[k].name;
        gonio_i_put_heading(data, &heading);
        fputc(',', data);
        free(name);
    }
    gonio_i_put_cell(data, figure->kind);
    fputc('\n', data);
    for (size_t k = 0; k < figure->categories; k++) {
        for (size_t series = 0; series < figure->count; series++) {
            gonio_i_put_number(data, figure->series[series].values[order[k].category]);
            fputc(',', data);
        }
        gonio_i_put_cell(data, figure->category[order[k].category]);
        fputc('\n', data);
    }
}

/* Of the names as shown: in bytes, which is no less than letters. */
static size_t longest(const gonio_i_categories *figure)
{
    size_t most = 0;
    for (size_t k = 0; k < figure->categories; k++) {
        const size_t length = strlen(figure->category[k]);
        most = length > most ? length : most;
    }
    return most < GONIO_I_LONGEST_TIC ? most : GONIO_I_LONGEST_TIC;
}

static void put_settings(FILE *script, const gonio_i_categories *figure, const place *order)
{
    const int font = figure->categories > 60 ? 8 : 10;
    fprintf(script,
            "\ndata = '%s.csv'\n"
            "set xrange [-1:%zu]\n"
            "set xtics rotate by 90 right scale 0.3 font ',%d'\n"
            "set bmargin %.3g\n"
            "set key outside top center\n",
            figure->name, figure->categories, font, 1.5 + 0.043 * font * (double)longest(figure));
    for (size_t k = 0; k < figure->categories; k++) {
        fprintf(script, "set xtics %s(", k > 0 ? "add " : "");
        gonio_i_put_tic(script, figure->category[order[k].category]);
        fprintf(script, " %zu)\n", k);
    }
}

static void put_plot(FILE *script, const gonio_i_categories *figure)
{
    fputs("  plot NaN notitle", script);
    for (size_t k = 0; k < figure->count; k++) {
        fprintf(script, ", \\\n    data skip 1 using 0:%zu with points lt %zu title ", k + 1,
                k + 1);
        gonio_i_put_quoted(script, figure->series[k].name);
    }
    fputc('\n', script);
}

gonio_status gonio_i_figure_categories(gonio_context *context, gonio_i_figures *figures,
                                       const gonio_i_categories *figure)
{
    gonio_i_figure_output output;
    gonio_i_range y = GONIO_I_NO_RANGE;
    gonio_status status = check(context, figure, &y);
    place *order = status == GONIO_OK ? sort(context, figure) : NULL;
    if (order == NULL) {
        return status != GONIO_OK ? status : GONIO_ERROR_MEMORY;
    }
    status = gonio_i_figure_output_begin(context, figure->name, figure->title, &output);
    if (status == GONIO_OK) {
        put_data(output.data, figure, order);
        gonio_i_put_axis(output.script, "y", &figure->y, &y);
        put_settings(output.script, figure, order);
        gonio_i_figure_output_begin_drawing(&output, WIDTH, HEIGHT);
        put_plot(output.script, figure);
        gonio_i_figure_output_end_drawing(&output);
        status = gonio_i_figure_output_end(&output, figures, status);
    }
    free(order);
    return status;
}
