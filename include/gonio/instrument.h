/* Instruments: what a goniometer can reach, how it reads, and how long that takes.
 *
 * An instrument is a file in JSON (docs/instrument.md), the same text in memory, or the word of a
 * built-in one. Its kinematics say which pair of directions a setting of its axes makes, and which
 * settings make a pair. A pair can be read if one of its settings keeps all axes in their ranges,
 * all limits, and stays out of all forbidden zones.
 *
 * Angles are radians in the surface's frame (direction.h), axes too; times are seconds, values
 * 1/sr. An instrument does not change: threads may share it. */
#ifndef GONIO_INSTRUMENT_H
#define GONIO_INSTRUMENT_H

#include <stddef.h>

#include <gonio/context.h>
#include <gonio/direction.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_instrument gonio_instrument;

enum { GONIO_MOST_AXES = 8, GONIO_MOST_SETTINGS = 32 };

/* What the number of a reading stands for. */
typedef enum gonio_value_kind {
    GONIO_VALUE_BRDF = 1,      /* f, 1/sr */
    GONIO_VALUE_FACTOR,        /* reflectance factor, pi f */
    GONIO_VALUE_PERCENT,       /* reflectance factor in per cent, 100 pi f */
    GONIO_VALUE_COSINE,        /* f cos theta_o, 1/sr */
    GONIO_VALUE_FACTOR_COSINE, /* pi f cos theta_o */
    GONIO_VALUE_RELATIVE,      /* f over the BRDF of a named reference at the same directions */
    GONIO_VALUE_COUNTS         /* f cos theta_o times the counts of 1/sr */
} gonio_value_kind;

/* An axis. Its positions are a list, or a range in steps. */
typedef struct gonio_axis {
    const char *name;
    double low, high;       /* rad; equal: the axis cannot move */
    double step;            /* rad; 0: any position */
    double speed;           /* rad/s; 0: at once */
    double settling;        /* s, after a move */
    size_t positions;       /* 0: the range counts */
    const double *position; /* [positions], rad, ascending */
    bool present;           /* false: the instrument lacks this axis, which stands at 0 */
} gonio_axis;

/* A range of a quantity: of an axis, or of what follows from the directions. */
typedef struct gonio_range {
    const char *quantity; /* "theta_i", "theta_o", "phi_i", "phi_o", "azimuth" (between the two
                           * directions, 0 to pi), "separation" (of light and detector),
                           * "from_specular", or the name of an axis */
    double low, high;     /* rad */
} gonio_range;

/* What is forbidden: all ranges hold at once, each without its upper end. */
typedef struct gonio_zone {
    const char *name;
    size_t ranges;
    const gonio_range *range;
} gonio_zone;

/* The reflectance factor of the reference at the polar angle of the detector. */
typedef struct gonio_reference_row {
    double theta; /* rad, ascending */
    double factor;
} gonio_reference_row;

typedef struct gonio_instrument_view {
    const char *name;
    const char *path;       /* the file, or the word; for messages */
    const char *comment;    /* "" if there is none */
    const char *kinematics; /* gonio_kinematics_name */
    size_t axes;
    const gonio_axis *axis; /* [axes], in the kinematics' order */
    size_t limits;          /* ranges that have to hold, to within 0.02 degrees */
    const gonio_range *limit;
    size_t zones;
    const gonio_zone *zone;
    double lit, seen; /* diameters at normal incidence, mm; 0: no footprint is given */
    bool lit_inside;  /* the lit spot stays inside the seen one; false: the other way round */
    size_t channels;  /* 0: as the material has */
    const char *const *channel; /* [channels]: names */
    const double *wavelength;   /* [channels], nm; NULL: channels are names only */
    gonio_value_kind values;
    double counts;         /* of 1/sr, for GONIO_VALUE_COUNTS */
    const char *reference; /* its name, for GONIO_VALUE_RELATIVE; "" otherwise */
    size_t reference_rows; /* 0: an ideal diffuser, factor 1 */
    const gonio_reference_row *reference_row;
    double noise;           /* standard deviation relative to the value */
    double floor;           /* standard deviation of the additive noise, 1/sr */
    double dark;            /* level without light, which is in every reading, 1/sr */
    double stray;           /* the same that comes with the light, 1/sr */
    double saturation;      /* largest value that is read, 1/sr; infinity: none */
    double drift;           /* relative change of the sensitivity in an hour */
    double source_aperture; /* half angles, rad; 0: a point */
    double detector_aperture;
    double exposure;         /* s, of a reading */
    double incidence_change; /* s, in addition to the move, where theta_i changes */
    double reference_every;  /* s between reference readings; 0: none are made */
    double reference_time;   /* s that one takes, with its travel */
    bool in_turn;            /* axes move one after another; false: together */
    bool reciprocal;         /* light and detector may be exchanged */
    size_t directions;       /* of a table of reachable directions; 0 otherwise */
} gonio_instrument_view;

