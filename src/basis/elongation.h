/* Elongation: lobes of samples that pass for isotropic, but are not quite.
 *
 * A sample that is taken for isotropic is often measured at one orientation. If its facets have
 * larger slopes across the plane of incidence than along it, its lobes come out longer there. So do
 * lobes that an instrument blurs more across that plane. Of six tables of RGL that pass for
 * isotropic, one has circular lobes; in the others the ratio of the widths is 0.7 to 2.4
 * (docs/experiments.md).
 *
 * An elongated column is that of an isotropic material at another theta_h,
 *
 *     g'(theta_h, theta_d, phi_d) = g(theta_h r^(c/2), theta_d, phi_d),
 *     c = (cos 2 a_i + cos 2 a_o) / 2,
 *
 * with the azimuths a of the two directions from that of the half vector, so that g' is
 * reciprocal. r is the ratio of a lobe's widths across and along the plane of incidence. */
#ifndef GONIO_ELONGATION_H
#define GONIO_ELONGATION_H

#include "basis.h"

/* -c/2 of each cell of the basis: across[basis->cells]; 0 on a grid without phi_d. */
void gonio_i_elongation_of_cells(const gonio_basis *basis, double *across);

/* The columns of a material, [columns][rows] as those of a database, elongated by the ratio
 * exp(log_ratio); linear between the bins of theta_h. `basis` has its cells and their map set.
 * Thread-safe. */
void gonio_i_elongate(const gonio_basis *basis, const double *across, double log_ratio,
                      const float *columns, float *elongated);

#endif
