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

#include <gonio/instrument.h>
#include <gonio/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_readings gonio_readings;

/* ---- units and conventions of files ---- */

/* Every choice is 0 for "as the file or its format states". */
enum { GONIO_AS_STATED = 0 };
typedef enum gonio_angle_unit {
    GONIO_DEGREES = 1,
    GONIO_RADIANS,
    GONIO_GRADIANS /* 400 to a turn, gon */
} gonio_angle_unit;
typedef enum gonio_value_scale {
    GONIO_SCALE_LINEAR = 1,
    GONIO_SCALE_LOG10,  /* the numbers are logarithms to base 10 of the values */
    GONIO_SCALE_LN,     /* natural logarithms */
    GONIO_SCALE_DECIBEL /* ten times those to base 10 */
} gonio_value_scale;
typedef enum gonio_mirror_azimuth {
    GONIO_MIRROR_180 = 1, /* the mirror direction is at phi_o = phi_i + 180 degrees, as in gonio */
    GONIO_MIRROR_0        /* the mirror direction is at phi_o = phi_i */
} gonio_mirror_azimuth;
typedef enum gonio_wavelength_unit {
    GONIO_NANOMETRES = 1,
    GONIO_MICROMETRES,
    GONIO_METRES
} gonio_wavelength_unit;
typedef enum gonio_zero_meaning {
    GONIO_ZEROS_MISSING = 1, /* 0 means that nothing was measured */
    GONIO_ZEROS_DARK         /* 0 is a value */
} gonio_zero_meaning;

/* A convention. If it is zero-initialised, it changes nothing. */
typedef struct gonio_convention {
    const char
        *format;     /* the word of a format (gonio_readings_format_word); NULL: judged by content
                      */
    int angles;      /* gonio_angle_unit */
    int values;      /* gonio_value_kind (instrument.h) */
    int mirror;      /* gonio_mirror_azimuth */
    int wavelengths; /* gonio_wavelength_unit */
    int zeros;       /* gonio_zero_meaning */
    int sample;      /* number of the sample in a file of several; 0: the first */
    int scale;       /* gonio_value_scale */
} gonio_convention;

/* Reads a convention from text: "angles=radians,values=factor,mirror=0". Keys and words:
 * angles=degrees, radians, gon; values=brdf, factor, percent, cosine, factor-cosine, relative,
 * counts; scale=linear, log10, ln, db; mirror=180, 0; wavelengths=nm, um, m; zeros=missing, dark;
 * sample=NUMBER; format=WORD. Fields that the text does not name stay. Errors: _ARGUMENT for an
 * unknown key or word; the message lists the known ones. */
GONIO_API gonio_status gonio_convention_parse(gonio_context *context, const char *text,
                                              gonio_convention *convention);

/* The words and names of the formats of readings, in the order in which a file is tried; NULL past
 * the last. */
GONIO_API const char *gonio_readings_format_word(int index);

typedef struct gonio_readings_options {
    size_t size;           /* of this struct, which gonio_readings_options_default sets */
    bool values_needed;    /* of files; false: a plan without values is accepted */
    bool average_repeats;  /* a direction read more than once in the same channel: true to accept
                            * (least squares averages it), false to refuse */
    bool negative_to_zero; /* a reading below zero: true to take it as 0, false to refuse */
    gonio_convention as;   /* of files: units and conventions other than the stated ones */
    /* Of files: the instrument that made them, needed until they are read; NULL: not known. Where
     * names and comments of a table state no kind of values, its kind holds. Its reference_factors
     * and counts_of_1_per_sr are those of relative values and counts. */
    const gonio_instrument *instrument;
    bool directions_only; /* of files: nothing is asked or said of what values are; those of tables
                           * are not read. For lists of directions */
} gonio_readings_options;

/* Values are needed. Repeats and negative readings are refused. */
GONIO_API void gonio_readings_options_default_of(gonio_readings_options *options, size_t size);
static inline void gonio_readings_options_default(gonio_readings_options *options)
{
    gonio_readings_options_default_of(options, sizeof *options);
}

/* ---- from arrays ---- */

/* The arrays of readings. All of them stay the caller's. */
typedef struct gonio_readings_arrays {
    size_t size;              /* sizeof(gonio_readings_arrays) */
    size_t count;             /* readings, at least 1 */
    size_t channels;          /* 3 without wavelengths: R, G, B; at least 1 */
    const gonio_pair *pair;   /* [count], radians: theta in [0, pi/2), phi in [-2 pi, 2 pi] */
    const int *planned;       /* [count], the planned channel: 0 .. channels - 1, or
                               * GONIO_ALL_CHANNELS; NULL: all */
    const double *wavelength; /* [channels], nm, 100 to 1e6, no two the same; NULL: colours or
                               * unnamed channels */
    const double *value;      /* [count][channels], 1/sr, NaN: not read; NULL: nothing was read */
    const double *deviation;  /* [count][channels], standard deviations of the values, 1/sr, NaN:
                               * not known; NULL: none is known */
} gonio_readings_arrays;

