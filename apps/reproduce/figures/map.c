/* Maps of a value on a grid: see figure.h. */
#include "figure.h"

#include "figure_writer.h"

static bool ascends(const double *values, size_t count)
{
    for (size_t k = 1; k < count; k++) {
        if (!(values[k] > values[k - 1])) {
            return false;
        }
    }
    return count >= 2;
}

static gonio_status check(gonio_context *context, const gonio_i_map *figure, gonio_i_range *range)
{
    if (!ascends(figure->at_x, figure->columns) || !ascends(figure->at_y, figure->rows)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "figure %s: a map needs two ascending columns and rows at least",
                            figure->name);
    }
    return gonio_i_find_range(context, figure->name, &figure->value, figure->values,
                              figure->columns * figure->rows, range);
}

/* A blank line behind every column tells gnuplot that this is a grid. */
static void put_data(FILE *data, const gonio_i_map *figure)
{
    gonio_i_put_heading(data, &figure->x);
    fputc(',', data);
    gonio_i_put_heading(data, &figure->y);
    fputc(',', data);
    gonio_i_put_heading(data, &figure->value);
    for (size_t column = 0; column < figure->columns; column++) {
        fputc('\n', data);
        for (size_t row = 0; row < figure->rows; row++) {
            gonio_i_put_number(data, figure->at_x[column]);
            fputc(',', data);
            gonio_i_put_number(data, figure->at_y[row]);
            fputc(',', data);
            gonio_i_put_number(data, figure->values[column * figure->rows + row]);
            fputc('\n', data);
        }
    }
}

/* Half way between the grid's lines; as far outside at both ends. */
static double edge_of(const double *at, size_t count, size_t edge)
{
    if (edge == 0) {
        return at[0] - 0.5 * (at[1] - at[0]);
    }
    if (edge == count) {
        return at[count - 1] + 0.5 * (at[count - 1] - at[count - 2]);
    }
    return 0.5 * (at[edge - 1] + at[edge]);
}

static void put_edges(FILE *script, const char *axis, const double *at, size_t count)
{
    fprintf(script, "array %s_edge[%zu] = [", axis, count + 1);
    for (size_t k = 0; k <= count; k++) {
        fprintf(script, "%s%.10g", k > 0 ? ", " : "", edge_of(at, count, k));
    }
    fprintf(script, "]\nset %srange [%.10g:%.10g]\n", axis, edge_of(at, count, 0),
            edge_of(at, count, count));
}

static void put_levels(FILE *script, const gonio_i_map *figure)
{
    if (figure->levels == 0) {
        fputs("set cntrparam levels auto 8\n", script);
        return;
    }
    fputs("set cntrparam levels discrete ", script);
    for (size_t k = 0; k < figure->levels; k++) {
        fprintf(script, "%s%.10g", k > 0 ? ", " : "", figure->level[k]);
    }
    fputc('\n', script);
}

static void put_marks(FILE *script, const gonio_i_map *figure)
{
    for (size_t k = 0; k < figure->marks; k++) {
        fputs("set label ", script);
        gonio_i_put_quoted(script, figure->mark[k].name);
        fprintf(script,
                " at %.10g,%.10g noenhanced front point pt 7 ps 0.8 lc rgb '#D55E00' "
                "offset character 0.9,-0.1 font ',11' boxed\n",
                figure->mark[k].x, figure->mark[k].y);
    }
}

static void put_settings(FILE *script, const gonio_i_map *figure)
{
    const size_t third = figure->rows / 3; /* labels stand there, but not far from an end */
    fprintf(script, "\ndata = '%s.csv'\nrows = %zu\nlabelled = %zu\n", figure->name, figure->rows,
            third < 7 ? third : 7);
    put_edges(script, "x", figure->at_x, figure->columns);
    put_edges(script, "y", figure->at_y, figure->rows);
    fputs("# Contour lines come as text with blanks between the numbers.\n"
          "field(k) = real(word(strcol(1), k))\n"
          "set contour base\nunset surface\n",
          script);
    put_levels(script, figure);
    fputs("set table $contours\nsplot data skip 1 using 1:2:3\nunset table\nunset contour\n\n"
          "set palette defined (0 '#FFFFD9', 1 '#EDF8B1', 2 '#C7E9B4', 3 '#7FCDBB', 4 '#41B6C4', "
          "5 '#1D91C0', 6 '#225EA8', 7 '#253494', 8 '#081D58')\n"
          "set style textbox opaque margins 0.6,0.5 fillcolor rgb 'white' noborder\n"
          "set border 15\nunset grid\nset colorbox border\n",
          script);
    put_marks(script, figure);
}

static const char plot[] =
    "  plot data skip 1 using 1:2:(x_edge[column(-1) + 1]):(x_edge[column(-1) + 2]):"
    "(y_edge[int($0) % rows + 1]):(y_edge[int($0) % rows + 2]):3 \\\n"
    "      with boxxyerror fs solid 1 border lw 0.4 lc palette z notitle, \\\n"
    "    $contours using (field(1)):(field(2)) with lines lw 2.4 dt 1 lc rgb 'white' notitle, \\\n"
    "    $contours using (field(1)):(field(2)) with lines lw 1 dt 1 lc rgb 'black' notitle, \\\n"
    "    $contours using (field(1)):(field(2)):(sprintf('%g', field(3))) every 999::labelled \\\n"
    "      with labels boxed font ',10' notitle\n";

gonio_status gonio_i_figure_map(gonio_context *context, gonio_i_figures *figures,
                                const gonio_i_map *figure)
{
    gonio_i_figure_output output;
    gonio_i_range range = GONIO_I_NO_RANGE;
    gonio_status status = check(context, figure, &range);
    if (status == GONIO_OK) {
        status = gonio_i_figure_output_begin(context, figure->name, figure->title, &output);
    }
    if (status != GONIO_OK) {
        return status;
    }
    put_data(output.data, figure);
    gonio_i_put_axis(output.script, "x", &figure->x, &range);
    gonio_i_put_axis(output.script, "y", &figure->y, &range);
    gonio_i_put_axis(output.script, "cb", &figure->value, &range);
    put_settings(output.script, figure);
    gonio_i_figure_output_begin_drawing(&output, 640, 480);
    fputs(plot, output.script);
    gonio_i_figure_output_end_drawing(&output);
    return gonio_i_figure_output_end(&output, figures, GONIO_OK);
}
