/* Readings as tables whose rows and columns both say where or at which wavelength a value was read
 * (crossed.h). Lines of one angle or wavelength hold until the next such line, so that a file may
 * have a table for each incidence or wavelength. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../../core/csv_reader.h"
#include "../import.h"
#include "../long_table.h"
#include "crossed.h"
#include "csv_geometry.h"
#include "csv_numbers.h"
#include "format.h"

enum { MOST_LINES = 200, ONE_TURN = 360, TAKEN_ROOM = 256 };

/* ---- recognition ---- */

static bool recognises(const char *text, size_t size)
{
    const char *at = text;
    gonio_i_line l;
    bool stacked = false;
    gonio_i_crossed_line before = {0};
    if (size == 0 || memchr(text, '\0', size) != NULL) {
        return false;
    }
    for (size_t k = 0; k < MOST_LINES && gonio_i_next_line(&at, text + size, &l); k++) {
        if (gonio_i_trimmed(l).length == 0) {
            continue;
        }
        const gonio_i_crossed_line t = gonio_i_crossed_take(l);
        if (t.kind == GONIO_I_CORNER_LINE || t.kind == GONIO_I_NAMED_LINE) {
            return true;
        }
        if (t.kind == GONIO_I_ROW_LINE) {
            return (before.kind == GONIO_I_STACKED_LINE || before.kind == GONIO_I_BARE_LINE ||
                    before.kind == GONIO_I_BEGIN_LINE) &&
                   stacked && t.cells == before.cells;
        }
        stacked = stacked || ((t.kind == GONIO_I_STACKED_LINE || t.kind == GONIO_I_BARE_LINE) &&
                              t.number < GONIO_I_LEAST_LIGHT);
        before = t;
    }
    return false;
}

/* ---- reading ---- */

/* The first value of a table: where it is. */
typedef struct beginning {
    size_t line; /* 0: no row yet */
    gonio_i_settings row, column;
} beginning;

typedef struct source {
    gonio_context *context;
    const char *path;
    gonio_i_import in;
    gonio_readings *readings;
    gonio_i_long_table table;
    size_t line;
    size_t columns;
    gonio_i_settings *column;    /* [columns] */
    gonio_i_crossed_kind header; /* the last line of names; GONIO_I_OTHER_LINE: none yet */
    gonio_i_crossed_kind before; /* the line before */
    size_t stacked;              /* lines of it */
    gonio_i_axis down;           /* along rows */
    gonio_i_axis across;         /* of a GONIO_I_CORNER_LINE or GONIO_I_BARE_LINE header, and of one
                                    GONIO_I_STACKED_LINE line */
    gonio_i_axis rows_are, columns_are; /* by keys of the file */
    beginning past, present;            /* of the table before, and of this one */
    gonio_i_settings now;               /* by lines of one number */
    gonio_i_settings row;
    bool unit_stated;          /* that of values */
    gonio_i_geometry geometry; /* of the value read last */
    char taken_as[TAKEN_ROOM];
    bool unlit;                   /* the light's azimuth is not told */
    bool named;                   /* geometries by aspecular angles */
    bool any_wavelength, any_not; /* values with one, and without */
} source;

static gonio_status refuse(const source *s, const char *problem)
{
    return gonio_i_fail(s->context, GONIO_ERROR_FORMAT, "%s:%zu: %s", s->path, s->line, problem);
}

/* Sets an angle or the wavelength. */
static void set(const source *s, gonio_i_settings *settings, int axis, double number)
{
    if (axis == GONIO_I_WAVELENGTH_AXIS) {
        settings->wavelength = number;
    } else if (axis >= 0) {
        settings->bits |= 1U << axis;
        settings->angle[axis] = gonio_i_import_degrees(&s->in, number);
    }
}

