/* The input files of a command. They are opened after a check of their kind. */
#ifndef GONIO_INPUTS_H
#define GONIO_INPUTS_H

#include "readings_as.h"

/* As gonio_material_open, after gonio_file_expect. */
gonio_status tool_open_material(const tool *t, const char *path, gonio_material **material);

/* Whether --as names a format of a file, which then is readings. */
bool tool_names_format(const tool *t, const char *path);

/* As gonio_readings_read, after gonio_file_expect. */
gonio_status tool_read_readings(const tool *t, const char *path,
                                const gonio_readings_options *options, gonio_readings **readings);

/* Removes channels in which nothing was read, if the basis has separate channels. */
gonio_status tool_keep_read_channels(const tool *t, const gonio_basis *basis,
                                     gonio_readings *readings);

/* Options that accept any values, repeats and negative ones included. */
extern const gonio_readings_options tool_any_values;

/* A material or readings: the other is NULL. */
typedef struct tool_input {
    const char *path; /* the caller's */
    gonio_material *material;
    gonio_readings *readings;
} tool_input;

/* Opens a file as what it is; readings as the instrument of --instrument gives them. It is read
 * once, so that it may be a pipe. To be closed in any case. */
gonio_status tool_open_input(const tool *t, const char *path, tool_input *input);
void tool_close_input(tool_input *input);

/* Gives readings the values of an input at their directions: those of a material, readings that
 * are looked up, or, of readings on a grid (Zemax) that lack some of the directions, interpolated
 * ones, with a note. instrument: of a material; NULL reads it without noise. */
gonio_status tool_take_values(tool *t, const tool_input *from,
                              const gonio_instrument_options *instrument, gonio_readings *at);

/* As gonio_mesh_read, after gonio_file_expect. */
gonio_status tool_read_mesh(const tool *t, const char *path, gonio_mesh **mesh);

#endif
