/* Rows of a file that are not readings of the sample: the reference and the dark level, read again
 * during a run. They are marked in a column of their own. With the time of each row they show how
 * the instrument drifts, which is corrected for. */
#ifndef GONIO_MARKS_H
#define GONIO_MARKS_H

#include "readings.h"

typedef enum gonio_i_mark {
    GONIO_I_SAMPLE = 0,
    GONIO_I_REFERENCE, /* a reference that does not change, always at the same directions */
    GONIO_I_DARK,      /* no light: the lamp is covered, or the sample is black */
    GONIO_I_MARKS
} gonio_i_mark;

/* The mark that a cell names; an unknown word is the sample. */
gonio_i_mark gonio_i_mark_of(const char *cell);

typedef struct gonio_i_marked {
    gonio_i_mark mark;
    double time; /* seconds, NaN: not known */
    size_t line;
    double degrees[4]; /* theta_i, phi_i, theta_o, phi_o, as in the file */
} gonio_i_marked;

/* Marked rows, in the order of the file. Zero-initialised: none. */
typedef struct gonio_i_marked_rows {
    size_t count;
    size_t room;
    gonio_i_marked *row; /* [count] */
    double *value;       /* [count][channels], as in the file */
} gonio_i_marked_rows;

/* Adds a row; value[channels]. Errors: _MEMORY. */
gonio_status gonio_i_marked_add(gonio_context *context, gonio_i_marked_rows *rows, size_t channels,
                                const gonio_i_marked *row, const double *value);
void gonio_i_marked_free(gonio_i_marked_rows *rows);

/* Subtracts the dark level at the time of each reading, then divides by the gain: that of the
 * reference relative to its first reading. Between marked rows both are interpolated; before the
 * first and after the last they stay. Where a time is missing, the line of the file is the clock.
 * Notes say what was done. Errors: _MEMORY. */
gonio_status gonio_i_marked_apply(gonio_context *context, gonio_readings *readings,
                                  const gonio_i_marked_rows *rows);

#endif