/* Begins a header of so many columns. */
static gonio_status begin_columns(source *s, const gonio_i_crossed_line *t)
{
    free(s->column);
    s->past = s->present.line > 0 ? s->present : s->past;
    s->present = (beginning){0};
    s->columns = t->cells - 1;
    s->column = gonio_i_allocate(s->context, s->columns, sizeof *s->column);
    s->stacked = 0;
    s->down = s->rows_are;
    s->across = s->columns_are;
    return s->column != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* Takes the number of each column. A cell that is empty is as the one before, as spreadsheets write
 * joined cells. */
static gonio_status take_numbers(source *s, const gonio_i_crossed_line *t, int axis)
{
    gonio_i_line rest = t->text;
    gonio_i_line cell;
    double number = NAN;
    gonio_i_next_cell(&rest, t->separator, &cell);
    for (size_t k = 0; k < s->columns && gonio_i_next_cell(&rest, t->separator, &cell); k++) {
        if (cell.length > 0 && !gonio_i_cell_number(cell, t->separator, &number)) {
            return refuse(s, "a number above each column is expected");
        }
        if (isnan(number)) {
            return refuse(s, "the first column has no number above it");
        }
        set(s, &s->column[k], axis, number);
    }
    return GONIO_OK;
}

static gonio_status check_unit(const source *s)
{
    return !s->named || s->unit_stated ? GONIO_OK : gonio_i_refuse_aspecular(s->context, s->path);
}

static gonio_status take_geometries(source *s, const gonio_i_crossed_line *t)
{
    gonio_i_line rest = t->text;
    gonio_i_line cell;
    gonio_i_next_cell(&rest, t->separator, &cell);
    for (size_t k = 0; k < s->columns && gonio_i_next_cell(&rest, t->separator, &cell); k++) {
        if (!gonio_i_geometry_of(cell, &s->column[k])) {
            return refuse(s, "a geometry such as 45/0 or 45as15 above each column is expected");
        }
        s->named = s->named || (s->column[k].bits & 1U << GONIO_I_ASPECULAR) != 0;
    }
    return check_unit(s);
}

/* Says what is missing of a table whose axes are not told. */
static gonio_status refuse_axes(const source *s)
{
    return refuse(s,
                  "a table of values with numbers along both sides, of which it is not said what "
                  "they are; name rows and columns in its corner cell, such as theta_o\\phi_o, "
                  "and give the incidence in a line such as theta_i = 30 above it");
}

/* Takes one line of numbers above columns, of which the corner names rows or columns. */
static gonio_status take_bare(source *s, const gonio_i_crossed_line *t)
{
    gonio_status status = begin_columns(s, t);
    if (t->down.index == GONIO_I_WAVELENGTH_AXIS) {
        s->down = t->down;
    }
    if (status == GONIO_OK && s->across.index == GONIO_I_NO_AXIS &&
        t->kind == GONIO_I_STACKED_LINE) {
        s->across = t->down; /* if more such lines follow, or wavelengths in rows */
        s->stacked = 1;
    }
    return status != GONIO_OK                   ? status
           : s->across.index == GONIO_I_NO_AXIS ? refuse_axes(s)
                                                : take_numbers(s, t, s->across.index);
}

static gonio_status take_header(source *s, const gonio_i_crossed_line *t)
{
    const bool more = t->kind == GONIO_I_STACKED_LINE && s->before == GONIO_I_STACKED_LINE &&
                      t->cells == s->columns + 1;
    gonio_status status = GONIO_OK;
    if (more) {
        s->stacked++;
        status = take_numbers(s, t, t->down.index);
    } else if (t->kind == GONIO_I_BEGIN_LINE) {
        s->down = t->down;
    } else if (t->kind == GONIO_I_STACKED_LINE || t->kind == GONIO_I_BARE_LINE) {
        status = take_bare(s, t);
    } else {
        status = begin_columns(s, t);
        s->down = t->down;
        s->across = t->kind == GONIO_I_CORNER_LINE ? t->across : s->columns_are;
        status = status != GONIO_OK              ? status
                 : t->kind == GONIO_I_NAMED_LINE ? take_geometries(s, t)
                                                 : take_numbers(s, t, t->across.index);
    }
    s->header = t->kind;
    return status;
}

/* ---- values ---- */

/* How the known angles give directions; -1 if they do not. A detector's azimuth without the light's
 * is counted from the light. */
static int geometry_of(unsigned bits)
{
    const bool in = (bits & 1U) != 0;
    const bool out = (bits & 4U) != 0;
    const bool azimuth = (bits & 8U) != 0;
    const bool difference = (bits & 1U << GONIO_I_AZIMUTH_DIFFERENCE) != 0;
    if (in && !out && !azimuth && !difference) {
        return (bits & 1U << GONIO_I_ASPECULAR) != 0       ? GONIO_I_TOWARDS_LIGHT
               : (bits & 1U << GONIO_I_FROM_SPECULAR) != 0 ? GONIO_I_FROM_THE_NORMAL
                                                           : -1;
    }
    return !in || !out                    ? -1
           : azimuth && !difference       ? GONIO_I_FOUR_ANGLES
           : difference && !azimuth       ? GONIO_I_DIFFERENCE_GIVES_PHI_O
           : !azimuth && (bits & 2U) == 0 ? GONIO_I_IN_PLANE
                                          : -1;
}

static void join(gonio_i_settings *to, const gonio_i_settings *from)
{
    for (size_t k = 0; k < GONIO_I_SETTINGS; k++) {
        to->angle[k] = (from->bits & 1U << k) != 0 ? from->angle[k] : to->angle[k];
    }
    to->bits |= from->bits;
    to->wavelength = from->wavelength > 0.0 ? from->wavelength : to->wavelength;
}

static gonio_status refuse_directions(const source *s, unsigned bits)
{
    return refuse(s, (bits & 1U) == 0
                         ? "no angle of incidence: give it in a line such as theta_i = 30 above"
                         : "the angles of rows, columns and the lines above do not make two "
                           "directions; theta_i, theta_o and phi_o are needed, or theta_i and "
                           "theta_o in the plane of incidence");
}

static gonio_status add_value(source *s, const gonio_i_settings *known, double value)
{
    gonio_i_long_row row = {.value = value, .deviation = NAN, .line = s->line};
    double cell[GONIO_I_ANGLE_COLUMNS] = {0};
    const int geometry = geometry_of(known->bits);
    if (geometry < 0) {
        return refuse_directions(s, known->bits);
    }
    s->geometry = (gonio_i_geometry)geometry;
    s->unlit = s->unlit || (geometry == GONIO_I_FOUR_ANGLES && (known->bits & 2U) == 0);
    memcpy(cell, known->angle, sizeof known->angle);
    const char *problem =
        gonio_i_geometry_take((gonio_i_geometry)geometry, s->in.how.mirror, cell, row.degrees);
    row.wavelength = known->wavelength;
    s->any_wavelength = s->any_wavelength || known->wavelength > 0.0;
    s->any_not = s->any_not || known->wavelength == 0.0;
    return problem != NULL ? refuse(s, problem) : gonio_i_long_table_add(&s->table, &row);
}

/* The value of a cell; NaN for one that was not read. */
static gonio_status take_value(const source *s, gonio_i_line cell, char separator, double *value)
{
    char text[64];
    cell = gonio_i_unquoted(cell);
    if (gonio_i_line_text(cell, sizeof text, text)) {
        if (gonio_i_csv_is_empty(text) || gonio_i_csv_is_mark(text)) {
            *value = NAN;
            return GONIO_OK;
        }
        if (gonio_i_csv_is_number(text, separator, value) && isfinite(*value)) {
            return GONIO_OK;
        }
    }
    return gonio_i_fail(s->context, GONIO_ERROR_FORMAT, "%s:%zu: '%.*s' is not a finite number",
                        s->path, s->line, (int)(cell.length < 40 ? cell.length : 40), cell.at);
}

/* What the first cells of rows are, where no name says it: numbers beyond one turn are wavelengths.
 */
static gonio_status find_rows(source *s, double first)
{
    const bool wavelength = first > ONE_TURN && s->stacked > 0;
    if (s->down.index == GONIO_I_NO_AXIS && wavelength) {
        s->down = (gonio_i_axis){GONIO_I_WAVELENGTH_AXIS, 0};
    }
    return s->down.index != GONIO_I_NO_AXIS ? GONIO_OK : refuse_axes(s);
}

static gonio_status refuse_cells(const source *s, const gonio_i_crossed_line *t)
{
    return gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                        "%s:%zu: %zu cells where the line of columns has %zu", s->path, s->line,
                        t->cells, s->columns + 1);
}

