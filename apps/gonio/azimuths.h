/* What an anisotropic material reflects at azimuths of the sample. */
#ifndef GONIO_TOOL_AZIMUTHS_H
#define GONIO_TOOL_AZIMUTHS_H

#include "albedos.h"

enum { TOOL_AZIMUTHS = 8 };

typedef struct tool_azimuths {
    double albedo[TOOL_INCIDENCES][GONIO_CHANNELS]; /* means over azimuths of incidence */
    double share[TOOL_INCIDENCES]; /* of the hemisphere that has data, weighted by the cosine */
    double largest;                /* albedo of any channel, incidence and azimuth */
    double turn; /* E6 of the material turned by 90 degrees against itself, per cent */
} tool_azimuths;

/* Evaluates a material at directions. Errors: _MEMORY, those of the material. */
gonio_status tool_find_azimuths(gonio_context *context, const gonio_material *material,
                                tool_azimuths *found);

#endif
