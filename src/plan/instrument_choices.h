/* The readings that an instrument offers, as choices of a plan of least expected error. */
#ifndef GONIO_INSTRUMENT_CHOICES_H
#define GONIO_INSTRUMENT_CHOICES_H

#include <gonio/instrument.h>

#include "expected_error_choices.h"

typedef struct gonio_i_instrument_choices {
    gonio_i_choices choices; /* f: the mean of the prior over the apertures */
    gonio_setting *setting;  /* [choices.rows]: one that reads each */
    double *variance;        /* [choices.rows]: of a reading, log units: noise, floor, saturation */
    int *incidence;          /* [choices.rows]: readings of one theta_i have one number */
    int incidences;
} gonio_i_instrument_choices;

/* What a plan assumes of the sample. */
extern const gonio_freedom gonio_i_planned_freedom;

/* context, prior and known of `i->choices` are set before. At most `most` readings. To be freed in
 * any case. Errors: _DATA if nothing can be reached; _MEMORY. */
gonio_status gonio_i_choices_of_instrument(gonio_i_instrument_choices *i,
                                           const gonio_instrument *instrument, size_t most);

void gonio_i_instrument_choices_free(gonio_i_instrument_choices *i);

#endif