static bool are_same(const gonio_i_settings *a, const gonio_i_settings *b)
{
    bool same = a->bits == b->bits && a->wavelength == b->wavelength;
    for (size_t k = 0; k < GONIO_I_SETTINGS && same; k++) {
        same = a->angle[k] == b->angle[k];
    }
    return same;
}

/* Refuses a table that begins as the one before it: it has something else of the same directions.
 */
static gonio_status check_table(source *s, const gonio_i_settings *row)
{
    const beginning *past = &s->past;
    if (s->present.line > 0) {
        return GONIO_OK;
    }
    s->present = (beginning){s->line, *row, s->column[0]};
    return past->line == 0 || !are_same(&past->row, row) || !are_same(&past->column, &s->column[0])
               ? GONIO_OK
               : gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                              "%s:%zu: the directions of the table of line %zu again; no line says "
                              "what differs; keep one of them",
                              s->path, s->line, past->line);
}

static gonio_status take_row(source *s, const gonio_i_crossed_line *t)
{
    gonio_i_line rest = t->text;
    gonio_i_line cell;
    double number = 0.0;
    if (s->header == GONIO_I_OTHER_LINE) {
        return refuse_axes(s);
    }
    if (t->cells < s->columns + 1) {
        return refuse_cells(s, t);
    }
    gonio_i_next_cell(&rest, t->separator, &cell);
    gonio_i_cell_number(cell, t->separator, &number);
    gonio_status status = find_rows(s, number);
    gonio_i_settings row = s->now;
    if (status == GONIO_OK) {
        set(s, &row, s->down.index, number);
        status = check_table(s, &row);
    }
    for (size_t k = 0; status == GONIO_OK && gonio_i_next_cell(&rest, t->separator, &cell); k++) {
        gonio_i_settings known = row;
        if (k >= s->columns) {
            status = cell.length > 0 ? refuse_cells(s, t) : GONIO_OK;
            continue;
        }
        join(&known, &s->column[k]);
        status = take_value(s, cell, t->separator, &number);
        status = status == GONIO_OK ? add_value(s, &known, number) : status;
    }
    return status;
}

