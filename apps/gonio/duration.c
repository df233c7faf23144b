/* Durations on the command line, and a clock: see duration.h. */
#include "duration.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct unit {
    const char *name;
    double seconds;
} unit;

static const unit units[] = {{"", 1.0},     {"s", 1.0},    {"sec", 1.0},  {"m", 60.0},
                             {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}};

bool tool_duration(const char *text, double *seconds)
{
    char *end = NULL;
    const double number = strtod(text, &end);
    end += strspn(end, " ");
    for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
        if (strcmp(end, units[k].name) == 0) {
            *seconds = number * units[k].seconds;
            return number > 0.0 && isfinite(number);
        }
    }
    return false;
}

void tool_print_duration(FILE *stream, double seconds)
{
    if (seconds < 90.0) {
        fprintf(stream, "%.0f s", seconds);
    } else if (seconds < 5400.0) {
        fprintf(stream, "%.1f min", seconds / 60.0);
    } else {
        fprintf(stream, "%.2f h", seconds / 3600.0);
    }
}

double tool_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
