/* A column of the colour of each row's value: see csv_finder.h. */
#include <strings.h>

#include "csv_finder.h"
#include "csv_numbers.h"
#include "csv_unit_row.h"

int gonio_i_colour_of(const char *cell)
{
    static const struct {
        const char *word;
        int colour;
    } words[] = {{"R", 0}, {"red", 0},   {"rot", 0},  {"rouge", 0},
                 {"G", 1}, {"green", 1}, {"vert", 1}, {"gr\xc3\xbcn", 1},
                 {"B", 2}, {"blue", 2},  {"blau", 2}, {"bleu", 2}};
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        if (strcasecmp(cell, words[k].word) == 0) {
            return words[k].colour;
        }
    }
    return -1;
}

static bool may_have_colours(const gonio_i_csv_finder *f, size_t column)
{
    static const char *const names[] = {"colour", "color", "farbe", "couleur",
                                        "kanal",  "canal", NULL};
    const gonio_i_column_kind kind = f->name[column].kind;
    return kind == GONIO_I_PLANNED ||
           (kind == GONIO_I_OTHER && gonio_i_csv_is_one_of(f->r->name[column], names));
}

/* Whether rows have more than one colour there. Rows that cannot be read are for the reader to
 * refuse: here nothing is said of them. */
static bool has_colours(const gonio_i_csv_reader *r, size_t column)
{
    gonio_i_csv_reader scan;
    unsigned colours = 0;
    if (gonio_i_csv_open(NULL, r->path, r->text, r->size, &scan) != GONIO_OK) {
        return false;
    }
    scan.remarks_allowed = r->remarks_allowed;
    bool more = gonio_i_csv_take_units(&scan) == GONIO_OK;
    while (more && (colours & (colours - 1)) == 0) {
        more = gonio_i_csv_next(&scan) == GONIO_OK && scan.cells > 0;
        const int colour = more ? gonio_i_colour_of(scan.cell[column]) : -1;
        colours |= colour >= 0 ? 1U << colour : 0;
    }
    gonio_i_csv_close(&scan);
    return (colours & (colours - 1)) != 0;
}

void gonio_i_csv_find_row_colours(const gonio_i_csv_finder *f)
{
    gonio_i_csv_columns *c = f->c;
    const bool one = c->any_value && c->channels == 1 && f->family == GONIO_I_UNNAMED;
    for (size_t k = 0; k < f->r->columns && one && !c->by_colour && !c->by_wavelength; k++) {
        if (may_have_colours(f, k) && has_colours(f->r, k)) {
            c->column[k].kind = GONIO_I_ROW_COLOUR;
            c->by_colour = true;
            c->own = false;
        }
    }
}
