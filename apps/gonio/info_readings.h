/* What gonio info says of plans and readings. */
#ifndef GONIO_INFO_READINGS_H
#define GONIO_INFO_READINGS_H

#include "json_output.h"

/* Prints it, or appends an object to `results` unless that is NULL. Returns an exit code. */
int tool_info_readings(const tool *t, const char *path, json_t *results);

#endif
