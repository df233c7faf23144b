/* Columns of values in the order of their channels: see csv_keys.h. */
#include "csv_keys.h"

#include <stdlib.h>

double gonio_i_csv_key_of(const gonio_i_column_name *name)
{
    return name->family == GONIO_I_WAVELENGTH ? name->wavelength : (double)name->index;
}

static int compare(const void *a, const void *b)
{
    const gonio_i_csv_keyed *x = a;
    const gonio_i_csv_keyed *y = b;
    const int order = (x->key > y->key) - (x->key < y->key);
    return order != 0 ? order : (x->column > y->column) - (x->column < y->column);
}

gonio_status gonio_i_csv_list_keys(const gonio_i_csv_finder *f,
                                   bool (*wanted)(const gonio_i_csv_finder *f, size_t column),
                                   gonio_i_csv_keys *keys)
{
    keys->count = 0;
    keys->item = gonio_i_allocate(f->r->context, f->r->columns, sizeof *keys->item);
    if (keys->item == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < f->r->columns; k++) {
        if (wanted(f, k)) {
            keys->item[keys->count++] = (gonio_i_csv_keyed){gonio_i_csv_key_of(&f->name[k]), k};
        }
    }
    qsort(keys->item, keys->count, sizeof *keys->item, compare);
    return GONIO_OK;
}
