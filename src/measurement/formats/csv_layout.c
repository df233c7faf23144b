/* Tables of text made CSV: see csv_layout.h. */
#include "csv_layout.h"

#include <stdio.h>
#include <string.h>

#include "../../core/csv_lines.h"
#include "csv_cells.h"
#include "csv_names.h"

enum { MOST_LINES = 200, NAME_ROOM = 128, LEAST_ANGLES = 2, LEAST_CELLS = 3 };

/* Strokes at both ends belong to the frame of a table. */
static gonio_i_line without_frame(gonio_i_line l)
{
    if (l.length > 1 && *l.at == '|' && l.at[l.length - 1] == '|') {
        l.at++;
        l.length -= 2;
    }
    return l;
}

/* How many cells are names of angles. */
static size_t count_angles(gonio_i_line l, char separator)
{
    gonio_i_line cell;
    size_t count = 0;
    while (gonio_i_next_cell(&l, separator, &cell)) {
        char name[NAME_ROOM];
        if (cell.length < sizeof name) {
            memcpy(name, cell.at, cell.length);
            name[cell.length] = '\0';
            count += gonio_i_column_name_of(name).kind == GONIO_I_ANGLE;
        }
    }
    return count;
}

/* The separator between names; 0 if these are no names of angles. */
static char separator_of_names(gonio_i_line l)
{
    static const char separators[] = "\t;,| ";
    for (size_t k = 0; separators[k] != '\0'; k++) {
        if (gonio_i_count_cells(l, separators[k]) >= LEAST_CELLS &&
            count_angles(l, separators[k]) >= LEAST_ANGLES) {
            return separators[k];
        }
    }
    return '\0';
}

/* ---- names in two lines ---- */

/* The name of a cell below the cell of a group: "Incident" above "theta". A cell that says all by
 * itself stands alone. */
static void join_names(gonio_i_line group, gonio_i_line cell, char name[NAME_ROOM])
{
    char joined[NAME_ROOM] = "";
    snprintf(name, NAME_ROOM, "%.*s", (int)cell.length, cell.at);
    snprintf(joined, sizeof joined, "%.*s %.*s", (int)group.length, group.at, (int)cell.length,
             cell.at);
    if (cell.length > 0 && (gonio_i_column_name_of(joined).kind == GONIO_I_ANGLE ||
                            gonio_i_column_name_of(name).kind == GONIO_I_OTHER)) {
        memcpy(name, joined, sizeof joined);
    }
}

/* The next name of both lines. A group reaches to the next one. *group: at first a line without
 * cells. */
static bool next_joined(gonio_i_line *groups, gonio_i_line *cells, char separator,
                        gonio_i_line *group, char name[NAME_ROOM])
{
    gonio_i_line above = {NULL, 0};
    gonio_i_line cell;
    if (!gonio_i_next_cell(cells, separator, &cell)) {
        return false;
    }
    if (gonio_i_next_cell(groups, separator, &above) && above.length > 0) {
        *group = above;
    }
    join_names(*group, cell, name);
    return true;
}

/* The separator of names in two lines; 0 if these are none, or the lower line has as many by
 * itself.
 */
static char separator_of_joined(gonio_i_line groups, gonio_i_line cells)
{
    static const char separators[] = "\t;,|";
    for (size_t k = 0; separators[k] != '\0' && groups.at != NULL; k++) {
        char name[NAME_ROOM];
        gonio_i_line above = groups;
        gonio_i_line below = cells;
        gonio_i_line group = {"", 0};
        size_t angles = 0;
        if (gonio_i_count_cells(groups, separators[k]) < LEAST_ANGLES) {
            continue;
        }
        while (next_joined(&above, &below, separators[k], &group, name)) {
            angles += gonio_i_column_name_of(name).kind == GONIO_I_ANGLE;
        }
        if (angles >= LEAST_ANGLES && angles > count_angles(cells, separators[k])) {
            return separators[k];
        }
    }
    return '\0';
}

/* ---- where the names are ---- */

typedef struct names {
    gonio_i_line group; /* the line above the names that says whose they are; at NULL: none */
    size_t number;      /* of the line, from 0 */
    const char *mark;
    char separator;
    size_t cells;
} names;

/* Whether the reader of CSV takes names from its first line, which is this or begins with sep=. */
static bool are_plain(const char *text, size_t size)
{
    gonio_i_csv_lines lines;
    const char *at = NULL;
    size_t length = 0;
    gonio_i_csv_lines_begin(&lines, text, size, NULL);
    if (!gonio_i_csv_lines_next(&lines, &at, &length) || length == 0) {
        return true;
    }
    const gonio_i_line first =
        gonio_i_trimmed((gonio_i_line){at, length - (at[length - 1] == '\n')});
    const char separator = separator_of_names(first);
    return gonio_i_csv_stated_separator(at, length) != '\0' ||
           (separator != '\0' && separator != ' ' && separator != '|') ||
           memchr(first.at, '"', first.length) != NULL;
}

