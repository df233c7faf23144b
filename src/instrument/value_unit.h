/* What the numbers of readings are, as multiples of the BRDF. */
#ifndef GONIO_VALUE_UNIT_H
#define GONIO_VALUE_UNIT_H

#include <gonio/instrument.h>

typedef struct gonio_i_value_unit {
    int kind;                       /* gonio_value_kind; 0: the BRDF */
    double counts;                  /* of 1/sr, for counts; 0: not known */
    size_t rows;                    /* of the reference, for relative values; 0: its factor is 1 */
    const gonio_reference_row *row; /* [rows], ascending theta */
} gonio_i_value_unit;

/* That of the instrument's readings. Its rows are the instrument's. */
gonio_i_value_unit gonio_i_value_unit_of(const gonio_instrument *instrument);

/* The factor from a BRDF value to a number of this unit, at the detector's polar angle in radians.
 */
double gonio_i_value_factor(const gonio_i_value_unit *unit, double theta_o);

/* The reflectance factor of a reference: linear between its rows, constant outside, 1 without rows.
 */
double gonio_i_reference_factor(const gonio_reference_row *row, size_t rows, double theta);

#endif
