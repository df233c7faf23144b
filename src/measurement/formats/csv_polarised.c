/* Columns of values of s and of p polarisation: see csv_keys.h. */
#include "csv_keys.h"

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
