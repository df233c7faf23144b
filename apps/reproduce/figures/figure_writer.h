/* A figure while it is written: its data and script as texts, then the files. Shared by the kinds
 * of figures (curves.c, map.c ...). */
#ifndef GONIO_REPRODUCE_FIGURE_WRITER_H
#define GONIO_REPRODUCE_FIGURE_WRITER_H

#include <locale.h>
#include <math.h>
#include <stdio.h>

#include "figure.h"

typedef struct gonio_i_figure_output {
    gonio_context *context;
    const char *name;
    FILE *data;   /* the CSV file */
    FILE *script; /* the gnuplot script */
    char *data_text, *script_text;
    size_t data_size, script_size;
    locale_t plain, before;
} gonio_i_figure_output;

/* Begins both texts: the script up to where axes are set. Until the end, numbers are printed with
 * decimal points. Errors: _ARGUMENT for a name that cannot be a file's, _MEMORY. */
gonio_status gonio_i_figure_output_begin(gonio_context *context, const char *name,
                                         const char *title, gonio_i_figure_output *output);

/* Between these two the script is run once for each format; sizes in pixels of 1/96 inch. */
void gonio_i_figure_output_begin_drawing(gonio_i_figure_output *output, int width, int height);
void gonio_i_figure_output_end_drawing(gonio_i_figure_output *output);

/* If `status` is GONIO_OK, writes the files and has them drawn; releases all in any case. */
gonio_status gonio_i_figure_output_end(gonio_i_figure_output *output, gonio_i_figures *figures,
                                       gonio_status status);

/* Panels side by side, above a share `bottom` of the drawing, below a title unless it is NULL. Each
 * is one plot of the script; gonio_i_end_panels follows. */
void gonio_i_begin_panels(FILE *script, size_t count, double bottom, const char *title);
void gonio_i_end_panels(FILE *script);

/* Text in quotes, as gnuplot takes it literally. */
void gonio_i_put_quoted(FILE *script, const char *text);

/* The same for a label of a tic, which gnuplot takes as a format and cuts at 50 bytes. */
enum { GONIO_I_LONGEST_TIC = 40 };
void gonio_i_put_tic(FILE *script, const char *text);

/* A cell of text, and one of a number (what is not finite is NaN). */
void gonio_i_put_cell(FILE *data, const char *text);
void gonio_i_put_number(FILE *data, double value);

/* "name (unit)", as a cell. */
void gonio_i_put_heading(FILE *data, const gonio_i_axis *axis);

/* The least and the greatest of an axis's values. */
typedef struct gonio_i_range {
    double low, high; /* low > high for none */
} gonio_i_range;

#define GONIO_I_NO_RANGE                                                                           \
    {                                                                                              \
        HUGE_VAL, -HUGE_VAL                                                                        \
    }

/* Widens the range by the values; those that are not finite do not matter. NULL is no values.
 * _DATA for values that the axis cannot show. */
gonio_status gonio_i_find_range(gonio_context *context, const char *figure,
                                const gonio_i_axis *axis, const double *values, size_t count,
                                gonio_i_range *range);

/* Label, range and tics of an axis, which is x, y or cb; `range` is its values'. */
void gonio_i_put_axis(FILE *script, const char *axis, const gonio_i_axis *a,
                      const gonio_i_range *range);

#endif
