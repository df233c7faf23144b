/* Readings as BRDF JSON: what writes them. */
#ifndef GONIO_BRDF_JSON_H
#define GONIO_BRDF_JSON_H

#include "format.h"

/* See gonio_i_readings_format. */
gonio_status gonio_i_brdf_json_print(gonio_context *context, const gonio_readings *readings,
                                     const char *command, FILE *stream);

#endif
