/* Columns of a spectrum that need no fit of their own.
 *
 * A spectrum has many more wavelengths than shapes. Where the readings of a column lie between
 * those of two fitted columns, to a fraction of their noise, the fits have found what it needs: the
 * outliers, the weights of the samples, and the factor of S. With these the estimate of one fit is
 * linear in the readings y,
 *
 *     c = z + h^2 F' S^-1 (y - F z),   alpha^2 S^-1 (y - F z),
 *
 * and a column's own is the mean of the estimates of both fits, weighted by wavelength. Where two
 * neighbours have the same readings, so it has the same field. */
#ifndef GONIO_NEIGHBOURS_H
#define GONIO_NEIGHBOURS_H

#include "fit.h"

/* The fits that a column is found with: fit[0] is that of the column itself if it has one. */
typedef struct gonio_i_neighbours {
    size_t fit[2];    /* numbers of columns */
    double weight[2]; /* add up to 1; {1, 0} of a fitted column */
} gonio_i_neighbours;

/* Every column is fitted. */
void gonio_i_neighbours_none(gonio_i_neighbours *neighbours, size_t count);

/* Chooses among the columns of the given numbers, member[count], which were read at the same
 * directions, those to fit, and sets the neighbours of these columns. wavelength: of all columns,
 * nm. Errors: _MEMORY. */
gonio_status gonio_i_neighbours_choose(gonio_context *context, const gonio_i_column *columns,
                                       const double *wavelength, const size_t *member, size_t count,
                                       gonio_i_neighbours *neighbours);

bool gonio_i_is_fitted(const gonio_i_neighbours *neighbours, size_t column);

/* The weight of a fit in a column; 0 if it has none. */
double gonio_i_neighbour_weight(const gonio_i_neighbours *neighbours, size_t fit, size_t column);

/* The estimates of `count` columns with the outliers, weights and factor of a solved fit. y:
 * [count][n], less the mean of the sites, becomes S^-1 (y - F z); c: [count][K]. Errors: _MEMORY.
 */
gonio_status gonio_i_neighbours_estimate(const gonio_i_fit *fit, size_t count, double *y,
                                         double *c);

#endif
