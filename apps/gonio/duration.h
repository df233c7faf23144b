/* Durations on the command line, and a clock. */
#ifndef GONIO_DURATION_H
#define GONIO_DURATION_H

#include <stdbool.h>

/* Reads "45min", "2h", "90s" or "90" (seconds), above 0. */
bool tool_duration(const char *text, double *seconds);

/* Seconds since some moment; they never run backwards. */
double tool_seconds(void);

#endif
