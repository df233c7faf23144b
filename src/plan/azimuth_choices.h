/* The readings that a plan for an anisotropic material may choose from: pairs of directions whose
 * azimuths count, and their covariance under the prior of prior/stretch.h. */
#ifndef GONIO_AZIMUTH_CHOICES_H
#define GONIO_AZIMUTH_CHOICES_H

#include "expected_error_choices.h"

enum {
    GONIO_I_AZIMUTH_CHOICES = 3000,      /* pairs drawn where none are listed */
    GONIO_I_MOST_AZIMUTH_CHOICES = 20000 /* listed */
};

/* The pairs options->candidates, or pairs drawn from the grid at all azimuths by options->seed. The
 * covariance is a mean over stretches: those of p->known, and some of any ratio and azimuth. If
 * something is known, the pairs that were read are rows too, at the end, which are not allowed and
 * have no loss. Errors: _MEMORY, _NUMERICAL, _ARGUMENT (too many candidates). */
gonio_status gonio_i_choices_of_azimuths(gonio_i_choices *p, const gonio_plan_options *options);

#endif
