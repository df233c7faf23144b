/* Powers of ten in the names of values: "BRDF [10^-3 1/sr]". */
#ifndef GONIO_CSV_FACTOR_NAMES_H
#define GONIO_CSV_FACTOR_NAMES_H

#include <stdbool.h>
#include <stddef.h>

/* Takes the factor of a unit out of a text: "10^-3 sr^-1", "(e-3/sr)", "[x 1e-3 1/sr]". False, with
 * rest undefined, if there is none or the rest has no room. */
bool gonio_i_take_factor(const char *text, size_t room, char *rest, double *factor);

/* Whether a name multiplies or divides by a number outside its unit, "BRDF x 1000": it is not clear
 * whether the factor was applied or is to be applied. */
bool gonio_i_names_product(const char *text);

#endif