static bool find_names(const char *text, size_t size, names *n)
{
    const char *at = text;
    const char *end = text + size;
    gonio_i_line l;
    *n = (names){0};
    if (size == 0 || memchr(text, '\0', size) != NULL || are_plain(text, size)) {
        return false;
    }
    while (n->number < MOST_LINES && gonio_i_next_line(&at, end, &l)) {
        const gonio_i_line above = n->group;
        l = without_frame(gonio_i_without_mark(l, &n->mark));
        n->separator = separator_of_joined(above, l);
        n->group = n->separator != '\0' ? above : (gonio_i_line){NULL, 0};
        n->separator = n->separator != '\0' ? n->separator : separator_of_names(l);
        if (n->separator != '\0') {
            n->cells = gonio_i_count_cells(l, n->separator);
            return at < end;
        }
        n->group = l;
        n->number++;
    }
    return false;
}

bool gonio_i_csv_layout_is_other(const char *text, size_t size)
{
    names n;
    return find_names(text, size, &n);
}

bool gonio_i_csv_layout_lacks_names(const char *text, size_t size)
{
    static const char numbers[] = "0123456789+-.,;eE \t\r\n";
    gonio_i_csv_lines lines;
    const char *at = NULL;
    size_t length = 0;
    gonio_i_csv_lines_begin(&lines, text, size, NULL);
    return gonio_i_csv_lines_next(&lines, &at, &length) && length > 0 &&
           strspn(at, numbers) >= length &&
           gonio_i_count_cells(gonio_i_trimmed((gonio_i_line){at, length}), ' ') > 0;
}

/* ---- printing ---- */

static void print_comment(FILE *stream, gonio_i_line l)
{
    fprintf(stream, "# %.*s\n", (int)l.length, l.at);
}

/* The separator by which a line has as many cells as there are names: that of the names if it does,
 * 0 if none does. */
static char separator_of_row(gonio_i_line l, const names *n)
{
    const char separators[] = {n->separator, '\t', ';', ',', ' ', '|'};
    for (size_t k = 0; k < sizeof separators; k++) {
        if (gonio_i_count_cells(l, separators[k]) == n->cells) {
            return separators[k];
        }
    }
    return '\0';
}

static void print_cells(FILE *stream, gonio_i_line l, char separator)
{
    gonio_i_line cell;
    for (const char *between = ""; gonio_i_next_cell(&l, separator, &cell); between = "\t") {
        fprintf(stream, "%s%.*s", between, (int)cell.length, cell.at);
    }
    fputc('\n', stream);
}

static void print_names(FILE *stream, gonio_i_line l, const names *n)
{
    char name[NAME_ROOM];
    gonio_i_line above = n->group;
    gonio_i_line group = {"", 0};
    const char *between = "";
    if (n->group.at == NULL) {
        print_cells(stream, l, n->separator);
        return;
    }
    while (next_joined(&above, &l, n->separator, &group, name)) {
        fprintf(stream, "%s%s", between, name);
        between = "\t";
    }
    fputc('\n', stream);
}

/* Rows that do not fit the names are for the reader to refuse, by their line. */
static void print_row(FILE *stream, gonio_i_line l, const names *n)
{
    const char *mark = NULL;
    const gonio_i_line rest = gonio_i_without_mark(l, &mark);
    const gonio_i_line row = without_frame(gonio_i_trimmed(l));
    const char separator = separator_of_row(row, n);
    const bool rule =
        row.length > 0 && n->separator == '|' && strspn(row.at, "|-:+= ") >= row.length;
    const bool comment =
        mark != NULL && (n->mark != NULL || strcmp(mark, "#") == 0) && strcmp(mark, "--") != 0;
    if (comment || rule) {
        print_comment(stream, rest);
    } else if (separator != '\0') {
        print_cells(stream, row, separator);
    } else {
        fprintf(stream, "%.*s\n", (int)row.length, row.at);
    }
}

static void print_table(FILE *stream, const char *text, size_t size, const void *found)
{
    const names *n = found;
    const char *at = text;
    const char *mark = NULL;
    gonio_i_line l;
    for (size_t number = 0; gonio_i_next_line(&at, text + size, &l); number++) {
        const gonio_i_line rest = gonio_i_without_mark(l, &mark);
        if (number > n->number) {
            print_row(stream, l, n);
        } else if (number == n->number) {
            print_names(stream, without_frame(rest), n);
        } else if (rest.length > 0) {
            print_comment(stream, rest);
        } else {
            fputc('\n', stream);
        }
    }
}

gonio_status gonio_i_csv_layout_make_plain(gonio_context *context, const char *path, char **text,
                                           size_t *size)
{
    names n;
    return find_names(*text, *size, &n)
               ? gonio_i_print_again(context, path, text, size, print_table, &n)
               : GONIO_OK;
}
