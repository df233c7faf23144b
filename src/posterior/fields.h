/* The field g of columns in every row of the basis. */
#ifndef GONIO_FIELDS_H
#define GONIO_FIELDS_H

#include "sites.h"

/* What a column's field is made of. */
typedef struct gonio_i_field_column {
    /* c, in units of the prior; alpha^2 S^-1 (y - F z); that times peak^2; and, where sites have
     * directions near the light, times retro^2: gonio_i_terms */
    const double *terms;
    double *field; /* [rows]: to be filled */
} gonio_i_field_column;

/* g = m + f c + k's parts by their weights, in every row, of columns over the same sites. Of a
 * hundred columns and more it may be off by 1e-4 (1 + 3 n)^(1/2) log units, for n readings.
 * Errors: _MEMORY. */
gonio_status gonio_i_fields_fill(gonio_context *context, const gonio_i_sites *sites,
                                 const gonio_i_field_column *columns, size_t count);

#endif
