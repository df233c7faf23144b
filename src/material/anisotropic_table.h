/* Anisotropic tables (material.h) inside: their sizes, the coefficients of a material that is one,
 * and tables made from any material. */
#ifndef GONIO_ANISOTROPIC_TABLE_H
#define GONIO_ANISOTROPIC_TABLE_H

#include <gonio/material.h>

#include "sampler.h"

/* Whether sizes, symmetry, wavelengths and floors are those of a table; coefficients are not looked
 * at. */
bool gonio_i_anisotropic_fits(const gonio_anisotropic_table *table);

/* The same, and there are coefficients. Errors: _ARGUMENT. */
gonio_status gonio_i_anisotropic_check(gonio_context *context,
                                       const gonio_anisotropic_table *table);

/* How many coefficients a table has: cells times channels times those of a series. */
size_t gonio_i_anisotropic_count(const gonio_anisotropic_table *table);

/* The table that a material was made from, which belongs to the material; NULL if it was not. */
const gonio_anisotropic_table *gonio_i_anisotropic_of(const gonio_material *material);
const gonio_anisotropic_table *gonio_i_anisotropic_of_source(const gonio_material_source *source);

/* Means over phi_h at the centres of the bins of one theta_h and theta_d: mean[phi_d][channels],
 * 1/sr, NaN for no data. Errors: _MEMORY. */
gonio_status gonio_i_anisotropic_means(gonio_context *context, const gonio_anisotropic_table *table,
                                       int theta_h, int theta_d, double *mean);

/* Fills in `source` with a source of this table, which takes the table's arrays: they are released
 * with free(). On failure they stay the caller's. Errors: _ARGUMENT, _MEMORY. */
gonio_status gonio_i_anisotropic_source(gonio_context *context, gonio_anisotropic_table *table,
                                        gonio_material_source *source);

/* The sizes in words, for descriptions; the caller frees it. NULL if out of memory. */
char *gonio_i_anisotropic_describe(const gonio_anisotropic_table *table);

/* Makes a table from a material: its symmetry and the orders that it needs are found, and values in
 * log space at the centres of cells and evenly spaced phi_h become series. The mean of both sides
 * of the reciprocal pair is taken. phi_d_cells 0: 36, or 12 of many channels. The arrays are the
 * caller's: gonio_i_anisotropic_clear. Errors: _MEMORY, _CANCELLED, those of the material. */
gonio_status gonio_i_anisotropic_fit(gonio_context *context, const gonio_i_sampler *sampler,
                                     int phi_d_cells, gonio_anisotropic_table *table);

/* Frees the arrays of a table that is the library's. */
void gonio_i_anisotropic_clear(gonio_anisotropic_table *table);

#endif
