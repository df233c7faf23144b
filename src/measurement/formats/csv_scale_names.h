/* Words of logarithms in the names of values: "log10(BRDF)", "ln BRDF", "BRDF [dB]". */
#ifndef GONIO_CSV_SCALE_NAMES_H
#define GONIO_CSV_SCALE_NAMES_H

#include "csv_words.h"

/* Takes them out of a name. Returns the gonio_value_scale; 0 if there are none. */
int gonio_i_take_scale(gonio_i_words *words);

#endif
