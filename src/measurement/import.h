/* Turns the rows of a file, in its own convention, into readings.
 *
 * A reader adds rows between gonio_i_import_begin and _end. Azimuths may be any numbers. A negative
 * theta means the other side of the normal: phi is turned by 180 degrees. Rows at or below the
 * horizon are left out and counted. So are rows without values, where values are needed. The end
 * writes a note: what the file was taken for, what was left out and why. */
#ifndef GONIO_IMPORT_H
#define GONIO_IMPORT_H

#include "marks.h"

/* Why a row is left out. */
typedef enum gonio_i_reason {
    GONIO_I_BELOW_HORIZON,
    GONIO_I_NOT_MEASURED,   /* no value, or 0 where 0 means that */
    GONIO_I_REPEATED,       /* the same directions and values */
    GONIO_I_LOST,           /* cut off near the horizon, or stray light (horizon.h) */
    GONIO_I_EXTRAPOLATED,   /* the file states that the value was not measured */
    GONIO_I_NOT_THE_SAMPLE, /* a reference or dark row that cannot be used */
    GONIO_I_REASONS
} gonio_i_reason;

typedef struct gonio_i_import {
    gonio_context *context;
    gonio_readings *readings;
    gonio_convention how; /* in force: the user's, otherwise the stated one */
    const char *taken_as; /* the format with its article, for the note */
    bool quiet;           /* no note if nothing was left out or changed */
    bool lenient;         /* see gonio_i_import_leniently */
    bool keep_unmeasured; /* rows without values stay: they are planned */
    double *value;        /* [channels] of a row */
    double *deviation;    /* [channels] */
    size_t left_out[GONIO_I_REASONS];
    size_t negative;       /* values taken as 0 */
    size_t negative_theta; /* rows with a theta below zero, of readings */
    gonio_i_marked_rows marked;
    double latest;          /* time so far, seconds; NaN: none */
    double days;            /* midnights that the clock has passed */
    size_t backwards;       /* rows that are earlier than the one before */
    size_t first_backwards; /* line */
} gonio_i_import;

/* One row. Angles in degrees (gonio_i_import_degrees), values as the file has them. */
typedef struct gonio_i_row {
    double degrees[4]; /* theta_i, phi_i, theta_o, phi_o; theta from the normal, -180 to 180 */
    int planned;       /* a channel or GONIO_ALL_CHANNELS */
    size_t line;
    gonio_i_mark mark;
    bool timed;              /* in all rows the same */
    double time;             /* seconds; NaN: not known */
    const double *value;     /* [channels], NaN where nothing was read */
    const double *deviation; /* [channels] or NULL, in all rows the same */
} gonio_i_row;

/* stated: what the file or its format says; `taken_as` is kept, not copied. */
void gonio_i_import_begin(gonio_i_import *import, gonio_context *context, gonio_readings *readings,
                          const char *taken_as, const gonio_convention *stated);

/* For files of instruments and their programs, which are not plans. Rows without a value are left
 * out. Rows that repeat the values of the same directions are left out (theta_o = 0 for each
 * azimuth); other repeats are accepted. Values below zero, which are noise about a dark level, are
 * taken as 0. Where 0 means not measured, readings lost near the horizon are left out. All are
 * counted. */
void gonio_i_import_leniently(gonio_i_import *import);

/* Sets the channels, before the first row. wavelength[channels], in the convention's unit, or NULL.
 * Errors: _FORMAT for a number that is no wavelength of light or occurs twice, _MEMORY. */
gonio_status gonio_i_import_channels(gonio_i_import *import, size_t channels,
                                     const double *wavelength);

/* An angle of the file in degrees. Angles in radians are rounded. */
double gonio_i_import_degrees(const gonio_i_import *import, double angle);

/* Rounds computed degrees to nine digits, so that equal directions are equal numbers. */
double gonio_i_import_rounded(double degrees);

/* Adds a row or leaves it out. Errors: _DATA for an impossible angle or value; the message has the
 * number as it is in the file. */
gonio_status gonio_i_import_add(gonio_i_import *import, const gonio_i_row *row);

/* Counts a row that the reader itself left out. */
static inline void gonio_i_import_leave_out(gonio_i_import *import, gonio_i_reason reason)
{
    import->left_out[reason]++;
}

/* Ends the import, also after an error: `status` is the reader's. Removes rows that repeat others
 * and writes the note. Errors: _DATA if no reading is left, _MEMORY, `status`. */
gonio_status gonio_i_import_end(gonio_i_import *import, gonio_status status);

/* ---- directions about the mirror direction ---- */

/* theta_o and phi_o - phi_i, degrees, of a direction that is given about the mirror direction of
 * theta_i: by its radial angle from it, and its azimuth about it. The azimuth is 0 towards the
 * normal and counted like phi. theta_o is above 90 below the horizon. */
void gonio_i_from_mirror(double theta_i, double radial, double azimuth, double *theta_o,
                         double *phi_difference);

#endif
