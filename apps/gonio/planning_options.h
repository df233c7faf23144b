/* The options of planning that several commands share: metric, number, target, candidates. */
#ifndef GONIO_PLANNING_OPTIONS_H
#define GONIO_PLANNING_OPTIONS_H

#include <limits.h>

#include "command_line.h"

/* The library's default count. */
enum { PLANNING_USUAL_COUNT = INT_MIN };

typedef struct planning_options {
    int count;              /* or PLANNING_USUAL_COUNT */
    const char *target;     /* per cent; NULL: none */
    const char *candidates; /* a file of directions; NULL: any */
    const char *metric;     /* NULL: the library's default */
} planning_options;

/* Rows of an option table. `number` and `target_error`: the help of the first two. */
#define PLANNING_OPTIONS(o, number, target_error)                                                  \
    {"number", 'n', POPT_ARG_INT, &(o)->count, 0, number, "N"},                                    \
        {"target-error", '\0', POPT_ARG_STRING, &(o)->target, 0, target_error, "PERCENT"},         \
        {"candidates",                                                                             \
         '\0',                                                                                     \
         POPT_ARG_STRING,                                                                          \
         &(o)->candidates,                                                                         \
         0,                                                                                        \
         "Choose among the directions of this file, a plan or readings",                           \
         "FILE"},                                                                                  \
    {                                                                                              \
        "metric", '\0', POPT_ARG_STRING, &(o)->metric, 0,                                          \
            "The metric to minimise: e6 (default), cube-root or log-relative", "METRIC"            \
    }

/* The number of "3" or "3%"; -1 for other text, or if it is not above 0. */
double planning_percent(const char *text);

/* Checks the options. Returns false after an error message. `output`: the plan's file. */
bool planning_options_check(const tool *t, const planning_options *o, const char *output);

/* Sets the options of the library. `candidates` is read from its file. The caller releases it with
 * free() after the plan is made; NULL if there are none. */
gonio_status planning_options_apply(const tool *t, const planning_options *o,
                                    gonio_plan_options *how, gonio_pair **candidates);

#endif