/* Makes readings from arrays. options may be NULL (values_needed does not count). Messages call
 * them "readings" and reading k line k + 1. Errors: _ARGUMENT (no readings or channels, an unknown
 * planned channel, impossible or equal wavelengths); _DATA as for files; _MEMORY. */
GONIO_API gonio_status gonio_readings_create(gonio_context *context,
                                             const gonio_readings_arrays *arrays,
                                             const gonio_readings_options *options,
                                             gonio_readings **readings);

/* Makes readings of R, G, B without values at the directions of a plan. They state the plan's
 * basis, components and method, as its file does. Repeats are accepted. Errors: _ARGUMENT for a
 * plan without entries; _MEMORY. */
GONIO_API gonio_status gonio_readings_create_from_plan(gonio_context *context,
                                                       const gonio_plan *plan,
                                                       gonio_readings **readings);

/* A copy of readings, without the comments and other columns of their file. Errors: _MEMORY. */
GONIO_API gonio_status gonio_readings_copy(gonio_context *context, const gonio_readings *readings,
                                           gonio_readings **copy);

GONIO_API void gonio_readings_free(gonio_readings **readings);

/* ---- contents ---- */

/* What readings hold. The view and its pointers belong to the readings and follow their changes.
 * The pointers to values, deviations and wavelengths are valid until values or deviations are set.
 */
typedef struct gonio_readings_view {
    size_t count;
    size_t channels;
    const gonio_pair *pair;   /* [count], radians, phi in [0, 2 pi) */
    const int *planned;       /* [count], a channel or GONIO_ALL_CHANNELS */
    const double *wavelength; /* [channels], nm; NULL: colours or unnamed channels */
    const double *value;      /* [count][channels], 1/sr; NaN where nothing was read */
    const double *deviation; /* [count][channels], 1/sr, NaN where not known; NULL: none is known */
    const size_t *line;      /* [count], of the file, for messages */
    const char *path;        /* the file that they were read from, for messages */
    uint64_t basis;          /* fingerprint of the basis the plan was made for; 0: not stated */
    size_t components;       /* K of the plan; 0: not stated */
    const char *method;      /* of the plan; "": not stated */
    size_t notes;            /* number of messages of the file's reader, */
    const char *const *note; /* [notes] */
    size_t below_zero;       /* number of values of the file below zero, which were taken as 0 */
    const double *time;      /* [count], seconds from any beginning, NaN where not known; NULL: none
                              * is known */
} gonio_readings_view;

GONIO_API const gonio_readings_view *gonio_readings_describe(const gonio_readings *readings);

/* Whether the channels are R, G, B: three without wavelengths. */
GONIO_API bool gonio_readings_are_colours(const gonio_readings *readings);

/* One value: NaN if it was not read, or if the reading or channel does not exist. And the scale s
 * of a channel in log space: gonio_log_scale for a colour, 1/1500 1/sr for any other channel. */
GONIO_API double gonio_readings_value(const gonio_readings *readings, size_t reading,
                                      size_t channel);
GONIO_API double gonio_readings_scale(const gonio_readings *readings, size_t channel);

/* ---- changes ---- */

/* Replaces channels and all values: value[count][channels] as in gonio_readings_arrays, NULL for
 * nothing read. Deviations are dropped. options may be NULL; only negative_to_zero counts. Errors:
 * as gonio_readings_create; the readings then stay as they are. */
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
 * line for each reading. Needed are theta_i_deg, phi_i_deg, theta_o_deg, phi_o_deg and at least one
 * of R_per_sr, G_per_sr, B_per_sr or a column named by wavelength (400nm_per_sr). The column
 * channel (R, G, B or all) is the planned channel. A plan is such a file without values. Cells are
 * separated by commas, semicolons or tabs. Any line ends, UTF-8 or UTF-16, empty lines, and other
 * usual names and units are understood. Other columns and comments are kept and written again. A
 * note says what columns with other names were taken for, and which columns of numbers are not
 * read.
 *
 * Scattered readings as text, in the format of Cornell's laboratory and pbrt: `#` comments, the
 * number of wavelengths, the wavelengths in nm, then for each reading theta_i, phi_i, theta_o,
 * phi_o in radians and a value in 1/sr for each wavelength, with line breaks anywhere.
 *
 * A CSV column time (seconds, minutes, a clock or a date with one) is the time of each row. Rows
 * that a column mark calls reference or dark are no readings: a reference that was read again
 * during the run corrects for drift, and dark rows are subtracted.
 *
 * theta is in (-90, 90) degrees; if it is below zero, 180 degrees are added to phi. phi is any
 * number. Rows at or below the horizon are left out, and a note counts them. options may be NULL.
 * *readings is the caller's. Errors: _IO, _FORMAT (not such a file, missing columns, not a number),
 * _DATA (angles out of range, repeats, negative or non-finite values, no readings); the message
 * names the line. */