/* ---- making one ---- */

/* Reads an instrument: a file, or the word of a built-in one. *instrument is the caller's. Errors:
 * _IO; _FORMAT (no JSON, unknown or missing keys, values of the wrong kind); _DATA (contradictions,
 * nothing that can be reached). The message names the key. */
GONIO_API gonio_status gonio_instrument_read(gonio_context *context, const char *path,
                                             gonio_instrument **instrument);

/* The same from a text in memory. `name` is what messages call it; files that it names are found in
 * the current folder. */
GONIO_API gonio_status gonio_instrument_parse(gonio_context *context, const char *text,
                                              const char *name, gonio_instrument **instrument);

GONIO_API void gonio_instrument_free(gonio_instrument **instrument);
GONIO_API const gonio_instrument_view *
gonio_instrument_describe(const gonio_instrument *instrument);

/* Words and one-line descriptions of the built-in instruments, and of the kinematics; NULL past the
 * last. */
GONIO_API const char *gonio_instrument_word(int index);
GONIO_API const char *gonio_instrument_summary(int index);
GONIO_API const char *gonio_kinematics_name(int index);
GONIO_API const char *gonio_kinematics_summary(int index);

/* The words that a file uses for a kind of value ("factor-cosine"); NULL for none. */
GONIO_API const char *gonio_value_kind_name(gonio_value_kind kind);

/* ---- reach ---- */

/* A setting of the axes, and the directions that it reads. */
typedef struct gonio_setting {
    gonio_pair pair;
    double axis[GONIO_MOST_AXES]; /* rad, in the order of the view */
} gonio_setting;

/* The freedom that the sample and the use give: which other pairs tell the same. All false: the
 * pair itself is read. */
typedef struct gonio_freedom {
    bool isotropic;  /* both azimuths may turn together */
    bool bilateral;  /* the difference of azimuths may change its sign */
    bool reciprocal; /* light and detector may be exchanged; counts only where the instrument's view
                      * allows it too */
} gonio_freedom;

/* What the planner assumes of a sample: all. */
#define GONIO_ALL_FREEDOM                                                                          \
    {                                                                                              \
        true, true, true                                                                           \
    }

/* The directions that a setting of all axes reads; `axis` as in gonio_setting. Nothing is checked,
 * and one of the directions may be below the horizon. */
GONIO_API gonio_pair gonio_instrument_pair(const gonio_instrument *instrument, const double *axis);

/* What keeps a setting from being used: NULL if it can be, otherwise a text that lasts as long as
 * the instrument: the name of an axis, a limit or a zone, "horizon" or "footprint". */
GONIO_API const char *gonio_instrument_obstacle(const gonio_instrument *instrument,
                                                const gonio_setting *setting);

/* The settings that read a pair, or what tells the same, within the axes' steps: up to `most` of
 * them into setting[most] (GONIO_MOST_SETTINGS are enough), those that use less freedom first.
 * Returns how many. */
GONIO_API size_t gonio_instrument_settings(const gonio_instrument *instrument, gonio_pair pair,
                                           gonio_freedom freedom, gonio_setting *setting,
                                           size_t most);

/* What keeps an instrument from reading a pair, or what tells the same: NULL if it can be read,
 * otherwise as gonio_instrument_obstacle, an axis only if nothing else does; "kinematics" where the
 * axes cannot take it at all. */
GONIO_API const char *gonio_instrument_pair_obstacle(const gonio_instrument *instrument,
                                                     gonio_pair pair, gonio_freedom freedom);

/* The same of a region of pairs: what is between the positions of a list, or within 7.5 degrees of
 * a direction of a table, counts as reached. */
GONIO_API const char *gonio_instrument_region_obstacle(const gonio_instrument *instrument,
                                                       gonio_pair pair, gonio_freedom freedom);

