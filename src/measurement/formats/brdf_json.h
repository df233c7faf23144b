/* Readings as BRDF JSON: what the reader and the writer share. */
#ifndef GONIO_BRDF_JSON_H
#define GONIO_BRDF_JSON_H

#include <jansson.h>

#include "format.h"

/* See gonio_i_readings_format. */
gonio_status gonio_i_brdf_json_print(gonio_context *context, const gonio_readings *readings,
                                     const char *command, FILE *stream);

/* Prints the object `metadata`. False when out of memory. */
bool gonio_i_brdf_json_print_metadata(const gonio_readings *readings, const char *command,
                                      FILE *stream);

/* Reads the comments of a file that gonio wrote. Errors: _MEMORY. */
gonio_status gonio_i_brdf_json_read_comments(const gonio_i_readings_file *file, const json_t *root,
                                             gonio_readings *readings);

#endif
