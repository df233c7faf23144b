/* Columns of values of s and of p polarisation: see csv_finder.h. */
#include "csv_finder.h"

static bool are_same_channel(const gonio_i_column_name *a, const gonio_i_column_name *b)
{
    return a->family == b->family && a->quantity == b->quantity && a->index == b->index &&
           a->wavelength == b->wavelength;
}

/* A column that would be the third of its channel has no partner left, and is refused. */
size_t gonio_i_csv_other_polarisation(const gonio_i_csv_finder *f, size_t k)
{
    const gonio_i_column_name *n = &f->name[k];
    size_t found = f->r->columns;
    size_t before = 0;
    for (size_t j = 0; j < k && n->polarisation != 0; j++) {
        if (f->c->column[j].kind == GONIO_I_VALUE && are_same_channel(&f->name[j], n)) {
            found = f->name[j].polarisation + n->polarisation == 3 ? j : found;
            before++;
        }
    }
    return before == 1 ? found : f->r->columns;
}
