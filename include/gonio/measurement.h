/* Measurements: readings of a new material at chosen directions, and the simulated instrument.
 *
 * A readings file is CSV (docs/plan-and-readings.md): `#` comment lines, a line of column names in
 * any order, then a line a direction. theta_i_deg, phi_i_deg, theta_o_deg, phi_o_deg and at least
 * one of R_per_sr, G_per_sr, B_per_sr are needed; channel (R, G, B or all) says what the plan meant
 * to read there; other columns are kept. A plan is such a file without values.
 *
 * Spectral readings have columns named by wavelength, 400nm_per_sr and so on, instead. Scattered
 * readings as text, as Cornell's laboratory and pbrt have them, are read too: `#` comments, the
 * number of wavelengths, the wavelengths in nm, then for each reading theta_i, phi_i, theta_o,
 * phi_o in radians and a value in 1/sr for each wavelength, with line breaks anywhere. */
#ifndef GONIO_MEASUREMENT_H
#define GONIO_MEASUREMENT_H

#include <gonio/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_reading {
    gonio_pair pair;              /* radians */
    int channel;                  /* what was planned: 0 .. 2 or GONIO_ALL_CHANNELS */
    double value[GONIO_CHANNELS]; /* 1/sr; NaN where nothing was read */
    size_t line;                  /* of the file, for messages; 0 if there is none */
} gonio_reading;

typedef struct gonio_readings gonio_readings;

typedef struct gonio_readings_options {
    bool values_needed;    /* false: a plan will do */
    bool average_repeats;  /* a direction read more than once in the same channel: true to accept
                            * (least  squares averages it), false to refuse */
    bool negative_to_zero; /* a reading below zero: true to take it as 0, false to refuse */
} gonio_readings_options;

/* Values needed, repeats and negative readings refused. */
GONIO_API void gonio_readings_options_default(gonio_readings_options *options);

/* Reads a file. Accepts commas, semicolons or tabs, CRLF, a byte-order mark, comments, empty lines.
 * Angles: theta in [0, 90) degrees (a direction at or below the horizon is refused), phi in
 * [-360, 360].
 * Errors: _IO, _FORMAT (not such a file, missing columns, not a number), _DATA (angles out of
 * range, repeats, negative or non-finite values, no readings); the message names the line. */
GONIO_API gonio_status gonio_readings_read(gonio_context *context, const char *path,
                                           const gonio_readings_options *options,
                                           gonio_readings **readings);

GONIO_API void gonio_readings_free(gonio_readings **readings);

typedef struct gonio_readings_view {
    size_t count;
    const gonio_reading *reading;
    const char *path;         /* where it was read from, for messages */
    uint64_t basis;           /* fingerprint of the basis the plan was made for; 0 if not stated */
    size_t components;        /* K of the plan; 0 if not stated */
    const char *method;       /* of the plan; "" if not stated */
    size_t wavelengths;       /* of spectral readings; 0: R, G, B */
    const double *wavelength; /* [wavelengths], nm */
    const double *spectrum;   /* [count][wavelengths], 1/sr; NaN where nothing was read */
} gonio_readings_view;

/* Channels of the readings: 3, or their wavelengths; the value of one of them (NaN if it was not
 * read), and its scale s of log space: gonio_log_scale, 1/1500 for a wavelength. */
GONIO_API size_t gonio_readings_channels(const gonio_readings *readings);
GONIO_API double gonio_readings_value(const gonio_readings *readings, size_t reading,
                                      size_t channel);
GONIO_API double gonio_readings_scale(const gonio_readings *readings, size_t channel);

/* Which readings have the directions of one in `others`: same[count]. */
GONIO_API gonio_status gonio_readings_find(gonio_context *context, const gonio_readings *readings,
                                           const gonio_readings *others, bool *same);

/* Takes the values of a plan's directions from readings of the same material at more directions:
 * those with the same half/difference coordinates to 1e-4 radians. Errors: _DATA if there are none
 * at a direction. */
GONIO_API gonio_status gonio_readings_look_up(gonio_context *context, gonio_readings *plan,
                                              const gonio_readings *known);

GONIO_API gonio_readings_view gonio_readings_describe(const gonio_readings *readings);

typedef struct gonio_instrument_options {
    double noise; /* standard deviation relative to the value: 0.01 is 1 per cent */
    double floor; /* standard deviation of the additive noise, 1/sr */
    uint64_t seed;
    double outliers; /* share of directions, 0 to 1, where all values are ten times too large or too
                      * small */
} gonio_instrument_options;

/* No noise. */
GONIO_API void gonio_instrument_options_default(gonio_instrument_options *options);

/* The simulated instrument: puts a known material at the directions of `readings` (a plan) and
 * fills in all channels with rho (1 + noise z) + floor z', z and z' standard normal and
 * independent, clamped at 0. A direction that occurs several times is read once. Errors: _DATA if
 * the material has no data around a direction; _ARGUMENT for negative noise. */
GONIO_API gonio_status gonio_measure(gonio_context *context, gonio_readings *readings,
                                     const gonio_table *table,
                                     const gonio_instrument_options *options);

/* Writes readings, other columns and comments of the file they came from included. */
GONIO_API gonio_status gonio_readings_write(gonio_context *context, const gonio_readings *readings,
                                            const char *command, const char *path);

#ifdef __cplusplus
}
#endif
#endif
