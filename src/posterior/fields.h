/* The field g of columns in every row of the basis. */
#ifndef GONIO_FIELDS_H
#define GONIO_FIELDS_H

#include "sites.h"

/* What a column's field is made of. */
typedef struct gonio_i_field_column {
    /* [K + 2 n]: c, in units of the prior; alpha^2 S^-1 (y - F z); alpha^2 peak^2 S^-1 (y - F z) */
    const double *terms;
    double *field; /* [rows]: to be filled */
} gonio_i_field_column;

/* g = m + f c + k's two parts by their weights, in every row, of columns over the same sites.
 * Errors: _MEMORY. */
gonio_status gonio_i_fields_fill(gonio_context *context, const gonio_i_sites *sites,
                                 const gonio_i_field_column *columns, size_t count);

#endif
