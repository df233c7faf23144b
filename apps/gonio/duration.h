/* Durations on the command line, and a clock. */
#ifndef GONIO_DURATION_H
#define GONIO_DURATION_H

#include <stdbool.h>
#include <stdio.h>

/* Reads "45min", "2h", "90s" or "90" (seconds), above 0. */
bool tool_duration(const char *text, double *seconds);

/* Prints seconds as "75 s", "7.6 min" or "2.25 h". */
void tool_print_duration(FILE *stream, double seconds);

/* Seconds since some moment; they never run backwards. */
double tool_seconds(void);

#endif
