/* Measurements: readings of a material at pairs of directions, from arrays, plans or files, and the
 * simulated instrument.
 *
 * Readings are numbers: a pair of directions each, and a value for each channel. Channels are the
 * colours R, G, B, or wavelengths, or neither (a single sensor: one channel without a wavelength).
 * The value of a reading in a channel is at value[reading * channels + channel], in 1/sr, NaN where
 * nothing was read. A plan is readings without values.
 *
 * Readings may be shared by threads as long as none of them changes them. */
#ifndef GONIO_MEASUREMENT_H
#define GONIO_MEASUREMENT_H

#include <gonio/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_readings gonio_readings;

/* ---- what the numbers of a file stand for ---- */

/* Every choice is 0 for "as the file says, or as its format has it". */
enum { GONIO_AS_STATED = 0 };
typedef enum gonio_angle_unit { GONIO_DEGREES = 1, GONIO_RADIANS } gonio_angle_unit;
typedef enum gonio_value_kind {
    GONIO_VALUE_BRDF = 1,     /* f, 1/sr */
    GONIO_VALUE_FACTOR,       /* reflectance factor, pi f */
    GONIO_VALUE_PERCENT,      /* reflectance factor in per cent, 100 pi f */
    GONIO_VALUE_COSINE,       /* f cos theta_o, 1/sr */
    GONIO_VALUE_FACTOR_COSINE /* pi f cos theta_o */
} gonio_value_kind;
typedef enum gonio_mirror_azimuth {
    GONIO_MIRROR_180 = 1, /* phi_o = phi_i + 180 degrees is the mirror's side, as in gonio */
    GONIO_MIRROR_0        /* phi_o = phi_i is */
} gonio_mirror_azimuth;
typedef enum gonio_wavelength_unit {
    GONIO_NANOMETRES = 1,
    GONIO_MICROMETRES,
    GONIO_METRES
} gonio_wavelength_unit;
typedef enum gonio_zero_meaning {
    GONIO_ZEROS_MISSING = 1, /* 0 stands where nothing was measured */
    GONIO_ZEROS_DARK         /* 0 is a value */
} gonio_zero_meaning;

/* A convention; zero-initialised it changes nothing. */
typedef struct gonio_convention {
    const char
        *format;     /* the word of a format (gonio_readings_format_word); NULL: judged by content
                      */
    int angles;      /* gonio_angle_unit */
    int values;      /* gonio_value_kind */
    int mirror;      /* gonio_mirror_azimuth */
    int wavelengths; /* gonio_wavelength_unit */
    int zeros;       /* gonio_zero_meaning */
    int sample;      /* of a file of several samples: the number of one; 0: the first */
} gonio_convention;

/* A convention from text: "angles=radians,values=factor,mirror=0". Keys and words: angles=degrees,
 * radians; values=brdf, factor, percent, cosine, factor-cosine; mirror=180, 0; wavelengths=nm, um,
 * m; zeros=missing, dark; sample=NUMBER; format=WORD. What the text does not name stays as it is.
 * Errors: _ARGUMENT for a key or word that there is not; the message names those that there are. */
GONIO_API gonio_status gonio_convention_parse(gonio_context *context, const char *text,
                                              gonio_convention *convention);

/* The words and names of the formats of readings, in the order in which a file is tried; NULL past
 * the last. */
GONIO_API const char *gonio_readings_format_word(int index);

typedef struct gonio_readings_options {
    size_t size;           /* of this struct, which gonio_readings_options_default sets */
    bool values_needed;    /* of files: false: a plan will do */
    bool average_repeats;  /* a direction read more than once in the same channel: true to accept
                            * (least squares averages it), false to refuse */
    bool negative_to_zero; /* a reading below zero: true to take it as 0, false to refuse */
    gonio_convention as;   /* of files: what their numbers stand for, where it is other than they
                            * say */
} gonio_readings_options;

/* Values needed, repeats and negative readings refused. */
GONIO_API void gonio_readings_options_default_of(gonio_readings_options *options, size_t size);
static inline void gonio_readings_options_default(gonio_readings_options *options)
{
    gonio_readings_options_default_of(options, sizeof *options);
}

/* ---- from arrays ---- */

/* What readings are made of; all arrays stay the caller's. */
typedef struct gonio_readings_arrays {
    size_t size;              /* sizeof(gonio_readings_arrays) */
    size_t count;             /* readings, at least 1 */
    size_t channels;          /* 3 without wavelengths: R, G, B; at least 1 */
    const gonio_pair *pair;   /* [count], radians: theta in [0, pi/2), phi in [-2 pi, 2 pi] */
    const int *planned;       /* [count], the channel to be read there: 0 .. channels - 1, or
                               * GONIO_ALL_CHANNELS; NULL: all */
    const double *wavelength; /* [channels], nm, 100 to 1e6, no two the same; NULL: colours or
                               * unnamed channels */
    const double *value;      /* [count][channels], 1/sr, NaN: not read; NULL: nothing was read */
    const double *deviation;  /* [count][channels], standard deviations of the values, 1/sr, NaN:
                               * not known; NULL: none is known */
} gonio_readings_arrays;

