/* Functions shared by the method posterior and the choice of next readings (next.c). */
#ifndef GONIO_POSTERIOR_METHOD_H
#define GONIO_POSTERIOR_METHOD_H

#include <gonio/reconstruct.h>

#include "../posterior/observations.h"
#include "method.h"

gonio_i_noise gonio_i_posterior_noise(const gonio_reconstruct_options *options);

/* Makes observations those of means over apertures; nothing without any. */
void gonio_i_spread_out(const gonio_i_apertures *apertures, size_t channels,
                        const gonio_i_columns *columns);

#endif
