/* Directions on the hemisphere: see figure.h. */
#include "figure.h"

#include <math.h>

#include "figure_writer.h"

enum { PANEL_WIDTH = 340, PANEL_HEIGHT = 440 };

static gonio_status check(gonio_context *context, const gonio_i_directions *figure)
{
    if (figure->count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "figure %s: nothing to show",
                            figure->name);
    }
    return GONIO_OK;
}

static void put_row(FILE *data, gonio_angles angles, size_t panel, const char *end,
                    const char *name)
{
    gonio_i_put_number(data, angles.theta * 180.0 / M_PI);
    fputc(',', data);
    gonio_i_put_number(data, angles.phi * 180.0 / M_PI);
    fprintf(data, ",%zu,%s,", panel + 1, end);
    gonio_i_put_cell(data, name);
    fputc('\n', data);
}

static void put_data(FILE *data, const gonio_i_directions *figure)
{
    fputs("\"theta (degrees)\",\"phi (degrees)\",\"panel\",\"light is 1 and view 2\",\"name\"\n",
          data);
    for (size_t p = 0; p < figure->count; p++) {
        const gonio_i_panel *panel = &figure->panels[p];
        for (size_t k = 0; k < panel->count; k++) {
            put_row(data, panel->pairs[k].incident, p, "1", panel->name);
            put_row(data, panel->pairs[k].outgoing, p, "2", panel->name);
        }
    }
}

/* Rings of theta and spokes of phi. Labels of rings stand between spokes, those of every second one
 * elsewhere, as the outer rings may be close. */
static const char hemisphere[] =
    "angle = pi / 180\n"
    "shown(panel, end) = column(3) == panel && column(4) == end ? 1 : NaN\n"
    "x_of(theta, phi) = radius(theta) * cos(angle * phi)\n"
    "y_of(theta, phi) = radius(theta) * sin(angle * phi)\n"
    "\n"
    "unset border\nunset tics\nunset grid\n"
    "set size ratio -1\nset xrange [-1.17:1.17]\nset yrange [-1.17:1.17]\n"
    "set style textbox opaque margins 0.3,0.3 fillcolor rgb 'white' noborder\n"
    "do for [k = 1:6] {\n"
    "  set object k circle at 0,0 size radius(15 * k) fs empty border rgb (k == 6 ? '#606060' : "
    "'#D4D4D4') lw (k == 6 ? 1 : 0.6) behind\n"
    "  set label k sprintf('%d°', 15 * k) at x_of(15 * k, k % 2 ? 195 : 165), y_of(15 * k, k % 2 ? "
    "195 : 165) center font ',9' "
    "textcolor rgb '#606060' boxed back\n"
    "}\n"
    "do for [k = 0:11] {\n"
    "  set arrow k + 1 from 0,0 to x_of(90, 30 * k), y_of(90, 30 * k) nohead lw 0.6 "
    "lc rgb '#D4D4D4' back\n"
    "  set label k + 7 sprintf('%d°', 30 * k) at 1.1 * x_of(90, 30 * k), "
    "1.1 * y_of(90, 30 * k) center font ',9' textcolor rgb '#606060'\n"
    "}\n";

static void put_panel(FILE *script, const gonio_i_directions *figure, size_t p)
{
    fputs("  set title ", script);
    gonio_i_put_quoted(script, figure->panels[p].name);
    fprintf(
        script,
        " noenhanced offset 0,-0.5\n"
        "  plot data skip 1 using (shown(%zu, 1) * x_of($1, $2)):(y_of($1, $2)) with points pt 1 "
        "ps 0.8 lw 1.2 "
        "lc rgb '#D55E00' title 'light', \\\n"
        "    data skip 1 using (shown(%zu, 2) * x_of($1, $2)):(y_of($1, $2)) with points pt 3 ps "
        "0.8 lw 1.2 "
        "lc rgb '#0072B2' title 'view'\n"
        "  unset key\n",
        p + 1, p + 1);
}

static void put_drawing(gonio_i_figure_output *output, const gonio_i_directions *figure)
{
    FILE *s = output->script;
    gonio_i_figure_output_begin_drawing(output, PANEL_WIDTH * (int)figure->count, PANEL_HEIGHT);
    fputs("  set key at screen 0.5,0.05 center center horizontal Left reverse samplen 1 width 3\n",
          s);
    gonio_i_begin_panels(s, figure->count, 0.1, figure->title);
    for (size_t p = 0; p < figure->count; p++) {
        put_panel(s, figure, p);
    }
    gonio_i_end_panels(s);
    gonio_i_figure_output_end_drawing(output);
}

gonio_status gonio_i_figure_directions(gonio_context *context, gonio_i_figures *figures,
                                       const gonio_i_directions *figure)
{
    gonio_i_figure_output output;
    gonio_status status = check(context, figure);
    if (status == GONIO_OK) {
        status = gonio_i_figure_output_begin(context, figure->name, NULL, &output);
    }
    if (status != GONIO_OK) {
        return status;
    }
    put_data(output.data, figure);
    fprintf(output.script,
            "\ndata = '%s.csv'\n"
            "# The hemisphere seen from above.\n"
            "radius(theta) = %s\n",
            figure->name,
            figure->projection == GONIO_I_ORTHOGRAPHIC ? "sin(theta * pi / 180)" : "theta / 90.0");
    fputs(hemisphere, output.script);
    put_drawing(&output, figure);
    return gonio_i_figure_output_end(&output, figures, GONIO_OK);
}
