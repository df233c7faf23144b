/* Columns of values of s and of p polarisation: see csv_keys.h. */
#include "csv_keys.h"

#include <strings.h>

/* A third column of a channel has no partner, and is refused. */
void gonio_i_csv_find_partners(const gonio_i_csv_finder *f, const gonio_i_csv_keys *keys,
                               size_t *other)
{
    for (size_t k = 0; k < f->r->columns; k++) {
        other[k] = f->r->columns;
    }
    for (size_t k = 1; k < keys->count; k++) {
        const gonio_i_csv_keyed *a = &keys->item[k - 1];
        const gonio_i_csv_keyed *b = &keys->item[k];
        const bool first = k == 1 || keys->item[k - 2].key != a->key;
        const int both = f->name[a->column].polarisation + f->name[b->column].polarisation;
        if (first && a->key == b->key && both == 3) {
            other[b->column] = a->column;
        }
    }
}

/* ---- a column of the polarisation of each row ---- */

bool gonio_i_polarisation_of(const char *cell, int *state)
{
    static const struct {
        const char *word;
        int state;
    } words[] = {
        {"", 0},
        {"s", 1},
        {"s-pol", 1},
        {"te", 1},
        {"perp", 1},
        {"senkrecht", 1},
        {"perpendicular", 1},
        {"p", -1},
        {"p-pol", -1},
        {"tm", -1},
        {"par", -1},
        {"parallel", -1},
        {"u", 0},
        {"none", 0},
        {"unpol", 0},
        {"unpolarised", 0},
        {"unpolarized", 0},
        {"na", 0},
        {"mean", 0},
        {"average", 0},
        {"avg", 0},
    };
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        if (strcasecmp(cell, words[k].word) == 0) {
            *state = words[k].state;
            return true;
        }
    }
    return false;
}
