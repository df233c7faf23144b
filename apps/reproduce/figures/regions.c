/* Regions of the hemisphere as coloured cells: see figure.h. */
#include "figure.h"

#include <math.h>
#include <string.h>

#include "figure_writer.h"

enum {
    PANEL_WIDTH = 340,
    PANEL_HEIGHT = 420,
    KEY_ROW = 22,
    KEY_SYMBOL = 36,
    LETTER = 7 /* pixels */,
    KEY_LABELS = 40
};

/* The first region is a pale ground, the others stand out. */
static const char *const colours[] = {"#D6E6F2", "#E69F00", "#009E73", "#CC79A7",
                                      "#999999", "#56B4E9", "#F0E442", "#D55E00"};
enum { COLOURS = sizeof colours / sizeof *colours };

static const char *colour_of(size_t region)
{
    return colours[region < COLOURS ? region : 1 + (region - 1) % (COLOURS - 1)];
}

static gonio_status check(gonio_context *context, const gonio_i_regions *figure)
{
    return figure->count > 0 && figure->regions > 0 && figure->rings > 0 && figure->spokes > 0
               ? GONIO_OK
               : gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "figure %s: nothing to show",
                              figure->name);
}

/* ---- data: blocks of polygons, one for each panel and region, then points ---- */

static void put_vertex(FILE *data, double theta, double phi, const char *name)
{
    gonio_i_put_number(data, theta);
    fputc(',', data);
    gonio_i_put_number(data, phi);
    fputc(',', data);
    gonio_i_put_cell(data, name);
    fputc('\n', data);
}

/* Cells of a ring that are beside each other, from spoke `first` on, as one closed line. */
static void put_arc(FILE *data, const gonio_i_regions *f, size_t ring, size_t first, size_t spokes,
                    const char *name)
{
    const double width = 360.0 / (double)f->spokes;
    const double inner = 90.0 * (double)ring / (double)f->rings;
    const double outer = 90.0 * (double)(ring + 1) / (double)f->rings;
    const double begin = ((double)first - 0.5) * width;
    for (size_t k = 0; k <= spokes; k++) {
        put_vertex(data, outer, begin + width * (double)k, name);
    }
    for (size_t k = spokes + 1; k-- > 0;) {
        put_vertex(data, inner, begin + width * (double)k, name);
    }
    fputc('\n', data);
}

static void put_region(FILE *data, const gonio_i_regions *f, const gonio_i_region_panel *panel,
                       int region)
{
    const char *name = f->region[region];
    for (size_t ring = 0; ring < f->rings; ring++) {
        const int *row = panel->region + ring * f->spokes;
        size_t first = 0;
        while (first < f->spokes) {
            size_t end = first;
            while (end < f->spokes && row[end] == region) {
                end++;
            }
            if (end > first) {
                put_arc(data, f, ring, first, end - first, name);
            }
            first = end > first ? end : first + 1;
        }
    }
    /* A block without polygons has one that is not drawn. */
    fputs("NaN,NaN,\"\"\n\n\n", data);
}

static void put_points(FILE *data, const gonio_i_region_panel *panel)
{
    for (size_t k = 0; k < panel->count; k++) {
        put_vertex(data, panel->point[k].theta * 180.0 / M_PI, panel->point[k].phi * 180.0 / M_PI,
                   panel->name);
    }
    fputs("NaN,NaN,\"\"\n\n\n", data);
}

static void put_data(FILE *data, const gonio_i_regions *figure)
{
    fputs("\"theta (degrees)\",\"phi (degrees)\",\"name\"\n", data);
    for (size_t p = 0; p < figure->count; p++) {
        const gonio_i_region_panel *panel = &figure->panels[p];
        for (size_t r = 0; r < figure->regions; r++) {
            put_region(data, figure, panel, (int)r);
        }
        put_vertex(data, panel->light.theta * 180.0 / M_PI, panel->light.phi * 180.0 / M_PI,
                   panel->name);
        fputs("\n\n", data);
        put_points(data, panel);
    }
}

/* ---- script ---- */

static const char hemisphere[] =
    "# The hemisphere seen from above; the radius is theta.\n"
    "angle = pi / 180\n"
    "x_of(theta, phi) = theta / 90.0 * cos(angle * phi)\n"
    "y_of(theta, phi) = theta / 90.0 * sin(angle * phi)\n"
    "\n"
    "unset border\nunset tics\nunset grid\n"
    "set size ratio -1\nset xrange [-1.17:1.17]\nset yrange [-1.17:1.17]\n"
    "do for [k = 1:6] {\n"
    "  set object k circle at 0,0 size k / 6.0 fs empty border rgb (k == 6 ? '#606060' : "
    "'#B0B0B0') lw (k == 6 ? 1 : 0.6) front\n"
    "}\n"
    "do for [k = 1:5:2] {\n"
    "  set label k sprintf('%d°', 15 * k) at x_of(15 * k, 195), y_of(15 * k, 195) center "
    "font ',9' textcolor rgb '#404040' front\n"
    "}\n"
    "do for [k = 0:11] {\n"
    "  set label k + 7 sprintf('%d°', 30 * k) at 1.1 * x_of(90, 30 * k), "
    "1.1 * y_of(90, 30 * k) center font ',9' textcolor rgb '#606060'\n"
    "}\n";

