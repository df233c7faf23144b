/* The options of the instrument's noise and of checks, which several commands share. */
#ifndef GONIO_POSTERIOR_OPTIONS_H
#define GONIO_POSTERIOR_OPTIONS_H

#include <math.h>

#include "command_line.h"

/* Noise, floor or saturation that no option has set. */
#define POSTERIOR_NOT_GIVEN (-HUGE_VAL)

typedef struct posterior_options {
    double noise; /* per cent */
    double floor; /* 1/sr */
    double saturation;
    int no_checks;
} posterior_options;

/* The library's defaults. */
posterior_options posterior_options_default(void);

/* Nothing is given yet. */
posterior_options posterior_options_open(void);

/* Sets what is not given: to what an instrument has, or without one to the library's defaults. */
void posterior_options_settle(posterior_options *o, const gonio_instrument_view *instrument);

/* Rows of an option table. */
#define POSTERIOR_OPTIONS(o)                                                                       \
    {"noise",                                                                                      \
     '\0',                                                                                         \
     POPT_ARG_DOUBLE,                                                                              \
     &(o)->noise,                                                                                  \
     0,                                                                                            \
     "Noise of a reading in per cent of its value, standard deviation (posterior; default: 1)",    \
     "PERCENT"},                                                                                   \
        {"floor",                                                                                  \
         '\0',                                                                                     \
         POPT_ARG_DOUBLE,                                                                          \
         &(o)->floor,                                                                              \
         0,                                                                                        \
         "Additive noise of a reading in 1/sr, standard deviation (posterior; default: 1e-5)",     \
         "VALUE"},                                                                                 \
        {"saturation",                                                                             \
         '\0',                                                                                     \
         POPT_ARG_DOUBLE,                                                                          \
         &(o)->saturation,                                                                         \
         0,                                                                                        \
         "Readings of this value or more, 1/sr, are lower bounds (posterior)",                     \
         "VALUE"},                                                                                 \
    {                                                                                              \
        "no-checks", '\0', POPT_ARG_NONE, &(o)->no_checks, 0,                                      \
            "Do not look for usual mistakes or a dark level (posterior)", NULL                     \
    }

/* Checks the options. Returns false after an error message. */
bool posterior_options_check(const tool *t, const posterior_options *o);

/* Sets the options of the library. */
void posterior_options_apply(const posterior_options *o, gonio_reconstruct_options *how);

#endif
