/* What a plan is to aim at, for the commands that plan. */
#ifndef GONIO_PLANNING_OPTIONS_H
#define GONIO_PLANNING_OPTIONS_H

#include "command_line.h"

/* The gonio_metric of a name; -1 if there is none. */
int tool_metric(const char *name);

/* "3" or "3%"; -1 if it is neither, or not above 0. */
double tool_percent(const char *text);

/* The directions of a readings file, with or without values; to be released with free(). */
gonio_status tool_candidates(tool *t, const char *path, gonio_pair **pairs, size_t *count);

#endif