GONIO_API gonio_status gonio_readings_read(gonio_context *context, const char *path,
                                           const gonio_readings_options *options,
                                           gonio_readings **readings);

/* Reads the text of such a file from memory: text[size]. `name` stands for the path in messages.
 * The text stays the caller's. Errors: as gonio_readings_read, except _IO. */
GONIO_API gonio_status gonio_readings_read_text(gonio_context *context, const char *name,
                                                const char *text, size_t size,
                                                const gonio_readings_options *options,
                                                gonio_readings **readings);

/* Writes readings with the comments of their file: as BRDF JSON if the path ends in .json or .brdf,
 * otherwise as CSV, with the other columns of the CSV file that they came from. JSON keeps every
 * digit, CSV 10 digits of values. command may be NULL. The file appears whole or not at all.
 * Errors: _IO, _MEMORY. */
GONIO_API gonio_status gonio_readings_write(gonio_context *context, const gonio_readings *readings,
                                            const char *command, const char *path);

/* ---- two sets of readings ---- */

/* Finds the readings whose directions occur in `others`, as gonio_readings_look_up does:
 * same[count]. Errors: _MEMORY. */
GONIO_API gonio_status gonio_readings_find(gonio_context *context, const gonio_readings *readings,
                                           const gonio_readings *others, bool *same);

/* Looks up the values of a plan's directions in readings of the same material at more directions. A
 * direction gets the nearest reading within 1e-4 radians. If there is none, it gets one whose
 * directions are rotated about the normal, otherwise one at the reciprocal directions. Where the
 * readings themselves differ as the sample turns, by 15 % and more (median), rotated ones are not
 * taken. Repeats are averaged, with a note. Errors: _DATA if a direction was not read; _MEMORY. */
GONIO_API gonio_status gonio_readings_look_up(gonio_context *context, gonio_readings *plan,
                                              const gonio_readings *known);

/* Replaces each value that was read more than once, at the same angles and in the same channel, by
 * the mean of these values, with a note. Errors: _MEMORY. */
GONIO_API gonio_status gonio_readings_average_repeats(gonio_context *context,
                                                      gonio_readings *readings);

/* Subtracts a blank run: readings of a dark sample, or with the lamp covered, in the same channels.
 * A reading gets the blank of its own directions, the mean of repeats, otherwise the blank's
 * median; levels are compared in the unit of the files. Values below the blank become 0. The
 * deviations of the readings then hold that of the blank: its own, that of its repeats, or its
 * scatter. noise (relative) and floor (1/sr): of a reading without a deviation of its own. Notes
 * say what was subtracted, and if the blank is brighter than the sample. Errors: _MISMATCH for
 * other channels; _MEMORY. */
GONIO_API gonio_status gonio_readings_subtract_blank(gonio_context *context,
                                                     gonio_readings *readings,
                                                     const gonio_readings *blank, double noise,
                                                     double floor);

/* Reads the table of a reference: CSV with the columns theta_r_deg and brf, its reflectance factor
 * (pi times its BRDF) at that angle of the detector. *row is sorted by angle, and the caller's, to
 * be freed by free(). Errors: _IO, _FORMAT, _DATA (no rows, impossible numbers), _MEMORY. */
GONIO_API gonio_status gonio_reference_read(gonio_context *context, const char *path,
                                            gonio_reference_row **row, size_t *rows);

/* Multiplies readings that are relative to a reference (GONIO_VALUE_RELATIVE), and their
 * deviations, by its reflectance factor at theta_o: linear between rows, constant outside. Errors:
 * _ARGUMENT without rows; _MEMORY. */
GONIO_API gonio_status gonio_readings_times_reference(gonio_context *context,
                                                      gonio_readings *readings,
                                                      const gonio_reference_row *row, size_t rows);

/* Drops channels in which nothing was read, with a note that names them. If some of R, G, B are
 * dropped, the others become channels without wavelengths; a single one is grey in a table.
 * Readings without any value stay as they are. Errors: _MEMORY. */
GONIO_API gonio_status gonio_readings_drop_empty_channels(gonio_context *context,
                                                          gonio_readings *readings);

/* Converts two sets of readings to common channels. If both are spectra, b is interpolated at the
 * wavelengths of a, with NaN outside its range. If they are of different kinds, both become
 * colours: spectra under equal energy, a single channel as grey. Deviations are dropped where
 * values change. Errors: _MISMATCH (no common range of wavelengths; several channels that are
 * neither colours nor wavelengths), _MEMORY. */
