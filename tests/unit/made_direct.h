/* Materials made for the tests that are evaluated at any directions. */
#ifndef MADE_DIRECT_H
#define MADE_DIRECT_H

#include <math.h>
#include <stdlib.h>

#include <gonio/gonio.h>

/* Neither reciprocal nor isotropic, different in each channel. */
static inline double made_direct_value(gonio_pair pair, size_t channel)
{
    return 0.2 + 0.1 * (double)channel + 0.3 * pair.incident.theta +
           0.05 * cos(2.0 * pair.incident.phi) + 0.1 * sin(pair.outgoing.theta);
}

static gonio_status made_direct_evaluate(void *self, gonio_context *context,
                                         const gonio_pair *pairs, size_t count, double *values)
{
    const size_t channels = *(const size_t *)self;
    (void)context;
    for (size_t k = 0; k < count * channels; k++) {
        values[k] = made_direct_value(pairs[k / channels], k % channels);
    }
    return GONIO_OK;
}

/* wavelength[channels] in nm, or NULL. Data end at theta_limit, if that is not 0. */
static inline gonio_material *made_direct(size_t channels, const double *wavelength,
                                          double theta_limit)
{
    gonio_material *material = NULL;
    size_t *self = malloc(sizeof *self);
    assert_non_null(self);
    *self = channels;
    const gonio_material_source source = {.size = sizeof source,
                                          .evaluate = made_direct_evaluate,
                                          .release = free,
                                          .self = self,
                                          .channels = channels,
                                          .wavelength = wavelength,
                                          .anisotropic = true,
                                          .theta_limit = theta_limit};
    assert_int_equal(gonio_material_create(NULL, "made", "made for a test", &source, &material),
                     GONIO_OK);
    return material;
}

#endif
