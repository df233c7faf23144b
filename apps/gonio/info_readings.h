/* gonio info on plans and readings. */
#ifndef GONIO_INFO_READINGS_H
#define GONIO_INFO_READINGS_H

#include "json_output.h"

/* Prints a description of a plan or of readings, or appends an object to `results` unless that is
 * NULL. Returns an exit code. */
int tool_info_readings(const tool *t, const char *path, json_t *results);

#endif