/* Makes readings from arrays. options may be NULL (values_needed does not count). Messages call
 * them "readings", and reading k its line k + 1. Errors: _ARGUMENT (no readings or channels, a
 * planned channel that there is not, wavelengths that are no light or the same twice); _DATA as of
 * files; _MEMORY. */
GONIO_API gonio_status gonio_readings_create(gonio_context *context,
                                             const gonio_readings_arrays *arrays,
                                             const gonio_readings_options *options,
                                             gonio_readings **readings);

/* The directions of a plan as readings of R, G, B without values; they state the plan's basis,
 * components and method as its file does. Repeats are accepted. Errors: _ARGUMENT for a plan
 * without entries; _MEMORY. */
GONIO_API gonio_status gonio_readings_create_from_plan(gonio_context *context,
                                                       const gonio_plan *plan,
                                                       gonio_readings **readings);

/* A copy of readings, without the comments and other columns of their file. Errors: _MEMORY. */
GONIO_API gonio_status gonio_readings_copy(gonio_context *context, const gonio_readings *readings,
                                           gonio_readings **copy);

GONIO_API void gonio_readings_free(gonio_readings **readings);

/* ---- what is in them ---- */

/* Belongs to the readings, as do the pointers in it, and follows their changes: those to values,
 * deviations and wavelengths last until values or deviations are set. */
typedef struct gonio_readings_view {
    size_t count;
    size_t channels;
    const gonio_pair *pair;   /* [count], radians, phi in [0, 2 pi) */
    const int *planned;       /* [count], a channel or GONIO_ALL_CHANNELS */
    const double *wavelength; /* [channels], nm; NULL: colours or unnamed channels */
    const double *value;      /* [count][channels], 1/sr; NaN where nothing was read */
    const double *deviation; /* [count][channels], 1/sr, NaN where not known; NULL: none is known */
    const size_t *line;      /* [count], of the file, for messages */
    const char *path;        /* where they were read from, for messages */
    uint64_t basis;          /* fingerprint of the basis the plan was made for; 0: not stated */
    size_t components;       /* K of the plan; 0: not stated */
    const char *method;      /* of the plan; "": not stated */
    size_t notes;            /* messages of the file's reader: */
    const char *const *note; /* [notes] */
    size_t below_zero;       /* values of the file that were below zero and taken as 0 */
} gonio_readings_view;

GONIO_API const gonio_readings_view *gonio_readings_describe(const gonio_readings *readings);

/* Whether the channels are R, G, B: three without wavelengths. */
GONIO_API bool gonio_readings_are_colours(const gonio_readings *readings);

/* One value (NaN if it was not read or there is no such reading or channel), and the scale s of log
 * space of a channel: gonio_log_scale of a colour, 1/1500 1/sr of any other channel. */
GONIO_API double gonio_readings_value(const gonio_readings *readings, size_t reading,
                                      size_t channel);
GONIO_API double gonio_readings_scale(const gonio_readings *readings, size_t channel);

/* ---- changing them ---- */

/* Replaces channels and all values: value[count][channels] as in gonio_readings_arrays, NULL for
 * nothing read; deviations are dropped. options may be NULL; only negative_to_zero counts. Errors:
 * as gonio_readings_create; the readings are as before then. */
GONIO_API gonio_status gonio_readings_set_values(gonio_context *context, gonio_readings *readings,
                                                 size_t channels, const double *wavelength,
                                                 const double *value,
                                                 const gonio_readings_options *options);

/* Replaces one value. Errors: _ARGUMENT (no such reading or channel), _DATA (negative, infinite).
 */
GONIO_API gonio_status gonio_readings_set_value(gonio_context *context, gonio_readings *readings,
                                                size_t reading, size_t channel, double value);

/* Replaces the standard deviations: deviation[count][channels], 1/sr, NaN where not known; NULL
 * drops them. Errors: _DATA (negative, infinite), _MEMORY. */
GONIO_API gonio_status gonio_readings_set_deviations(gonio_context *context,
                                                     gonio_readings *readings,
                                                     const double *deviation);

/* ---- files ---- */

/* Reads a file of any format that gonio knows. The format is recognised by content:
 *
 * CSV (docs/plan-and-readings.md): `#` comment lines, a line of column names in any order, then a
 * line a reading. theta_i_deg, phi_i_deg, theta_o_deg, phi_o_deg and at least one of R_per_sr,
 * G_per_sr, B_per_sr are needed, or columns named by wavelength (400nm_per_sr); channel (R, G, B or
 * all) says what the plan meant to read there. A plan is such a file without values. Commas,
 * semicolons or tabs, any line ends, UTF-8 or UTF-16, comments, empty lines are understood, and
 * other usual names and units; other columns and comments are kept and written again. A note says
 * what columns that are not named so were taken for, and which hold numbers and are not read.
 *
 * Scattered readings as text, as Cornell's laboratory and pbrt have them: `#` comments, the number
 * of wavelengths, the wavelengths in nm, then for each reading theta_i, phi_i, theta_o, phi_o in
 * radians and a value in 1/sr for each wavelength, with line breaks anywhere.
 *
 * Angles: theta in (-90, 90) degrees, below zero with 180 degrees added to phi; rows at or below
 * the horizon are left out, and a note counts them. phi is any number. options may be NULL.
 * *readings is the caller's. Errors: _IO, _FORMAT (not such a file, missing columns, not a number),
 * _DATA (angles out of range, repeats, negative or non-finite values, no readings); the message
 * names the line. */
