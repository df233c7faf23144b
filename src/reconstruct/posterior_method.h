/* Functions shared by the method posterior and the choice of next readings (next.c). */
#ifndef GONIO_POSTERIOR_METHOD_H
#define GONIO_POSTERIOR_METHOD_H

#include <gonio/reconstruct.h>

#include "../posterior/observations.h"

gonio_i_noise gonio_i_posterior_noise(const gonio_reconstruct_options *options);

#endif
