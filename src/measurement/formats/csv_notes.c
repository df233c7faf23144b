/* Notes on a CSV file that is read: see csv_notes.h. */
#include "csv_notes.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_NAMED = 4, MOST_OF_NAME = 40 };

/* A list of quoted names in a text of limited room. */
typedef struct name_list {
    char *text;
    size_t room;
    size_t count;
} name_list;

static void add_text(const name_list *list, const char *text)
{
    const size_t used = strlen(list->text);
    snprintf(list->text + used, list->room - used, "%s", text);
}

/* Adds a column by its name, or by its number if it has none. */
static void add_name(name_list *list, const gonio_i_csv_reader *reader, size_t column)
{
    char quoted[MOST_OF_NAME + 32];
    const char *name = reader->name[column];
    if (*name == '\0') {
        snprintf(quoted, sizeof quoted, "column %zu without a name", column + 1);
    } else {
        snprintf(quoted, sizeof quoted, "'%.*s'", MOST_OF_NAME, name);
    }
    if (list->count < MOST_NAMED) {
        add_text(list, list->count > 0 ? ", " : "");
        add_text(list, quoted);
    }
    list->count++;
}

static void end_list(const name_list *list)
{
    char rest[48];
    if (list->count > MOST_NAMED) {
        snprintf(rest, sizeof rest, " and %zu more", list->count - MOST_NAMED);
        add_text(list, rest);
    }
}

static void list_kind(const gonio_i_csv_reader *reader, const gonio_i_csv_columns *columns,
                      gonio_i_column_kind kind, const char *begin, char text[GONIO_I_TAKEN_ROOM])
{
    name_list list = {text, GONIO_I_TAKEN_ROOM, 0};
    for (size_t k = 0; k < columns->count; k++) {
        if (columns->column[k].kind == kind) {
            add_text(&list, list.count == 0 ? begin : "");
            add_name(&list, reader, k);
        }
    }
    end_list(&list);
}

void gonio_i_csv_describe(const gonio_i_csv_reader *reader, const gonio_i_csv_columns *columns,
                          int mirror, char text[GONIO_I_TAKEN_ROOM])
{
    const char *between = " (";
    snprintf(text, GONIO_I_TAKEN_ROOM, "CSV%s",
             columns->by_wavelength     ? " with a line for each wavelength"
             : columns->by_colour       ? " with a line for each colour"
             : columns->by_polarisation ? " with a line for each polarisation"
                                        : "");
    if (!columns->own_angles) {
        const name_list list = {text, GONIO_I_TAKEN_ROOM, 0};
        list_kind(reader, columns, GONIO_I_ANGLE, " (angles ", text);
        add_text(&list, gonio_i_geometry_words(columns->geometry, mirror));
        between = "; ";
    }
    if (columns->any_value) {
        const name_list list = {text, GONIO_I_TAKEN_ROOM, 0};
        add_text(&list, between);
        list_kind(reader, columns, GONIO_I_VALUE, "values ", text);
        list_kind(reader, columns, GONIO_I_DEVIATION, "; deviations ", text);
    }
    if (!columns->own_angles || columns->any_value) {
        const name_list list = {text, GONIO_I_TAKEN_ROOM, 0};
        add_text(&list, ")");
    }
}

/* ---- columns that are not read ---- */

gonio_status gonio_i_csv_others_begin(gonio_i_csv_others *others, gonio_context *context,
                                      const gonio_i_csv_columns *columns)
{
    others->column = gonio_i_allocate(context, columns->count, sizeof *others->column);
    others->number = gonio_i_allocate(context, columns->count, sizeof *others->number);
    if (others->column == NULL || others->number == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < columns->count; k++) {
        if (columns->column[k].kind == GONIO_I_OTHER) {
            others->column[others->count++] = k;
        }
    }
    return GONIO_OK;
}

void gonio_i_csv_others_look(gonio_i_csv_others *others, const gonio_i_csv_reader *reader)
{
    size_t kept = 0;
    for (size_t k = 0; k < others->count; k++) {
        const char *cell = reader->cell[others->column[k]];
        double value = 0.0;
        const bool number = gonio_i_csv_is_number(cell, reader->delimiter, &value);
        if (number || *cell == '\0') {
            others->column[kept] = others->column[k];
            others->number[kept++] = others->number[k] || number;
        }
    }
    others->count = kept;
}

/* Whether gonio writes a column only for the record. */
static bool is_for_the_record(const char *name)
{
    return strcasecmp(name, "expected_e6_percent") == 0 || strncasecmp(name, "axis_", 5) == 0;
}

gonio_status gonio_i_csv_others_note(gonio_i_csv_others *others, const gonio_i_csv_reader *reader,
                                     gonio_readings *readings)
{
    char text[GONIO_I_TAKEN_ROOM] = "";
    name_list list = {text, sizeof text, 0};
    for (size_t k = 0; k < others->count; k++) {
        if (others->number[k] && !is_for_the_record(reader->name[others->column[k]])) {
            add_name(&list, reader, others->column[k]);
        }
    }
    end_list(&list);
    return list.count == 0
               ? GONIO_OK
               : gonio_i_readings_note(reader->context, readings,
                                       "columns of numbers that are not read: %s", text);
}

void gonio_i_csv_others_free(gonio_i_csv_others *others)
{
    free(others->column);
    free(others->number);
    *others = (gonio_i_csv_others){0};
}
