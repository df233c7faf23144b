/* The inside of an instrument, and the interface of its kinematics. To add kinematics, write a file
 * like direct.c, declare its gonio_i_kinematics below and add a line to the list. */
#ifndef GONIO_INSTRUMENT_INTERNAL_H
#define GONIO_INSTRUMENT_INTERNAL_H

#include <jansson.h>

#include <gonio/instrument.h>

#include "../core/core.h"

enum { GONIO_I_MOST_SOLUTIONS = 8 };

/* An axis that kinematics know. */
typedef struct gonio_i_known_axis {
    const char *name; /* NULL past the last */
    bool needed;
} gonio_i_known_axis;

typedef struct gonio_i_kinematics {
    const char *name;
    const char *summary;
    gonio_i_known_axis axis[GONIO_MOST_AXES + 1]; /* empty: the file names its axes */
    int incidence; /* the axis that alone sets theta_i; -1: there is none */

    /* The directions of a setting. */
    gonio_pair (*pair)(const gonio_instrument *instrument, const double *axis);

    /* The settings of a pair, or of one that is turned about the normal, before steps and limits
     * are looked at: into axis[GONIO_I_MOST_SOLUTIONS]. Returns how many. */
    size_t (*settings)(const gonio_instrument *instrument, gonio_pair pair, bool isotropic,
                       double axis[][GONIO_MOST_AXES]);
} gonio_i_kinematics;

#define GONIO_I_KINEMATICS(KINEMATICS)                                                             \
    KINEMATICS(direct) KINEMATICS(in_plane) KINEMATICS(arms) KINEMATICS(four_axis) KINEMATICS(table)

#define GONIO_I_DECLARE_KINEMATICS(name)                                                           \
    extern const gonio_i_kinematics gonio_i_##name##_kinematics;
GONIO_I_KINEMATICS(GONIO_I_DECLARE_KINEMATICS)

/* By its name or its place in the list; NULL if there is none. */
const gonio_i_kinematics *gonio_i_kinematics_named(const char *name);
const gonio_i_kinematics *gonio_i_kinematics_at(int index);

/* An aperture, and how finely it is covered: as gonio_instrument_aperture. */
typedef struct gonio_i_aperture {
    double half_angle; /* rad; 0: a point */
    int rings;
} gonio_i_aperture;

enum {
    GONIO_I_MOST_APERTURE_DIRECTIONS =
        1 + 3 * GONIO_MOST_APERTURE_RINGS * (GONIO_MOST_APERTURE_RINGS + 1)
};

/* Directions that cover an aperture: 1 of a point. */
size_t gonio_i_aperture_directions(gonio_i_aperture aperture);

/* Pairs of equal weight over both apertures, at most the product of their directions. Returns how
 * many are above the horizon; the pair itself if none is. */
size_t gonio_i_through_apertures(gonio_i_aperture source, gonio_i_aperture detector,
                                 gonio_pair pair, gonio_pair *sample);

/* A row of a table by a key, ascending. */
typedef struct gonio_i_row_key {
    double key;
    size_t row;
} gonio_i_row_key;

struct gonio_instrument {
    gonio_instrument_view view; /* its names belong to `source` */
    const gonio_i_kinematics *kinematics;
    json_t *source; /* the file */
    char *path;
    gonio_axis axis[GONIO_MOST_AXES];
    double *position;   /* of all axes */
    gonio_range *range; /* of all zones and limits */
    gonio_zone *zone;
    const char **channel;
    double *wavelength;
    gonio_reference_row *reference;
    gonio_setting *row;         /* [view.directions]: a table of reachable directions */
    gonio_i_row_key *by_angles; /* [view.directions], of theta_i + theta_o */
    gonio_i_row_key *by_axes;   /* [view.directions], of the sum of the axes */
    double same_row;            /* pairs this near are a row of the table, rad */
};

/* Directions this near are a row of a table, rad. */
#define GONIO_I_SAME_ROW 1e-3

/* Makes the indices of a table, once its rows are there. Errors: _MEMORY. */
gonio_status gonio_i_table_index(gonio_context *context, gonio_instrument *instrument);

/* Ranges include their ends to within this, rad. */
#define GONIO_I_EDGE 1e-6

/* ---- angles ---- */

/* A direction at a polar angle of either sign. */
gonio_angles gonio_i_signed_direction(double theta, double phi);

/* The azimuth in [0, 2 pi). */
double gonio_i_azimuth(double phi);

/* The angle that differs from `angle` by whole turns and is the lowest above low - GONIO_I_EDGE. */
double gonio_i_turn_into(double angle, double low);

/* phi_o - phi_i in [0, 2 pi); 0 where one of the directions is the normal. */
double gonio_i_azimuth_difference(const gonio_pair *pair);

/* ---- limits ---- */

/* The quantity of a range by its name, which then lasts for ever; NULL if there is none. */
const char *gonio_i_quantity_named(const char *name);
/* The names of all quantities, by their places; NULL past the last. */
const char *gonio_i_quantity_at(int index);

/* Whether an axis of this name is meant in place of the quantity. */
bool gonio_i_quantity_gives_way(const char *name);

/* Moves the axes of a setting to the nearest positions that they can take, and finds its pair.
 * Returns what keeps it from being used, as gonio_instrument_obstacle does, or NULL. */
const char *gonio_i_take_position(const gonio_instrument *instrument, gonio_setting *setting);

/* ---- from candidates.c ---- */

/* Errors: _DATA if nothing can be reached. */
gonio_status gonio_i_check_reach(gonio_context *context, const gonio_instrument *instrument);

#endif
