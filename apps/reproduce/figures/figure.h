/* Figures by gnuplot. A figure is FOLDER/NAME.csv, the data with a line of column names and units,
 * and a script NAME.gp. `gnuplot NAME.gp` in that folder makes NAME.svg, .pdf and .png; people may
 * edit the script. All files appear whole or not at all. The same data give the same bytes.
 *
 * Text (names, titles, units) is UTF-8 with any content. It is shown as it is, except for control
 * characters, bytes that are not UTF-8, and straight quotes, which become typographic ones. Numbers
 * that are not finite are missing values. Colours are those of Okabe and Ito (2008), which
 * colour-blind people can distinguish; markers and dashes differ too.
 *
 * Errors of all: _ARGUMENT for a file name with other characters than letters, digits, '-' and '_',
 * or nothing to show; _DATA for values that a logarithmic axis cannot show; _IO, also if gnuplot
 * fails, with its message; _MEMORY. Without gnuplot, a note says how to draw later. */
#ifndef GONIO_REPRODUCE_FIGURE_H
#define GONIO_REPRODUCE_FIGURE_H

#include <gonio/direction.h>

#include "core/core.h"

/* The folder of figures. */
typedef struct gonio_i_figures {
    const char *folder; /* created if necessary; its parent must exist */
    bool undrawn;       /* set if there is no gnuplot: only data and scripts are written */
} gonio_i_figures;

typedef struct gonio_i_axis {
    const char *name;
    const char *unit; /* NULL for a plain number */
    bool logarithmic;
    double low, high; /* the range; from the data if both are 0 */
} gonio_i_axis;

/* ---- curves: y against x ---- */

typedef enum gonio_i_interval_style {
    GONIO_I_NO_INTERVALS,
    GONIO_I_BAND,      /* a light band from low to high */
    GONIO_I_ERROR_BARS /* a bar from low to high at each point */
} gonio_i_interval_style;

typedef struct gonio_i_curve {
    const char *name; /* in the key; NULL to leave it out */
    size_t count;
    const double *x, *y;      /* [count] */
    const double *low, *high; /* [count]; the interval of each point, or NULL */
    bool faint;               /* thin and grey: one of many similar curves */
} gonio_i_curve;

typedef struct gonio_i_curves {
    const char *name;  /* of the files */
    const char *title; /* NULL for none; so in all figures */
    gonio_i_axis x, y;
    gonio_i_interval_style intervals;
    size_t count;
    const gonio_i_curve *curves;
    double apart; /* if not 0, how far each curve is drawn to the right of the one before, so that
                   * error bars do not hide each other; on a logarithmic axis a factor */
    bool dots;    /* a small dot at each point in place of markers */
} gonio_i_curves;

gonio_status gonio_i_figure_curves(gonio_context *context, gonio_i_figures *figures,
                                   const gonio_i_curves *figure);

/* ---- a map: a value on a grid, as coloured cells with contour lines ---- */

typedef struct gonio_i_mark {
    double x, y;
    const char *name;
} gonio_i_mark;

typedef struct gonio_i_map {
    const char *name;
    const char *title;
    gonio_i_axis x, y, value; /* the ranges of x and y are the grid's */
    size_t columns, rows;     /* at least 2 of each */
    const double *at_x;       /* [columns], ascending */
    const double *at_y;       /* [rows], ascending */
    const double *values;     /* [columns][rows] */
    size_t levels;            /* 0: chosen by gnuplot */
    const double *level;      /* where the contour lines are */
    size_t marks;
    const gonio_i_mark *mark; /* points worth showing */
} gonio_i_map;

gonio_status gonio_i_figure_map(gonio_context *context, gonio_i_figures *figures,
                                const gonio_i_map *figure);

/* ---- light and view directions on the hemisphere, seen from above; panels side by side ---- */

typedef enum gonio_i_projection {
    GONIO_I_EQUAL_ANGLE, /* the radius is theta */
    GONIO_I_ORTHOGRAPHIC /* the radius is sin(theta) */
} gonio_i_projection;

typedef struct gonio_i_panel {
    const char *name;
    size_t count;
    const gonio_pair *pairs; /* [count] */
} gonio_i_panel;

typedef struct gonio_i_directions {
    const char *name;
    const char *title;
    gonio_i_projection projection;
    size_t count;
    const gonio_i_panel *panels;
} gonio_i_directions;

gonio_status gonio_i_figure_directions(gonio_context *context, gonio_i_figures *figures,
                                       const gonio_i_directions *figure);

/* ---- regions of the hemisphere for a direction of the light, seen from above; panels side by side
 * ---- */

typedef struct gonio_i_region_panel {
    const char *name;
    gonio_angles light; /* marked by a cross */
    const int *region;  /* [rings][spokes]: of the cell around theta = 90 (ring + 1/2) / rings and
                         * phi = 360 spoke / spokes degrees */
    size_t count;
    const gonio_angles *point; /* [count], marked by dots */
} gonio_i_region_panel;

typedef struct gonio_i_regions {
    const char *name;
    const char *title;
    size_t rings, spokes;
    size_t regions;
    const char *const *region; /* [regions], in the key; the first is a pale ground */
    const char *points;        /* what the dots are; NULL for no dots */
    size_t count;
    const gonio_i_region_panel *panels;
} gonio_i_regions;

gonio_status gonio_i_figure_regions(gonio_context *context, gonio_i_figures *figures,
                                    const gonio_i_regions *figure);

/* ---- many categories, each with a point of every series ---- */

typedef struct gonio_i_series {
    const char *name;
    const double *values; /* [categories] */
} gonio_i_series;

typedef struct gonio_i_categories {
    const char *name;
    const char *title;
    const char *kind; /* what the categories are: "material" */
    gonio_i_axis y;
    size_t categories;
    const char *const *category; /* [categories]: their names */
    size_t count;
    const gonio_i_series *series;
    size_t sorted_by; /* the series that ascends */
} gonio_i_categories;

gonio_status gonio_i_figure_categories(gonio_context *context, gonio_i_figures *figures,
                                       const gonio_i_categories *figure);

#endif
