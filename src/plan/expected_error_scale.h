/* From the loss that readings leave to the expected error, E6 in per cent. */
#ifndef GONIO_EXPECTED_ERROR_SCALE_H
#define GONIO_EXPECTED_ERROR_SCALE_H

#include "expected_error_choices.h"

/* factor (scale loss + open^2)^(1/2). */
typedef struct gonio_i_error_of_loss {
    double factor;
    double scale;
    double open;
} gonio_i_error_of_loss;

/* Before anything was read, for the loss over the rows of `p`. Errors: _MEMORY. */
gonio_status gonio_i_find_error_of_loss(const gonio_i_choices *p, gonio_i_error_of_loss *e);

/* Of a material that was read, what its covariance lets expect shrinks with the loss, down to what
 * the model leaves open; and what is expected, in proportion. loss: that of the covariance. */
void gonio_i_scale_to_known(const gonio_i_known *known, double loss, gonio_i_error_of_loss *e);

/* The error of a loss. */
double gonio_i_expected_error_of(const gonio_i_error_of_loss *e, double loss);

/* The loss that leaves the target; 0 if there is no target, or none that can be reached. */
double gonio_i_enough_for(const gonio_i_error_of_loss *e, double target);

#endif