GONIO_API gonio_status gonio_readings_read(gonio_context *context, const char *path,
                                           const gonio_readings_options *options,
                                           gonio_readings **readings);

/* Writes readings: as BRDF JSON if the path ends in .json or .brdf, otherwise as CSV, with the
 * other columns of the CSV file that they came from; and with the comments of their file. JSON
 * keeps every digit, CSV 10 of values. command may be NULL. Whole or not at all. Errors: _IO,
 * _MEMORY. */
GONIO_API gonio_status gonio_readings_write(gonio_context *context, const gonio_readings *readings,
                                            const char *command, const char *path);

/* ---- readings of other readings ---- */

/* Which readings have the directions of one in `others`: same[count]. Errors: _MEMORY. */
GONIO_API gonio_status gonio_readings_find(gonio_context *context, const gonio_readings *readings,
                                           const gonio_readings *others, bool *same);

/* Takes the values of a plan's directions from readings of the same material at more directions: of
 * the nearest reading that is at the same directions to 1e-4 radians; if there is none, of one at
 * the same directions turned about the normal; or else of one at the reciprocal directions. What
 * was read more than once there is averaged, with a note. Errors: _DATA if nothing was read at a
 * direction; _MEMORY. */
GONIO_API gonio_status gonio_readings_look_up(gonio_context *context, gonio_readings *plan,
                                              const gonio_readings *known);

/* Replaces what was read more than once, at the same angles and in the same channel, by its mean in
 * each of these readings, with a note. Errors: _MEMORY. */
GONIO_API gonio_status gonio_readings_average_repeats(gonio_context *context,
                                                      gonio_readings *readings);

/* Drops channels in which nothing was read, with a note that names them. Of R, G, B those that stay
 * become channels without wavelengths: one of them is grey in a table. Readings without any value
 * stay as they are. Errors: _MEMORY. */
GONIO_API gonio_status gonio_readings_drop_empty_channels(gonio_context *context,
                                                          gonio_readings *readings);

/* Brings two readings into channels that can be compared. Spectra: b at the wavelengths of a,
 * linear between its own, NaN beyond them. If they are of different kinds, both as colours: spectra
 * under equal energy, a single channel as grey. Deviations are dropped where values change. Errors:
 * _MISMATCH (no wavelength in common; several channels that are neither colours nor wavelengths),
 * _MEMORY. */
GONIO_API gonio_status gonio_readings_share_channels(gonio_context *context, gonio_readings *a,
                                                     gonio_readings *b);

/* ---- the simulated instrument ---- */

typedef struct gonio_instrument_options {
    size_t size;  /* of this struct, which gonio_instrument_options_default sets */
    double noise; /* standard deviation relative to the value: 0.01 is 1 per cent */
    double floor; /* standard deviation of the additive noise, 1/sr */
    uint64_t seed;
    double outliers; /* share of directions, 0 to 1, where all values are ten times too large or too
                      * small */
} gonio_instrument_options;

/* No noise. */
GONIO_API void gonio_instrument_options_default_of(gonio_instrument_options *options, size_t size);
static inline void gonio_instrument_options_default(gonio_instrument_options *options)
{
    gonio_instrument_options_default_of(options, sizeof *options);
}

/* The simulated instrument: reads a known material at the directions of `readings` (a plan). R, G,
 * B become rho (1 + noise z) + floor z', clamped at 0, where z and z' are standard normal and
 * independent. A direction that occurs several times is read once. Where the material has no data
 * around a direction, nothing is read (NaN), and a note says how often. options may be NULL.
 * Errors: _DATA if it has data around none of the directions; _ARGUMENT for negative noise. */
GONIO_API gonio_status gonio_measure(gonio_context *context, gonio_readings *readings,
                                     const gonio_table *table,
                                     const gonio_instrument_options *options);

/* The same for any material. A material that can be evaluated at any directions is read in its own
 * channels, which become those of the readings; a channel without data at a direction is not read.
 * Otherwise, and if the plan names colours that the material lacks, its table is read. Errors: as
 * above, those of the material. */
GONIO_API gonio_status gonio_measure_material(gonio_context *context, gonio_readings *readings,
                                              const gonio_material *material,
                                              const gonio_instrument_options *options);

#ifdef __cplusplus
}
#endif
#endif