GONIO_API gonio_status gonio_readings_share_channels(gonio_context *context, gonio_readings *a,
                                                     gonio_readings *b);

/* ---- what readings may be ---- */

/* Something else that readings may be. */
typedef struct gonio_alternative {
    const char *mistake; /* "the values are in per cent; divide them by 100"; static */
    double albedo;       /* that the readings have then, in the brightest channel */
    double margin;       /* ln of how many times as well it explains the readings, extremes limited;
                          * 0 for units, which are judged by the albedo */
} gonio_alternative;

enum { GONIO_MOST_ALTERNATIVES = 4, GONIO_MOST_UNMEASURED_LINES = 8 };

/* What the readings seem to be, by the method posterior with a basis of separate channels. */
typedef struct gonio_interpretation {
    double albedo;       /* of the readings as they are, in the brightest channel, a mean over
                          * three incidences; 0 where it was not looked for (no_checks) */
    size_t alternatives; /* usual mistakes that explain the readings far better, or without which
                          * they reflect more than they receive: the likeliest first */
    gonio_alternative alternative[GONIO_MOST_ALTERNATIVES];
    size_t unmeasured; /* readings of nothing: far below what the others predict, as where a
                        * detector hides the light. They are left out */
    size_t unmeasured_line[GONIO_MOST_UNMEASURED_LINES]; /* of the file: the first of them */
    size_t turned_pairs; /* readings at the angles of others but at another turn of the sample */
    double turned;       /* median of |ln| of the ratio of their values; 0 without such pairs */
    bool anisotropic;    /* they differ by far more than readings of an isotropic material do, or
                          * anisotropy_evidence says so */
    double anisotropy_evidence; /* ln of the odds that the material is anisotropic, if the readings
                                 * are at several turns of the sample; 0 where it was not weighed.
                                 * If wrong azimuths explain far more, `anisotropic` is false all
                                 * the same; otherwise they are not told */
} gonio_interpretation;

/* ---- the simulated instrument ---- */

typedef struct gonio_instrument_options {
    size_t size;  /* of this struct, which gonio_instrument_options_default sets */
    double noise; /* standard deviation relative to the value: 0.01 is 1 per cent */
    double floor; /* standard deviation of the additive noise, 1/sr */
    uint64_t seed;
    double outliers; /* share of directions, 0 to 1, where all values are ten times too large or too
                      * small */
} gonio_instrument_options;

/* The default has no noise. */
GONIO_API void gonio_instrument_options_default_of(gonio_instrument_options *options, size_t size);
static inline void gonio_instrument_options_default(gonio_instrument_options *options)
{
    gonio_instrument_options_default_of(options, sizeof *options);
}

/* Reads a known material at the directions of `readings` (a plan). R, G, B become rho (1 + noise z)
 * + floor z', clamped at 0, where z and z' are standard normal and independent. A direction that
 * occurs several times is read once. If the material has no data around a direction, nothing is
 * read (NaN); a note counts these directions. options may be NULL. Errors: _DATA if there are no
 * data around any of the directions; _ARGUMENT for negative noise. */
GONIO_API gonio_status gonio_measure(gonio_context *context, gonio_readings *readings,
                                     const gonio_table *table,
                                     const gonio_instrument_options *options);

/* The same for any material. A material that can be evaluated at any directions is read in its own
 * channels, which become those of the readings. A channel without data at a direction is not read.
 * Other materials are read from their table, and so is a material without the colours that the plan
 * names. Errors: as gonio_measure, those of the material. */
GONIO_API gonio_status gonio_measure_material(gonio_context *context, gonio_readings *readings,
                                              const gonio_material *material,
                                              const gonio_instrument_options *options);

/* Rehearses a run: writes what an instrument would write when it reads a material at the directions
 * of a plan, in their order. Values are means over the apertures, with noise, drift, dark level,
 * stray light and saturation, in the instrument's kind of values (1/sr if they are relative or
 * counts); a comment `values:` names it. The CSV file has the time of each row, and rows of the
 * reference and the dark level (docs/plan-and-readings.md). Channels are those of the material.
 * command, duration (s) and channels (their number) may be NULL. Errors: _MISMATCH for directions
 * that the instrument cannot read; those of gonio_measure_material; _IO. */
GONIO_API gonio_status gonio_rehearse(gonio_context *context, const gonio_readings *plan,
                                      const gonio_material *material,
                                      const gonio_instrument *instrument, uint64_t seed,
                                      const char *command, const char *path, double *duration,
                                      size_t *channels);

#ifdef __cplusplus
}
#endif
#endif
