/* The inside of readings, shared by file formats and the instrument. */
#ifndef GONIO_READINGS_INTERNAL_H
#define GONIO_READINGS_INTERNAL_H

#include <gonio/measurement.h>

#include "../core/comments.h"
#include "../core/core.h"

/* What a file holds besides readings: its format's, which writes it again. */
typedef struct gonio_i_attachment {
    void *data;
    void (*release)(void *data);
} gonio_i_attachment;

struct gonio_readings {
    char *path;
    gonio_readings_options options; /* that they were made with */
    size_t count;
    size_t room;     /* readings that the arrays below have room for */
    size_t expected; /* readings to make room for at once; 0: not known */
    size_t channels;
    gonio_pair *pair;
    int *planned;
    size_t *line;
    double *value;      /* [count][channels] */
    double *deviation;  /* [count][channels]; NULL: none is known */
    double *wavelength; /* [channels]; NULL: colours or unnamed channels */
    bool keep_angles;   /* angles are written as they were given: */
    double (*given)[4]; /* [count], theta_i, phi_i, theta_o, phi_o in degrees; or NULL */
    size_t below_zero;  /* values below zero that were taken as 0 */
    size_t *first_same; /* [count]: the first reading with the same directions */
    uint64_t basis;
    size_t components;
    const char *method;       /* that the comments state; "" */
    gonio_i_comments comment; /* of the file, which CSV has room for */
    gonio_i_comments note;    /* what its reader has to say of it */
    gonio_i_attachment attachment;
    gonio_readings_view view; /* of what is above */
};

/* ---- making them ---- */

/* What every function that changes readings ends with: the view of them as they are. */
void gonio_i_readings_update_view(gonio_readings *readings);

/* options may be NULL. Errors: _ARGUMENT (options that were not initialised), _MEMORY. */
gonio_status gonio_i_readings_new(gonio_context *context, const char *path,
                                  const gonio_readings_options *options, gonio_readings **readings);

/* The channels of readings that hold nothing yet. wavelength[channels] or NULL. */
gonio_status gonio_i_readings_begin(gonio_context *context, gonio_readings *readings,
                                    size_t channels, const double *wavelength);

/* One reading as files have them. */
typedef struct gonio_i_reading {
    double degrees[4]; /* theta_i, phi_i, theta_o, phi_o; phi in [-360, 360] */
    int planned;
    size_t line;
    const double *value;     /* [channels] */
    const double *deviation; /* [channels] or NULL, in all readings the same */
} gonio_i_reading;

/* Adds a reading; every number is checked, and a value below zero becomes 0 if it may. */
gonio_status gonio_i_readings_add(gonio_context *context, gonio_readings *readings,
                                  const gonio_i_reading *reading);

/* The last step: the same directions are found, and refused unless repeats are to be averaged.
 * `measured`: they are readings, not a plan. */
gonio_status gonio_i_readings_finish(gonio_context *context, gonio_readings *readings,
                                     bool measured);

/* Values of all readings in some number of channels, [count][channels], all NaN; NULL when out of
 * memory. The caller frees them. */
double *gonio_i_make_values(gonio_context *context, const gonio_readings *readings,
                            size_t channels);

/* Other channels for all readings; their values are NaN. */
gonio_status gonio_i_readings_set_channels(gonio_context *context, gonio_readings *readings,
                                           size_t channels, const double *wavelength);

/* What the reader of a file says of it ("taken as reflectance factor"): kept, and told to the
 * context. */
gonio_status gonio_i_readings_note(gonio_context *context, gonio_readings *readings,
                                   const char *format, ...) GONIO_I_PRINTF(3, 4);

/* The values of one reading. */
static inline double *gonio_i_readings_values(gonio_readings *readings, size_t reading)
{
    return readings->value + reading * readings->channels;
}

/* theta_i, phi_i, theta_o or phi_o (which: 0 to 3) in degrees: as the file has it, if that is kept,
 * or of the pair. */
double gonio_i_readings_degrees(const gonio_readings *readings, size_t reading, size_t which);

/* The name of a channel's column of values: R_per_sr, 400nm_per_sr, value_per_sr; of their
 * deviations: R_deviation_per_sr and so on. */
enum { GONIO_I_NAME_ROOM = 64 };
void gonio_i_value_name(const gonio_readings *readings, size_t channel, bool deviation,
                        char name[GONIO_I_NAME_ROOM]);

/* ---- the same directions (repeats.c, look_up.c) ---- */

/* The reading that is nearest to each pair of directions, as they are or turned about the normal:
 * found[count], readings->count where there is none. Errors: _MEMORY. */
gonio_status gonio_i_find_readings(gonio_context *context, const gonio_readings *readings,
                                   const gonio_pair *pair, size_t count, size_t *found);

/* Fills in first_same for readings in any order. */
gonio_status gonio_i_readings_group(gonio_context *context, gonio_readings *readings);

/* How many readings with values are the same directions as another one but for an azimuth where
 * theta is 0. */
gonio_status gonio_i_readings_count_pole_repeats(gonio_context *context,
                                                 const gonio_readings *readings, size_t *repeats);

/* _DATA if a direction is listed more than once for a channel. */
gonio_status gonio_i_readings_refuse_repeats(gonio_context *context, const gonio_readings *readings,
                                             bool measured);

#endif
