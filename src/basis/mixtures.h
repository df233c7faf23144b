/* Mixtures: computed columns, each of two varied measured columns (docs/method.md). */
#ifndef GONIO_MIXTURES_H
#define GONIO_MIXTURES_H

#include "basis.h"

typedef struct gonio_i_mixtures gonio_i_mixtures;

/* Draws options->mixtures mixtures of the materials options->subset (NULL: all) of the database.
 * `basis` has its cells and their map set, and must outlive the result. The result keeps the
 * measured columns in memory. Errors: _MEMORY, _IO. */
gonio_status gonio_i_mixtures_create(gonio_context *context, const gonio_basis *basis,
                                     const gonio_database *database,
                                     const gonio_basis_options *options,
                                     gonio_i_mixtures **mixtures);
void gonio_i_mixtures_free(gonio_i_mixtures **mixtures);

/* The two measured columns of each mixture: parents[count][2]. */
void gonio_i_mixtures_parents(const gonio_i_mixtures *mixtures, int32_t *parents);

/* Rows first .. first + count - 1 of all mixtures: values[mixture][count]. Thread-safe. */
void gonio_i_mixtures_fill(const gonio_i_mixtures *mixtures, size_t first, size_t count,
                           float *values);

#endif
