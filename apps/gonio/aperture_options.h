/* The options of the instrument that made readings: its file, and its apertures. */
#ifndef GONIO_APERTURE_OPTIONS_H
#define GONIO_APERTURE_OPTIONS_H

#include "posterior_options.h"

typedef struct aperture_options {
    const char *instrument; /* a file or a word; NULL: none */
    const char *aperture;   /* "2" or "2,0.2"; NULL: those of the instrument */
    double detector;        /* half angles, degrees: set by aperture_options_apply */
    double source;
    gonio_instrument *made; /* the instrument, from aperture_options_apply on; NULL: none */
} aperture_options;

/* Rows of an option table. */
#define APERTURE_OPTIONS(o)                                                                        \
    {"instrument",                                                                                 \
     '\0',                                                                                         \
     POPT_ARG_STRING,                                                                              \
     &(o)->instrument,                                                                             \
     0,                                                                                            \
     "The readings were made by this instrument, a file or in-plane, two-arms or four-axis: its "  \
     "noise, saturation and apertures count (posterior)",                                          \
     "INSTRUMENT"},                                                                                \
    {                                                                                              \
        "aperture", '\0', POPT_ARG_STRING, &(o)->aperture, 0,                                      \
            "Half angle of the detector's aperture in degrees, or of detector and light: each "    \
            "reading is the mean over them (posterior)",                                           \
            "DEGREES[,DEGREES]"                                                                    \
    }

/* Checks the options. Returns false after an error message. `output`: the result's file. */
bool aperture_options_check(const tool *t, aperture_options *o, const char *output);

/* Reads the instrument, and sets the half angles and what is not given of its noise. Errors: those
 * of gonio_instrument_read. aperture_options_end releases the instrument. */
gonio_status aperture_options_apply(const tool *t, aperture_options *o,
                                    posterior_options *posterior);
void aperture_options_end(aperture_options *o);

#endif
