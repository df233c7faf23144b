/* What the lines of tables with angles along both sides are, and which units they state: see
 * crossed.h. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include <gonio/measurement.h>

#include "crossed.h"
#include "csv_factor_names.h"

static const char separators[] = "\t;, ";

/* ---- kinds of lines ---- */

static char separator_of(gonio_i_line l)
{
    for (size_t k = 0; separators[k] != '\0'; k++) {
        if (gonio_i_count_cells(l, separators[k]) > 1) {
            return separators[k];
        }
    }
    return '\0';
}

/* Whether all cells but empty ones are numbers, and there are any; *least: the least. */
static bool are_numbers(gonio_i_line rest, char separator, double *least)
{
    gonio_i_line cell;
    bool all = true;
    size_t count = 0;
    *least = INFINITY;
    while (all && gonio_i_next_cell(&rest, separator, &cell)) {
        double number = 0.0;
        if (cell.length > 0) {
            all = gonio_i_cell_number(cell, separator, &number);
            *least = fmin(*least, number);
            count++;
        }
    }
    return all && count > 1;
}

static bool are_geometries(gonio_i_line rest, char separator)
{
    gonio_i_line cell;
    gonio_i_settings s;
    bool all = true;
    size_t count = 0;
    while (all && gonio_i_next_cell(&rest, separator, &cell)) {
        all = cell.length == 0 || gonio_i_geometry_of(cell, &s);
        count += cell.length > 0;
    }
    return all && count > 0;
}

/* A line of names: the first cell is no number. */
static gonio_i_crossed_kind kind_of_names(gonio_i_crossed_line *t, gonio_i_line corner,
                                          gonio_i_line rest)
{
    const bool numbers = are_numbers(rest, t->separator, &t->number);
    if (gonio_i_axes_of_corner(corner, &t->down, &t->across)) {
        return numbers ? GONIO_I_CORNER_LINE : GONIO_I_OTHER_LINE;
    }
    t->down = gonio_i_axis_of(corner);
    if (t->down.index == GONIO_I_WAVELENGTH_AXIS && !(numbers && t->number < GONIO_I_LEAST_LIGHT)) {
        return are_geometries(rest, t->separator) ? GONIO_I_NAMED_LINE : GONIO_I_BEGIN_LINE;
    }
    return !numbers             ? GONIO_I_OTHER_LINE
           : t->down.index >= 0 ? GONIO_I_STACKED_LINE
           : gonio_i_unquoted(corner).length == 0 || t->down.index == GONIO_I_WAVELENGTH_AXIS
               ? GONIO_I_BARE_LINE
               : GONIO_I_OTHER_LINE;
}

/* The separator behind an empty first cell, which is no comment mark; 0: the first has something.
 */
static char begins_empty(gonio_i_line l)
{
    const char first = l.length > 0 ? *l.at : '\0';
    const bool empty = first == '\t' || (first == ';' && l.length > 1 &&
                                         memchr(l.at + 1, ';', l.length - 1) != NULL);
    return empty ? first : '\0';
}

/* Without empty cells at the end. */
static void trim(gonio_i_crossed_line *t)
{
    while (t->text.length > 0 && (t->text.at[t->text.length - 1] == t->separator ||
                                  strchr(" \t", t->text.at[t->text.length - 1]) != NULL)) {
        t->text.length--;
    }
    t->cells = gonio_i_count_cells(t->text, t->separator);
}

gonio_i_crossed_line gonio_i_crossed_take(gonio_i_line l)
{
    const char *mark = NULL;
    if (l.length >= 3 && memcmp(l.at, "\xef\xbb\xbf", 3) == 0) {
        l = (gonio_i_line){l.at + 3, l.length - 3}; /* a byte-order mark */
    }
    gonio_i_crossed_line t = {.text = gonio_i_without_mark(l, &mark)};
    gonio_i_line rest = t.text;
    gonio_i_line corner = {NULL, 0};
    double number = 0.0;
    const char first = begins_empty(l);
    t.separator = first != '\0' ? first : separator_of(rest);
    rest = first != '\0' ? l : rest;
    t.text = rest;
    if (t.separator == '\0') {
        t.kind = gonio_i_setting_of(t.text, &t.down, &t.number) ? GONIO_I_SETTING_LINE
                                                                : GONIO_I_OTHER_LINE;
        return t;
    }
    t.cells = gonio_i_count_cells(rest, t.separator);
    gonio_i_next_cell(&rest, t.separator, &corner);
    if (gonio_i_cell_number(corner, t.separator, &number)) {
        t.kind = mark == NULL ? GONIO_I_ROW_LINE : GONIO_I_OTHER_LINE;
        return t;
    }
    t.kind = kind_of_names(&t, corner, rest);
    if (t.kind != GONIO_I_STACKED_LINE && t.kind != GONIO_I_BEGIN_LINE) {
        trim(&t);
    }
    if ((t.kind == GONIO_I_OTHER_LINE || t.kind == GONIO_I_BEGIN_LINE) &&
        gonio_i_setting_of(t.text, &t.down, &t.number)) {
        t.kind = GONIO_I_SETTING_LINE;
    }
    return t;
}

