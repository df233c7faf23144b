/* The posterior mean of an anisotropic material along theta_h and phi_h.
 *
 * The mean of anisotropic.h at one theta_d and phi_d, for all centres of theta_h and evenly spaced
 * phi_h. What the readings have to do with a line is found at the centres of theta_h once, and is
 * linear between them, as the basis is. So a table takes a hundredth of the time of as many single
 * places. */
#ifndef GONIO_ANISOTROPIC_LINES_H
#define GONIO_ANISOTROPIC_LINES_H

#include "anisotropic.h"

typedef struct gonio_i_anisotropic_lines gonio_i_anisotropic_lines;

/* The turns of the sample, in a full one, that change nothing in the estimate: 1, 2 or 4; 0: none
 * changes anything. */
int gonio_i_anisotropic_symmetry(const gonio_i_anisotropic *estimate);

/* Prepares lines of `nodes` azimuths of the half vector, evenly spaced over `period` radians from 0
 * on. The estimate must outlive them. Errors: _MEMORY. */
gonio_status gonio_i_anisotropic_lines_create(gonio_context *context,
                                              const gonio_i_anisotropic *estimate, size_t nodes,
                                              double period, gonio_i_anisotropic_lines **lines);
void gonio_i_anisotropic_lines_free(gonio_i_anisotropic_lines **lines);

/* g[GONIO_THETA_H_BINS][nodes][columns] of a line. Any number of threads. Errors: _MEMORY. */
gonio_status gonio_i_anisotropic_line(gonio_context *context,
                                      const gonio_i_anisotropic_lines *lines, double theta_d,
                                      double phi_d, double *g);

#endif
