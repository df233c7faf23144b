/* Columns of words that tell rows apart: see csv_rows.h. */
#include <stdio.h>
#include <string.h>

#include "csv_numbers.h"
#include "csv_rows.h"

static const char *const subjects[] = {
    "sample",   "sample name", "sample_name",   "sample id",     "sample_id",
    "material", "specimen",    "material name", "material_name", "filter",
    "colour",   "color",       "band",          "side",          NULL};
static const char *const qualities[] = {"flag",   "flags", "valid",      "quality", "saturated",
                                        "status", "ok",    "saturation", NULL};
static const char *const kinds[] = {"type", "quantity", "mode", "measurement type", NULL};

static size_t find_column(const gonio_i_csv_source *s, const char *const *names)
{
    size_t k = 0;
    while (k < s->reader.columns && !(s->columns->column[k].kind == GONIO_I_OTHER &&
                                      gonio_i_csv_is_one_of(s->reader.name[k], names))) {
        k++;
    }
    return k;
}

void gonio_i_csv_words_begin(gonio_i_csv_source *s)
{
    s->subject.column = find_column(s, subjects);
    s->quality.column = find_column(s, qualities);
    s->kind_column = find_column(s, kinds);
}

/* The cell of a column; "" where there is none. */
static const char *cell_of(const gonio_i_csv_source *s, size_t column)
{
    return column < s->reader.cells ? s->reader.cell[column] : "";
}

/* Notes the word of a row, and the first that differs. Returns whether there is one. */
static bool differs(gonio_i_csv_word_column *w, const char *cell)
{
    if (*cell != '\0' && w->first[0] == '\0') {
        snprintf(w->first, sizeof w->first, "%s", cell);
    }
    const bool other = *cell != '\0' && strncmp(w->first, cell, sizeof w->first - 1) != 0;
    if (other && w->other[0] == '\0') {
        snprintf(w->other, sizeof w->other, "%s", cell);
    }
    return other;
}

gonio_status gonio_i_csv_words_look(gonio_i_csv_source *s)
{
    const char *subject = cell_of(s, s->subject.column);
    const char *kind = cell_of(s, s->kind_column);
    double number = 0.0;
    if (s->readings->options.directions_only) {
        return GONIO_OK;
    }
    differs(&s->quality, cell_of(s, s->quality.column));
    if (strcasestr(kind, "btdf") != NULL || strcasestr(kind, "transmi") != NULL) {
        return gonio_i_fail(s->context, GONIO_ERROR_DATA,
                            "%s:%zu: a value of transmission; gonio reads reflection",
                            s->reader.path, s->reader.line);
    }
    return gonio_i_csv_is_number(subject, s->reader.delimiter, &number) ||
                   !differs(&s->subject, subject)
               ? GONIO_OK
               : gonio_i_fail(s->context, GONIO_ERROR_DATA,
                              "%s:%zu: %s '%.40s', but rows above are of '%s'; keep the rows of "
                              "one, or rename the column if it does not matter",
                              s->reader.path, s->reader.line, s->reader.name[s->subject.column],
                              subject, s->subject.first);
}

gonio_status gonio_i_csv_words_note(const gonio_i_csv_source *s)
{
    return s->quality.other[0] == '\0'
               ? GONIO_OK
               : gonio_i_readings_note(s->context, s->readings,
                                       "the column '%.40s' is not heeded: rows of '%s' and of "
                                       "'%s' are read alike",
                                       s->reader.name[s->quality.column], s->quality.first,
                                       s->quality.other);
}