/* ---- units ---- */

const char *gonio_i_crossed_key(const char *text, const char *key)
{
    const size_t length = strlen(key);
    if (strncasecmp(text, key, length) != 0 || text[length] == '\0' ||
        strchr(":=,;\t ", text[length]) == NULL) {
        return NULL;
    }
    return text + length + strspn(text + length, ":=,;\t ");
}

typedef struct units {
    const gonio_i_readings_file *file;
    gonio_convention *stated;
    size_t line;
} units;

static gonio_status agree(const units *u, const char *what, int unit, int *stated)
{
    if (unit != 0 && *stated != 0 && unit != *stated) {
        return gonio_i_fail(u->file->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: another unit of %s than in the lines above", u->file->path,
                            u->line, what);
    }
    *stated = unit != 0 ? unit : *stated;
    return GONIO_OK;
}

static gonio_status take_axis(const units *u, const gonio_i_axis *axis)
{
    const bool wavelength = axis->index == GONIO_I_WAVELENGTH_AXIS;
    const bool angle = axis->index >= 0;
    return wavelength ? agree(u, "wavelengths", axis->unit, &u->stated->wavelengths)
           : angle    ? agree(u, "angles", axis->unit, &u->stated->angles)
                      : GONIO_OK;
}

/* What is said of values: behind a key, or by a line that is a name of values. */
static const char *text_on_values(const char *text)
{
    static const char *const keys[] = {"values", "value unit", "units", "unit", "quantity", "data"};
    const char *behind = NULL;
    for (size_t k = 0; k < sizeof keys / sizeof *keys && behind == NULL; k++) {
        behind = gonio_i_crossed_key(text, keys[k]);
    }
    const gonio_i_column_name name = gonio_i_column_name_of(text);
    const bool named = name.kind == GONIO_I_VALUE && name.strength >= GONIO_I_LIKELY &&
                       name.family == GONIO_I_UNNAMED;
    return behind != NULL ? behind : named ? text : NULL;
}

static gonio_status take_text(const units *u, gonio_i_line l)
{
    char text[128];
    if (!gonio_i_line_text(l, sizeof text, text)) {
        return GONIO_OK;
    }
    if (strcasestr(text, "btdf") != NULL || strcasestr(text, "transmi") != NULL) {
        return gonio_i_fail(u->file->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: a table of transmission; gonio reads reflection",
                            u->file->path, u->line);
    }
    const char *values = text_on_values(text);
    const int scale = values != NULL ? gonio_i_value_scale_in(values) : 0;
    gonio_status status = GONIO_OK;
    char rest[128];
    double factor = 0.0;
    if (values != NULL && scale == 0 && gonio_i_value_kind_in(values) != 0 &&
        (gonio_i_take_factor(values, sizeof rest, rest, &factor) ||
         gonio_i_names_product(values))) {
        return gonio_i_fail(u->file->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: values with a factor are not read in such a table; multiply "
                            "them",
                            u->file->path, u->line);
    }
    if (values != NULL) {
        status = agree(u, "values", gonio_i_value_kind_in(values), &u->stated->values);
        u->stated->scale = scale != 0 ? scale : u->stated->scale;
    }
    if (status == GONIO_OK && values != NULL && values != text) {
        status = agree(u, "angles", gonio_i_angle_unit_in(values), &u->stated->angles);
    }
    return status;
}

/* "wavelength_nm,R [%],R [%]": what the second cell says of values. */
static gonio_status take_unit_of_column(const units *u, const gonio_i_crossed_line *t)
{
    gonio_i_line rest = t->text;
    gonio_i_line cell = {"", 0};
    char text[128];
    gonio_i_next_cell(&rest, t->separator, &cell);
    gonio_i_next_cell(&rest, t->separator, &cell);
    return gonio_i_line_text(cell, sizeof text, text)
               ? agree(u, "values", gonio_i_value_kind_in(text), &u->stated->values)
               : GONIO_OK;
}

gonio_status gonio_i_crossed_units(const gonio_i_readings_file *file, gonio_convention *stated)
{
    units u = {file, stated, 0};
    const char *at = file->text;
    gonio_i_line l;
    gonio_status status = GONIO_OK;
    while (status == GONIO_OK && gonio_i_next_line(&at, file->text + file->size, &l)) {
        const gonio_i_crossed_line t = gonio_i_crossed_take(l);
        u.line++;
        if (t.kind == GONIO_I_OTHER_LINE) {
            status = take_text(&u, t.text);
        } else if (t.kind != GONIO_I_ROW_LINE && t.kind != GONIO_I_BARE_LINE) {
            status = take_axis(&u, &t.down);
        }
        if (status == GONIO_OK && t.kind == GONIO_I_BEGIN_LINE) {
            status = take_unit_of_column(&u, &t);
        }
        if (status == GONIO_OK && t.kind == GONIO_I_CORNER_LINE) {
            status = take_axis(&u, &t.across);
        }
    }
    stated->angles = stated->angles != 0 ? stated->angles : GONIO_DEGREES;
    return status;
}