static bool has_region(const gonio_i_regions *f, const gonio_i_region_panel *panel, int region)
{
    size_t k = 0;
    while (k < f->rings * f->spokes && panel->region[k] != region) {
        k++;
    }
    return k < f->rings * f->spokes;
}

static void put_panel(FILE *script, const gonio_i_regions *figure, size_t p)
{
    const size_t block = p * (figure->regions + 2);
    fputs("  set title ", script);
    gonio_i_put_quoted(script, figure->panels[p].name);
    fputs(" noenhanced offset 0,-0.5\n  plot NaN notitle", script);
    for (size_t r = 0; r < figure->regions; r++) {
        if (!has_region(figure, &figure->panels[p], (int)r)) {
            continue;
        }
        fprintf(script,
                ", \\\n    data skip 1 index %zu using (x_of($1, $2)):(y_of($1, $2)) with "
                "filledcurves closed lc rgb '%s' lw 0.3 dt 1 fs solid 1 border notitle",
                block + r, colour_of(r));
    }
    fprintf(script,
            ", \\\n    data skip 1 index %zu using (x_of($1, $2)):(y_of($1, $2)) with points "
            "pt 1 ps 1.2 lw 2 lc rgb 'black' notitle",
            block + figure->regions);
    if (figure->panels[p].count > 0) {
        fprintf(script,
                ", \\\n    data skip 1 index %zu using (x_of($1, $2)):(y_of($1, $2)) with points "
                "pt 7 ps 0.5 lc rgb '#0072B2' notitle",
                block + figure->regions + 1);
    }
    fputc('\n', script);
}

/* ---- the key: rows of entries below the panels ---- */

typedef struct key {
    FILE *script; /* NULL: rows are counted only */
    int width;    /* of the picture, pixels */
    int height;
    int x;
    int row;
    int entries;
} key;

static void put_entry(key *k, const char *name, const char *colour, const char *symbol)
{
    const int width = KEY_SYMBOL + LETTER * (int)strlen(name);
    if (k->x > 0 && k->x + width > k->width) {
        k->x = 0;
        k->row++;
    }
    if (k->script != NULL) {
        const double x = (k->x + 0.5 * KEY_SYMBOL) / k->width;
        const double y = (double)(KEY_ROW * (k->row + 1)) / k->height;
        fprintf(k->script, "  set label %d '%s' at screen %.4f,%.4f center textcolor rgb '%s' %s\n",
                KEY_LABELS + 2 * k->entries, symbol, x, y, colour, "front");
        fprintf(k->script, "  set label %d ", KEY_LABELS + 2 * k->entries + 1);
        gonio_i_put_quoted(k->script, name);
        fprintf(k->script, " at screen %.4f,%.4f left noenhanced front\n",
                (double)(k->x + KEY_SYMBOL - 8) / k->width, y);
        k->entries++;
    }
    k->x += width;
}

static void put_key(key *k, const gonio_i_regions *figure)
{
    for (size_t r = 0; r < figure->regions; r++) {
        put_entry(k, figure->region[r], colour_of(r), "■");
    }
    put_entry(k, "light", "black", "+");
    if (figure->points != NULL) {
        put_entry(k, figure->points, "#0072B2", "●");
    }
}

static void put_drawing(gonio_i_figure_output *output, const gonio_i_regions *figure)
{
    FILE *s = output->script;
    key k = {.width = PANEL_WIDTH * (int)figure->count};
    put_key(&k, figure);
    k = (key){.script = s, .width = k.width, .height = PANEL_HEIGHT + KEY_ROW * (k.row + 1)};
    gonio_i_figure_output_begin_drawing(output, k.width, k.height);
    put_key(&k, figure);
    fputs("  unset key\n", s);
    gonio_i_begin_panels(s, figure->count, (double)(KEY_ROW * (k.row + 2)) / k.height,
                         figure->title);
    for (size_t p = 0; p < figure->count; p++) {
        put_panel(s, figure, p);
        for (int e = 0; p == 0 && e < 2 * k.entries; e++) {
            fprintf(s, "  unset label %d\n", KEY_LABELS + e);
        }
    }
    gonio_i_end_panels(s);
    gonio_i_figure_output_end_drawing(output);
}

gonio_status gonio_i_figure_regions(gonio_context *context, gonio_i_figures *figures,
                                    const gonio_i_regions *figure)
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
    fprintf(output.script, "\ndata = '%s.csv'\n", figure->name);
    fputs(hemisphere, output.script);
    put_drawing(&output, figure);
    return gonio_i_figure_output_end(&output, figures, GONIO_OK);
}
