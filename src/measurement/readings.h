/* The inside of readings, shared by file formats and the instrument. */
#ifndef GONIO_READINGS_INTERNAL_H
#define GONIO_READINGS_INTERNAL_H

#include <gonio/measurement.h>

#include "../core/comments.h"
#include "../core/core.h"
#include "../instrument/value_unit.h"

/* What a format keeps of a file besides readings, to write it again. */
typedef struct gonio_i_attachment {
    void *data;
    void (*release)(void *data);
} gonio_i_attachment;

struct gonio_readings {
    char *path;
    gonio_readings_options options; /* that they were made with */
    size_t count;
    size_t room;     /* readings that the arrays below have room for */
    size_t expected; /* number of readings to come; 0: not known */
    size_t channels;
    gonio_pair *pair;
    int *planned;
    size_t *line;
    double *value;                  /* [count][channels] */
    double *deviation;              /* [count][channels]; NULL: none is known */
    double *time;                   /* [count], seconds, NaN where not known; NULL: none is known */
    int usual_values;               /* gonio_value_kind of the instrument; 0: not known */
    gonio_i_value_unit unit;        /* of the numbers of their file */
    gonio_reference_row *reference; /* [unit.rows]; NULL: none */
    double *wavelength;             /* [channels]; NULL: colours or unnamed channels */
    bool keep_angles;               /* angles are written as they were given: */
    double (*given)[4]; /* [count], theta_i, phi_i, theta_o, phi_o in degrees; or NULL */
    size_t below_zero;  /* values below zero that were taken as 0 */
    size_t *first_same; /* [count]: the first reading with the same directions */
    uint64_t basis;
    size_t components;
    const char *method;       /* that the comments state; "" */
    gonio_i_comments comment; /* the comments of the file */
    gonio_i_comments note;    /* what its reader says of it */
    gonio_i_attachment attachment;
    gonio_readings_view view; /* of what is above */
};

/* ---- making them ---- */

/* Updates the view. Every function that changes readings ends with it. */
void gonio_i_readings_update_view(gonio_readings *readings);

/* options may be NULL. Errors: _ARGUMENT (options that were not initialised), _MEMORY. */
gonio_status gonio_i_readings_new(gonio_context *context, const char *path,
                                  const gonio_readings_options *options, gonio_readings **readings);

/* Sets the channels of readings that are still empty. wavelength[channels] or NULL. */
gonio_status gonio_i_readings_begin(gonio_context *context, gonio_readings *readings,
                                    size_t channels, const double *wavelength);

/* One reading as a file has it. */
typedef struct gonio_i_reading {
    double degrees[4]; /* theta_i, phi_i, theta_o, phi_o; phi in [-360, 360] */
    int planned;
    size_t line;
    bool timed;              /* in all readings the same */
    double time;             /* seconds, NaN: not known */
    const double *value;     /* [channels] */
    const double *deviation; /* [channels] or NULL, in all readings the same */
} gonio_i_reading;

/* Adds a reading and checks every number. A value below zero becomes 0 if the options allow it. */
gonio_status gonio_i_readings_add(gonio_context *context, gonio_readings *readings,
                                  const gonio_i_reading *reading);

/* The last step: finds equal directions, and refuses them unless repeats are to be averaged.
 * `measured`: these are readings, not a plan. */
gonio_status gonio_i_readings_finish(gonio_context *context, gonio_readings *readings,
                                     bool measured);

/* Values of all readings in some number of channels, [count][channels], all NaN; NULL when out of
 * memory. The caller frees them. */
double *gonio_i_make_values(gonio_context *context, const gonio_readings *readings,
                            size_t channels);

/* Gives all readings other channels. Their values are NaN. */
gonio_status gonio_i_readings_set_channels(gonio_context *context, gonio_readings *readings,
                                           size_t channels, const double *wavelength);

/* Whether the values are those of an image of 8 bits in place of 1/sr. */
bool gonio_i_readings_are_levels(const gonio_readings *readings);

/* Adds a note on the file ("taken as reflectance factor") and tells it to the context. */
gonio_status gonio_i_readings_note(gonio_context *context, gonio_readings *readings,
                                   const char *format, ...) GONIO_I_PRINTF(3, 4);

/* The values of one reading. */
static inline double *gonio_i_readings_values(gonio_readings *readings, size_t reading)
{
    return readings->value + reading * readings->channels;
}

/* theta_i, phi_i, theta_o or phi_o (which: 0 to 3) in degrees: as in the file if that is kept,
 * otherwise from the pair. */
double gonio_i_readings_degrees(const gonio_readings *readings, size_t reading, size_t which);

/* The name of a channel's column of values (R_per_sr, 400nm_per_sr, value_per_sr) or deviations
 * (R_deviation_per_sr). */
enum { GONIO_I_NAME_ROOM = 64 };
void gonio_i_value_name(const gonio_readings *readings, size_t channel, bool deviation,
                        char name[GONIO_I_NAME_ROOM]);

/* ---- the same directions (repeats.c, look_up.c) ---- */

/* Finds the reading that matches each pair of directions, as it is or rotated about the normal:
 * found[count], readings->count where there is none. Rotated ones match if any_rotation, or if the
 * readings do not differ as the sample turns. After `most` comparisons the search ends; very many
 * readings at the same polar angles need that many. Errors: _MEMORY, _CANCELLED. */
gonio_status gonio_i_find_readings(gonio_context *context, const gonio_readings *readings,
                                   bool any_rotation, const gonio_pair *pair, size_t count,
                                   size_t most, size_t *found);

/* Fills in first_same for readings in any order. */
gonio_status gonio_i_readings_group(gonio_context *context, gonio_readings *readings);

/* Counts the readings with values that differ from another one only by an azimuth where theta is 0.
 */
gonio_status gonio_i_readings_count_pole_repeats(gonio_context *context,
                                                 const gonio_readings *readings, size_t *repeats);

/* Compares readings at the same theta_i, theta_o and phi_o - phi_i, to 0.01 degrees, that were made
 * at other turns of the sample. pairs: how many; median: that of the mean over the channels of
 * |ln((a + s)/(b + s))|, 0 without pairs. Errors: _MEMORY. */
gonio_status gonio_i_readings_compare_turned(gonio_context *context, const gonio_readings *readings,
                                             size_t *pairs, double *median);

/* Errors: _DATA if a direction is listed more than once for a channel. */
gonio_status gonio_i_readings_refuse_repeats(gonio_context *context, const gonio_readings *readings,
                                             bool measured);

#endif
