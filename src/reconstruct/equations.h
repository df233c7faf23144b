/* Coefficients of a basis from equations: for methods that solve X c = b of one column at a time.
 */
#ifndef GONIO_EQUATIONS_H
#define GONIO_EQUATIONS_H

#include "method.h"

/* The functions of a row of such a method, which calls its `solve` for every column. Errors: those
 * of gonio_reconstruct. */
gonio_status gonio_i_equations_from_readings(const gonio_i_reconstruct_task *task,
                                             const gonio_readings *readings,
                                             gonio_reconstruction **reconstruction);
gonio_status gonio_i_equations_from_rows(const gonio_i_reconstruct_task *task, const size_t *rows,
                                         size_t count, const double *b,
                                         gonio_reconstruction **reconstruction);

/* The latter with so many components. */
gonio_status gonio_i_equations_of_rows(const gonio_i_reconstruct_task *task, size_t components,
                                       const size_t *rows, size_t count, const double *b,
                                       gonio_reconstruction **reconstruction);

#endif
