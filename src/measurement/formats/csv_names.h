/* The meaning of a column's name, from its words: "theta_i_deg", "Incident angle (rad)", "450
 * nm_per_sr", "u(R)". Letter case, signs between words and their order do not matter. A name with
 * an unknown word means something else. */
#ifndef GONIO_CSV_NAMES_H
#define GONIO_CSV_NAMES_H

#include <stdbool.h>
#include <stddef.h>

#include "csv_words.h"

typedef enum gonio_i_column_kind {
    GONIO_I_OTHER = 0,
    GONIO_I_ANGLE,
    GONIO_I_PLANNED,
    GONIO_I_ROW_WAVELENGTH, /* of the row's value, where a row has one */
    GONIO_I_ROW_COLOUR,     /* of the row's value */
    GONIO_I_POLARISATION,   /* of the light of the row */
    GONIO_I_TIME,           /* of the row */
    GONIO_I_MARK,           /* what the row is a reading of: sample, reference, dark */
    GONIO_I_VALUE,
    GONIO_I_DEVIATION
} gonio_i_column_kind;

/* How channels are identified. */
typedef enum gonio_i_family { GONIO_I_COLOUR, GONIO_I_WAVELENGTH, GONIO_I_UNNAMED } gonio_i_family;

/* How certain it is that a name is that of values. */
typedef enum gonio_i_strength {
    GONIO_I_BARE = 1, /* "R", "550", "rho": could be anything */
    GONIO_I_LIKELY,   /* "550nm", "brdf" */
    GONIO_I_CERTAIN   /* with _per_sr */
} gonio_i_strength;

/* Indices behind theta_i, phi_i, theta_o, phi_o: of phi_o - phi_i, of the rotation of the sample,
 * which is added to both azimuths, and of the angle between the detector and the mirror direction,
 * in the plane of incidence: above zero farther from the normal, or nearer to it. Then the angle
 * between light and detector, the half/difference angles (direction.h), x, y, z of the directions
 * towards light and detector, and sin theta_o - sin theta_i in the plane of incidence, with its
 * sign (above zero farther from the normal than the mirror direction) or without it; and both
 * directions by the name of a geometry, "45as15" (crossed.h). */
enum {
    GONIO_I_AZIMUTH_DIFFERENCE = 4,
    GONIO_I_SAMPLE_ROTATION,
    GONIO_I_FROM_SPECULAR,
    GONIO_I_ASPECULAR,
    GONIO_I_PHASE,
    GONIO_I_THETA_H,
    GONIO_I_PHI_H,
    GONIO_I_THETA_D,
    GONIO_I_PHI_D,
    GONIO_I_VECTORS,
    GONIO_I_BETA = GONIO_I_VECTORS + 6,
    GONIO_I_BETA_SIZE,
    GONIO_I_NAMED_GEOMETRY,
    GONIO_I_ANGLE_COLUMNS
};

/* The unit of "grad", which is German for degrees, and gradians elsewhere. */
enum { GONIO_I_DEGREES_OR_GRADIANS = 100 };

typedef struct gonio_i_column_name {
    gonio_i_column_kind kind;
    bool own;     /* as gonio writes it */
    size_t index; /* of an angle; of a colour; the number of an unnamed channel, 0: none */
    gonio_i_family family;
    gonio_i_strength strength;
    bool complement;     /* an angle from the surface: an elevation */
    double factor;       /* of the unit of a value or deviation; 0: none */
    double wavelength;   /* as written in the name */
    int wavelength_unit; /* gonio_wavelength_unit; 0: not stated */
    int quantity;        /* a number for each quantity; 0: none */
    int unit;            /* gonio_angle_unit (or both, above) or gonio_value_kind; 0: not stated */
    int scale;           /* gonio_value_scale of a logarithm; 0: linear */
    int polarisation;    /* of the light: 1 s, 2 p; 0: not stated */
    bool relative;       /* a deviation divided by its value */
    double seconds;      /* of a unit of time */
} gonio_i_column_name;

/* Fills in the meaning of a name as an angle (csv_angle_names.c), and as values or deviations
 * (csv_value_names.c). False, with *name undefined, if it means something else. */
bool gonio_i_take_angle_name(const gonio_i_words *words, gonio_i_column_name *name);
bool gonio_i_take_value_name(const char *text, const gonio_i_words *words,
                             gonio_i_column_name *name);

/* Fills in the meaning of a name as beta - beta0, |beta - beta0| (csv_beta_names.c). */
bool gonio_i_take_beta_name(const char *text, const gonio_i_words *words,
                            gonio_i_column_name *name);

/* The meaning of a column's name. Numbers in names have decimal points. */
gonio_i_column_name gonio_i_column_name_of(const char *name);

/* Whether a cell is a polarisation of the light. *state: 1 s, -1 p, 0 unpolarised. */
bool gonio_i_polarisation_of(const char *cell, int *state);

/* The colour that a cell names: 0 R, 1 G, 2 B; -1 if none (csv_row_colours.c). */
int gonio_i_colour_of(const char *cell);

/* Whether one of a text's words is of an azimuth. */
bool gonio_i_names_azimuth(const char *text);

/* The gonio_angle_unit and the gonio_value_kind that a text names, with any other words; 0: none.
 */
int gonio_i_angle_unit_in(const char *text);
int gonio_i_value_kind_in(const char *text);

/* The gonio_value_scale of logarithms that a text of nothing but values names; 0: none. */
int gonio_i_value_scale_in(const char *text);

#endif