/* ---- other lines ---- */

/* Takes what rows and columns are from lines with a key. */
static void take_key(source *s, gonio_i_line l)
{
    char text[128];
    if (!gonio_i_line_text(l, sizeof text, text)) {
        return;
    }
    const char *rows = gonio_i_crossed_key(text, "rows");
    const char *columns = gonio_i_crossed_key(text, "columns");
    if (rows != NULL) {
        s->rows_are = gonio_i_axis_of((gonio_i_line){rows, strlen(rows)});
    }
    if (columns != NULL) {
        s->columns_are = gonio_i_axis_of((gonio_i_line){columns, strlen(columns)});
    }
}

static gonio_status take(source *s, gonio_i_line l)
{
    const gonio_i_crossed_line t = gonio_i_crossed_take(l);
    gonio_status status = GONIO_OK;
    switch (t.kind) {
    case GONIO_I_ROW_LINE:
        status = take_row(s, &t);
        break;
    case GONIO_I_SETTING_LINE:
        set(s, &s->now, t.down.index, t.number);
        break;
    case GONIO_I_OTHER_LINE:
        take_key(s, t.text);
        break;
    default:
        status = take_header(s, &t);
    }
    if ((t.kind == GONIO_I_SETTING_LINE || t.kind == GONIO_I_OTHER_LINE) && status == GONIO_OK &&
        !gonio_i_comments_add_text(&s->readings->comment, t.text.at, t.text.length)) {
        return gonio_i_fail(s->context, GONIO_ERROR_MEMORY, "%s: out of memory", s->path);
    }
    s->before = t.kind == GONIO_I_SETTING_LINE || t.kind == GONIO_I_OTHER_LINE ? s->before : t.kind;
    return status;
}

