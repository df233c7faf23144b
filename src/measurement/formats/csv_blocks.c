/* Scans in blocks, made a table: see csv_blocks.h. */
#include "csv_blocks.h"

#include <stdio.h>
#include <string.h>

#include <gonio/measurement.h>

#include "../../core/csv_reader.h"
#include "crossed.h"
#include "csv_cells.h"
#include "csv_names.h"

enum { MOST_LINES = 200, NAME_ROOM = 128, THETA_I = 0, THETA_O = 2, PHI_O = 3 };

static const char separators[] = "\t;, ";

/* ---- kinds of lines ---- */

static bool is_number(gonio_i_line cell)
{
    char text[NAME_ROOM];
    double value = 0.0;
    if (cell.length == 0 || cell.length >= sizeof text) {
        return false;
    }
    memcpy(text, cell.at, cell.length);
    text[cell.length] = '\0';
    return gonio_i_csv_is_number(text, ',', &value) || gonio_i_csv_is_number(text, ';', &value);
}

/* The separator between at least two cells; 0: there is one cell. */
static char separator_of(gonio_i_line l)
{
    for (size_t k = 0; separators[k] != '\0'; k++) {
        if (gonio_i_count_cells(l, separators[k]) > 1) {
            return separators[k];
        }
    }
    return '\0';
}

static bool is_row(gonio_i_line l)
{
    gonio_i_line cell;
    return separator_of(l) != '\0' && gonio_i_next_cell(&l, separator_of(l), &cell) &&
           is_number(cell);
}

/* A line of one angle of incidence: its words name theta_i, beside one number. */
typedef struct block_line {
    double theta;
    int unit; /* gonio_angle_unit; 0: not stated */
} block_line;

static bool take_block_line(gonio_i_line l, block_line *b)
{
    char text[NAME_ROOM];
    gonio_i_words words;
    gonio_i_words names = {.whole = true};
    gonio_i_column_name name = {0};
    double number = 0.0;
    size_t numbers = 0;
    if (l.length == 0 || l.length >= sizeof text) {
        return false;
    }
    memcpy(text, l.at, l.length);
    text[l.length] = '\0';
    gonio_i_words_split(text, &words);
    for (size_t k = 0; k < words.count; k++) {
        if (words.word[k].text[0] != '\0') {
            names.word[names.count++] = words.word[k];
        } else {
            number = words.word[k].number;
            numbers++;
        }
    }
    if (!words.whole || numbers != 1 || !gonio_i_take_angle_name(&names, &name) ||
        name.index != THETA_I || name.complement) {
        return false;
    }
    const char *digit = strpbrk(text, "0123456789");
    const bool negative = digit > text && digit[-1] == '-';
    *b = (block_line){negative ? -number : number, name.unit};
    return true;
}

static gonio_i_column_name name_of(gonio_i_line cell)
{
    char text[NAME_ROOM] = "";
    memcpy(text, cell.at, cell.length < sizeof text ? cell.length : sizeof text - 1);
    return gonio_i_column_name_of(text);
}

/* The angles that cells name, as bits of their indices. */
static unsigned angles_named(gonio_i_line l)
{
    gonio_i_line cell;
    unsigned angles = 0;
    const char separator = separator_of(l);
    while (separator != '\0' && gonio_i_next_cell(&l, separator, &cell)) {
        const gonio_i_column_name name = name_of(cell);
        angles |= name.kind == GONIO_I_ANGLE ? 1U << name.index : 0;
    }
    return angles;
}

/* Angles of the light, or of both directions at once: a line that names one is of a table of its
 * own. */
static const unsigned IN_BLOCKS =
    (((1U << GONIO_I_PHASE) - 1U) & ~0x3U) | 1U << GONIO_I_BETA | 1U << GONIO_I_BETA_SIZE;

/* ---- the blocks of a text ---- */

typedef struct blocks {
    size_t first;       /* number of the first block's line, from 0 */
    int unit;           /* of its angle */
    gonio_i_line names; /* the first line of names in a block; at is NULL: there is none */
    bool polar;         /* the detector's polar angle has a name */
    bool azimuths;      /* that of the detector is among them: the light is at 0 */
} blocks;

/* Whether a name is that of an angle of the detector. */
static bool has_axis(gonio_i_line l, int angle)
{
    gonio_i_line cell;
    bool found = false;
    const char separator = separator_of(l);
    while (separator != '\0' && gonio_i_next_cell(&l, separator, &cell)) {
        found = found || gonio_i_axis_of(cell).index == angle;
    }
    return found;
}

/* Whether a line is "key: text". */
static bool is_key(gonio_i_line l)
{
    return separator_of(l) == ' ' && memchr(l.at, ':', l.length) != NULL;
}

