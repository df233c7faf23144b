/* The options that correct readings, which several commands share. */
#ifndef GONIO_CORRECTION_OPTIONS_H
#define GONIO_CORRECTION_OPTIONS_H

#include "command_line.h"

typedef struct correction_options {
    const char *blank;     /* a file of readings; NULL: none */
    const char *reference; /* a number or a file; NULL: none */
} correction_options;

/* Rows of an option table. */
#define CORRECTION_OPTIONS(o)                                                                      \
    {"blank",                                                                                      \
     '\0',                                                                                         \
     POPT_ARG_STRING,                                                                              \
     &(o)->blank,                                                                                  \
     0,                                                                                            \
     "Subtract the readings of this file, of a dark sample or with the lamp covered",              \
     "FILE"},                                                                                      \
    {                                                                                              \
        "reference-brf", '\0', POPT_ARG_STRING, &(o)->reference, 0,                                \
            "Readings are relative to a reference of this reflectance factor: a number, or a "     \
            "table of theta_r_deg and brf",                                                        \
            "NUMBER|FILE"                                                                          \
    }

/* Reads a file of readings and corrects them. noise and floor: of a reading without a deviation of
 * its own, relative and in 1/sr. As tool_read_readings. */
gonio_status tool_read_corrected(const tool *t, const char *path,
                                 const gonio_readings_options *options,
                                 const correction_options *corrections, double noise, double floor,
                                 gonio_readings **readings);

#endif