/* ---- the file as a whole ---- */

static const char *axis_word(int index)
{
    static const char *const words[GONIO_I_SETTINGS] = {
        "theta_i",
        "phi_i",
        "theta_o",
        "phi_o",
        [GONIO_I_AZIMUTH_DIFFERENCE] = "phi_o - phi_i",
        [GONIO_I_FROM_SPECULAR] = "angle from the mirror direction",
        [GONIO_I_ASPECULAR] = "aspecular angle"};
    return index >= 0 && words[index] != NULL ? words[index]
           : index == GONIO_I_WAVELENGTH_AXIS ? "wavelength"
                                              : "geometry";
}

/* What the file was taken for. */
static void describe(source *s)
{
    const bool one = s->across.index != GONIO_I_NO_AXIS && s->stacked < 2;
    snprintf(s->taken_as, sizeof s->taken_as, "a table of %s in rows, %s in columns%s%s",
             axis_word(s->down.index), one ? axis_word(s->across.index) : "geometries",
             gonio_i_geometry_words(s->geometry, s->in.how.mirror),
             s->unlit ? ", the light at phi 0" : "");
}

static gonio_status finish(source *s)
{
    if (s->any_wavelength && s->any_not) {
        return gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                            "%s: some values have a wavelength and some have none", s->path);
    }
    for (size_t k = 0; k < s->table.count && s->any_not; k++) {
        s->table.row[k].wavelength = 0.0; /* the only channel */
    }
    s->table.numbered = s->any_not ? 1 : 0;
    describe(s);
    return gonio_i_long_table_import(&s->table, &s->in);
}

static gonio_status take_lines(source *s, const char *text, size_t size)
{
    const char *at = text;
    gonio_i_line l;
    gonio_status status = GONIO_OK;
    while (status == GONIO_OK && gonio_i_next_line(&at, text + size, &l)) {
        s->line++;
        if (gonio_i_trimmed(l).length > 0) {
            status = take(s, l);
        }
    }
    return status == GONIO_OK ? finish(s) : status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    source s = {.context = file->context, .path = file->path, .readings = readings};
    gonio_convention stated = {0};
    gonio_status status = gonio_i_crossed_units(file, &stated);
    if (status == GONIO_OK && stated.angles == GONIO_I_DEGREES_OR_GRADIANS &&
        readings->options.as.angles == GONIO_AS_STATED) {
        status = gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                              "%s: angles in 'grad' are degrees or gradians: use --as "
                              "angles=degrees or --as angles=gon",
                              file->path);
    }
    if (status != GONIO_OK) {
        return status;
    }
    s.table.context = file->context;
    s.rows_are.index = s.columns_are.index = s.down.index = GONIO_I_NO_AXIS;
    s.unit_stated = stated.values != 0 || readings->options.as.values != GONIO_AS_STATED;
    stated.values = stated.values != 0            ? stated.values
                    : readings->usual_values != 0 ? readings->usual_values
                                                  : GONIO_VALUE_BRDF;
    gonio_i_import_begin(&s.in, file->context, readings, s.taken_as, &stated);
    gonio_i_import_leniently(&s.in);
    status = take_lines(&s, file->text, file->size);
    gonio_i_long_table_free(&s.table);
    free(s.column);
    return gonio_i_import_end(&s.in, status);
}

const gonio_i_readings_format gonio_i_readings_crossed = {.word = "crossed",
                                                          .name = "Table of angles by angles or "
                                                                  "wavelengths",
                                                          .recognises = recognises,
                                                          .read = read};
