/* Readings of a command that is given angles and prints values. */
#ifndef GONIO_FOLLOW_COMMAND_SOURCE_H
#define GONIO_FOLLOW_COMMAND_SOURCE_H

#include <stdbool.h>
#include <stddef.h>

enum { COMMAND_MOST_AXES = 8 };

/* Runs `command` by the shell with four angles in degrees as arguments: theta_i, phi_i, theta_o,
 * phi_o, and behind them axis[axes], at most COMMAND_MOST_AXES. *output: what it printed, which the
 * caller frees; NULL when out of memory. *problem: what went wrong, the caller's too, or NULL. The
 * first interrupt is waited out, so that a reading that is being made is not lost. */
void command_source_run(const char *command, const double degrees[4], const double *axis,
                        size_t axes, char **output, char **problem);

/* Takes the output apart: names of columns, if its first line holds any, otherwise of one value or
 * of R, G, B; and the values, as cells of a line with semicolons. Both are the caller's. *problem
 * as above; names and values are NULL then. Values are apart by blanks, commas or semicolons; with
 * blanks or semicolons they may have decimal commas. */
void command_source_values(const char *output, char **names, char **values, char **problem);

#endif
