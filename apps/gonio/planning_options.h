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
    const char *instrument; /* a file or a word; NULL: none */
    const char *budget;     /* a time; NULL: none */
    int nested;
    int anisotropic;
} planning_options;

/* What planning_options_apply reads. */
typedef struct planning_inputs {
    gonio_pair *candidates;
    gonio_instrument *instrument;
} planning_inputs;

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
        {"instrument",                                                                             \
         '\0',                                                                                     \
         POPT_ARG_STRING,                                                                          \
         &(o)->instrument,                                                                         \
         0,                                                                                        \
         "Plan for this instrument, a file or in-plane, two-arms or four-axis: what it reaches, "  \
         "in the order of least time",                                                             \
         "INSTRUMENT"},                                                                            \
        {"budget",                                                                                 \
         '\0',                                                                                     \
         POPT_ARG_STRING,                                                                          \
         &(o)->budget,                                                                             \
         0,                                                                                        \
         "Plan the best run of the instrument in this time, e.g. 45min, 2h or 900s",               \
         "TIME"},                                                                                  \
        {"nested",                                                                                 \
         '\0',                                                                                     \
         POPT_ARG_NONE,                                                                            \
         &(o)->nested,                                                                             \
         0,                                                                                        \
         "Order the instrument's readings within the first 5, 10, 20, 40 and so on only, which "   \
         "stay good plans",                                                                        \
         NULL},                                                                                    \
        {"anisotropic",                                                                            \
         '\0',                                                                                     \
         POPT_ARG_NONE,                                                                            \
         &(o)->anisotropic,                                                                        \
         0,                                                                                        \
         "For a material that changes as the sample turns: azimuths of all directions count",      \
         NULL},                                                                                    \
    {                                                                                              \
        "metric", '\0', POPT_ARG_STRING, &(o)->metric, 0,                                          \
            "The metric to minimise: e6 (default), cube-root or log-relative", "METRIC"            \
    }

/* The number of "3" or "3%"; -1 for other text, or if it is not above 0. */
double planning_percent(const char *text);

/* Checks the options. Returns false after an error message. `output`: the plan's file. */
bool planning_options_check(const tool *t, const planning_options *o, const char *output);

/* Sets the options of the library, after reading candidates and instrument from their files. The
 * caller releases *inputs after the plan is made, in any case. */
gonio_status planning_options_apply(const tool *t, const planning_options *o,
                                    gonio_plan_options *how, planning_inputs *inputs);
void planning_inputs_free(planning_inputs *inputs);

#endif
