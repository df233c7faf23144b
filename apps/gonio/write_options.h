/* The options of writing materials, which several commands share. */
#ifndef GONIO_WRITE_OPTIONS_H
#define GONIO_WRITE_OPTIONS_H

#include "command_line.h"

typedef struct write_options {
    const char *format;
    const char *steps;
    const char *illuminant;
    int average_azimuths;
} write_options;

#define WRITE_OPTIONS(options)                                                                     \
    {"format",                                                                                     \
     '\0',                                                                                         \
     POPT_ARG_STRING,                                                                              \
     &(options)->format,                                                                           \
     0,                                                                                            \
     "merl, rgl, table, klems, zemax or csv (default: by OUT's extension: .bsdf is rgl, .h5 "      \
     "table, .xml klems, .csv csv, all else merl)",                                                \
     "FORMAT"},                                                                                    \
        {"illuminant",                                                                             \
         '\0',                                                                                     \
         POPT_ARG_STRING,                                                                          \
         &(options)->illuminant,                                                                   \
         0,                                                                                        \
         "Light for the colours of spectra: E, D65 or A (default: E, equal energy)",               \
         "NAME"},                                                                                  \
        {"average-azimuths",                                                                       \
         '\0',                                                                                     \
         POPT_ARG_NONE,                                                                            \
         &(options)->average_azimuths,                                                             \
         0,                                                                                        \
         "Of an anisotropic material, write the mean over azimuths of the sample",                 \
         NULL},                                                                                    \
    {                                                                                              \
        "steps", '\0', POPT_ARG_STRING, &(options)->steps, 0,                                      \
            "Steps of theta_i, theta_o and phi in degrees, for csv and zemax (default: 10,5,10 "   \
            "and 5,5,7.5)",                                                                        \
            "T,T,P"                                                                                \
    }

/* Checks the options and turns them into *how. Returns false after an error message. */
bool write_options_check(const tool *t, const write_options *options, gonio_write_options *how);

/* Sets the illuminant of a material that is about to be written. */
gonio_status write_options_apply(const tool *t, const write_options *options,
                                 gonio_material *material);

/* Says what the mean over azimuths lacks of an anisotropic material, if it was written. */
gonio_status write_options_state_loss(tool *t, const gonio_write_options *how,
                                      gonio_material *material, const char *output);

#endif