/* The readings to choose a plan from: pairs that can be read, no two the same. They are on levels
 * of theta_i, with half vectors that crowd around the mirror direction. If another axis than that
 * of theta_i has a list of positions, they are what a grid of the axes' positions reads, with the
 * light at phi = 0 if the sample is isotropic. With full freedom at most a few ten thousand. At
 * most `most`: the levels, or the positions of axes without a list, then are further apart. The
 * arrays are the caller's and freed by free(). Errors: _DATA if nothing can be reached; the message
 * says what keeps most settings out. */
GONIO_API gonio_status gonio_instrument_candidates(gonio_context *context,
                                                   const gonio_instrument *instrument,
                                                   gonio_freedom freedom, size_t most,
                                                   gonio_setting **setting, size_t *count);

enum { GONIO_MOST_OBSTACLES = 64 };

/* What an instrument reaches of all pairs of directions. Shares are by projected solid angle of
 * both directions. */
typedef struct gonio_reach {
    double share;                  /* of the pairs that can be read, or are between what can
                                    * (gonio_instrument_region_obstacle), 0 to 1; 0 also where only a plane or single
                                    * directions can */
    double theta_i[2], theta_o[2]; /* the lowest and highest that can be read, rad */
    double least_separation;       /* of light and detector, rad */
    double least_from_specular;    /* distance from the mirror direction, rad */
    size_t obstacles;              /* what keeps the others out, the most frequent first */
    const char *obstacle[GONIO_MOST_OBSTACLES]; /* as gonio_instrument_obstacle; "kinematics" where
                                                 * no setting of the axes makes the pair */
    double kept_out[GONIO_MOST_OBSTACLES];      /* share of the pairs */
} gonio_reach;

/* Surveys what can be reached. Errors: _MEMORY; _DATA as for candidates. */
GONIO_API gonio_status gonio_instrument_survey(gonio_context *context,
                                               const gonio_instrument *instrument,
                                               gonio_freedom freedom, gonio_reach *reach);

/* ---- reading ---- */

/* Standard deviation of a reading of a BRDF value, 1/sr: (noise^2 f^2 + floor^2)^(1/2). */
GONIO_API double gonio_instrument_deviation(const gonio_instrument *instrument, double value);

/* The factor from a BRDF value to what the instrument states at a pair of directions. */
GONIO_API double gonio_instrument_value_factor(const gonio_instrument *instrument, gonio_pair pair);

enum { GONIO_MOST_APERTURE_RINGS = 4 };

/* A reading is the mean of the BRDF over both apertures. Fills in pairs of equal weight over them:
 * of each aperture that is not a point 1 + 3 rings (rings + 1) directions in rings of equal area.
 * sample[gonio_instrument_aperture_samples]; those below the horizon are left out. Returns how many
 * there are, at least 1. */
GONIO_API size_t gonio_instrument_aperture_samples(const gonio_instrument *instrument, int rings);
GONIO_API size_t gonio_instrument_aperture(const gonio_instrument *instrument, gonio_pair pair,
                                           int rings, gonio_pair *sample);

/* ---- time ---- */

/* Seconds from one setting to another: the move, the settling and the change of incidence. */
GONIO_API double gonio_instrument_travel(const gonio_instrument *instrument,
                                         const gonio_setting *from, const gonio_setting *to);

/* The setting that a run starts from: every axis at 0, or at the position nearest to it. */
GONIO_API void gonio_instrument_home(const gonio_instrument *instrument, gonio_setting *home);

/* When the exposure of each reading of a run ends, in this order, with travel, settling, changes of
 * incidence and reference readings: one at the start and one whenever it is due. time[count], s;
 * may be NULL. Returns the time of the whole run. */
GONIO_API double gonio_instrument_schedule(const gonio_instrument *instrument,
                                           const gonio_setting *setting, size_t count,
                                           double *time);

/* Orders readings so that a run takes the least time, by a local search that finds the best order
 * of few readings. Reading k can be made at the settings first[k] to first[k + 1] - 1 of setting[];
 * first[count + 1], first[0] may be any place. start: where the axes are before; NULL: home. Fills
 * in order[count], the readings in order, and chosen[count], their settings in this order. The same
 * input gives the same order. Errors: _ARGUMENT (a reading without a setting), _MEMORY,
 * _CANCELLED. */
GONIO_API gonio_status gonio_instrument_order(gonio_context *context,
                                              const gonio_instrument *instrument,
                                              const gonio_setting *setting, const size_t *first,
                                              size_t count, const gonio_setting *start,
                                              size_t *order, gonio_setting *chosen);

#ifdef __cplusplus
}
#endif
#endif