static bool find_blocks(const char *text, size_t size, blocks *b)
{
    const char *at = text;
    const char *mark = NULL;
    gonio_i_line l;
    bool inside = false;
    *b = (blocks){0};
    if (memchr(text, '\0', size) != NULL) {
        return false;
    }
    for (size_t k = 0; k < MOST_LINES && gonio_i_next_line(&at, text + size, &l); k++) {
        block_line one;
        const gonio_i_line rest = gonio_i_without_mark(l, &mark);
        if (mark == NULL && is_row(rest)) {
            return inside;
        }
        if (take_block_line(rest, &one)) {
            b->first = inside ? b->first : k;
            b->unit = inside ? b->unit : one.unit;
            inside = true;
        } else if ((angles_named(rest) & ~IN_BLOCKS) != 0) {
            return false;
        } else if (inside && mark == NULL && b->names.at == NULL && separator_of(rest) != '\0' &&
                   !is_key(rest)) {
            b->names = rest;
            b->azimuths = has_axis(rest, PHI_O);
            b->polar = has_axis(rest, THETA_O);
        }
    }
    return false;
}

bool gonio_i_csv_are_blocks(const char *text, size_t size)
{
    blocks b;
    return size > 0 && find_blocks(text, size, &b);
}

/* ---- printing ---- */

static void print_cells(FILE *stream, gonio_i_line l)
{
    gonio_i_line cell;
    const char separator = separator_of(l);
    while (gonio_i_next_cell(&l, separator, &cell)) {
        fprintf(stream, "\t%.*s", (int)cell.length, cell.at);
    }
    fputc('\n', stream);
}

static const char *words_of_unit(int unit)
{
    return unit == GONIO_RADIANS                 ? " (rad)"
           : unit == GONIO_GRADIANS              ? " (gon)"
           : unit == GONIO_DEGREES               ? " (deg)"
           : unit == GONIO_I_DEGREES_OR_GRADIANS ? " (grad)"
                                                 : "";
}

/* The name of a column of rows. theta and phi alone are those of the detector, and so is the first
 * column without such a name, in the unit of theta_i if it states none. */
static void print_name(FILE *stream, gonio_i_line cell, int unit, bool first)
{
    char text[NAME_ROOM] = "";
    memcpy(text, cell.at, cell.length < sizeof text ? cell.length : sizeof text - 1);
    const int said = gonio_i_angle_unit_in(text);
    const bool azimuth = gonio_i_axis_of(cell).index == PHI_O;
    const bool unknown = name_of(cell).kind == GONIO_I_OTHER;
    const bool polar = first || gonio_i_axis_of(cell).index == THETA_O;
    if (!unknown || !(azimuth || polar)) {
        fprintf(stream, "\t%.*s", (int)cell.length, cell.at);
    } else {
        fprintf(stream, "\t%s%s", azimuth ? "phi_o" : "theta_o",
                words_of_unit(said != 0 ? said : unit));
    }
}

static void print_names(FILE *stream, const blocks *b)
{
    gonio_i_line rest = b->names;
    gonio_i_line cell;
    fprintf(stream, "theta_i%s%s", words_of_unit(b->unit), b->azimuths ? "\tphi_i" : "");
    if (rest.at == NULL) {
        fprintf(stream, "\ttheta_o%s\tvalue\n", words_of_unit(b->unit));
        return;
    }
    const char separator = separator_of(rest);
    gonio_i_next_cell(&rest, separator, &cell);
    print_name(stream, cell, b->unit, !b->polar);
    while (gonio_i_next_cell(&rest, separator, &cell)) {
        print_name(stream, cell, b->unit, false);
    }
    fputc('\n', stream);
}

static bool is_same(gonio_i_line a, gonio_i_line b)
{
    return b.at != NULL && a.length == b.length && memcmp(a.at, b.at, a.length) == 0;
}

/* A line that is no row: names again, or "key: text". */
static bool is_said(gonio_i_line l, const blocks *b, const char *mark)
{
    return mark != NULL || is_same(l, b->names) ||
           (!is_number((gonio_i_line){l.at, 1}) && memchr(l.at, ':', l.length) != NULL);
}

static void print_table(FILE *stream, const char *text, size_t size, const void *found)
{
    const blocks *b = found;
    const char *at = text;
    const char *mark = NULL;
    gonio_i_line l;
    block_line now = {0};
    for (size_t k = 0; gonio_i_next_line(&at, text + size, &l); k++) {
        const gonio_i_line rest = gonio_i_without_mark(l, &mark);
        const bool begins = k >= b->first && take_block_line(rest, &now);
        if (k == b->first) {
            print_names(stream, b);
        } else if (rest.length == 0) {
            fputc('\n', stream);
        } else if (k < b->first || begins || is_said(rest, b, mark)) {
            fprintf(stream, "# %.*s\n", (int)rest.length, rest.at);
        } else {
            fprintf(stream, "%.10g%s", now.theta, b->azimuths ? "\t0" : "");
            print_cells(stream, rest);
        }
    }
}

gonio_status gonio_i_csv_blocks_make_plain(gonio_context *context, const char *path, char **text,
                                           size_t *size)
{
    blocks b;
    return *size > 0 && find_blocks(*text, *size, &b)
               ? gonio_i_print_again(context, path, text, size, print_table, &b)
               : GONIO_OK;
}
