/* The next readings of an anisotropic material: a plan that goes on from the pairs of directions
 * that were read, under the stretches that explain them. */
#include <stdlib.h>

#include "../measurement/readings.h"
#include "../plan/azimuth_choices.h"
#include "anisotropic.h"

#include <math.h>

gonio_status gonio_i_next_anisotropic(gonio_context *context, const gonio_basis *basis,
                                      const gonio_readings *readings,
                                      const gonio_reconstruct_options *options,
                                      const gonio_plan_options *plan_options, double *expected_now,
                                      gonio_plan **plan)
{
    gonio_anisotropic_reconstruction *made = NULL;
    gonio_i_weighed_stretches weighed;
    gonio_status status = gonio_reconstruct_anisotropic(context, basis, readings, options, &made);
    if (status == GONIO_OK) {
        gonio_i_anisotropic_weighed(made, &weighed);
        const double now = gonio_anisotropic_reconstruction_describe(made)->predicted_e6;
        const size_t choices = plan_options->candidates != NULL ? plan_options->candidate_count
                                                                : GONIO_I_AZIMUTH_CHOICES;
        const gonio_i_known known = {.count = readings->count,
                                     .pair = readings->pair,
                                     .expected = now,
                                     .variance = now,
                                     .norm = weighed.norm * sqrt((double)choices),
                                     .stretch = weighed.stretch,
                                     .stretch_weight = weighed.weight,
                                     .stretches = weighed.count};
        gonio_plan_options all = *plan_options;
        all.target = 0.0;
        *expected_now = now;
        *plan = NULL;
        if (!(plan_options->target > 0.0 && now <= plan_options->target)) {
            status = gonio_i_expected_error_next(context, basis, &all, &known, plan);
        }
    }
    gonio_anisotropic_reconstruction_free(&made);
    return status;
}
