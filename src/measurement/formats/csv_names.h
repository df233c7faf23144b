/* What the name of a column says, told by its words: "theta_i_deg", "Incident angle (rad)",
 * "450 nm_per_sr", "u(R)". Letter case, signs between words and their order do not matter; a word
 * that is not known makes it the name of something else. */
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
    GONIO_I_VALUE,
    GONIO_I_DEVIATION
} gonio_i_column_kind;

/* What channels are told apart by. */
typedef enum gonio_i_family { GONIO_I_COLOUR, GONIO_I_WAVELENGTH, GONIO_I_UNNAMED } gonio_i_family;

/* How surely a name is that of values. */
typedef enum gonio_i_strength {
    GONIO_I_BARE = 1, /* "R", "550", "rho": could be anything */
    GONIO_I_LIKELY,   /* "550nm", "brdf" */
    GONIO_I_CERTAIN   /* with _per_sr */
} gonio_i_strength;

/* Index of phi_o - phi_i, behind theta_i, phi_i, theta_o, phi_o. */
enum { GONIO_I_AZIMUTH_DIFFERENCE = 4, GONIO_I_ANGLE_COLUMNS };

typedef struct gonio_i_column_name {
    gonio_i_column_kind kind;
    bool own;     /* as gonio writes it */
    size_t index; /* of an angle; of a colour; the number of an unnamed channel, 0: none */
    gonio_i_family family;
    gonio_i_strength strength;
    double wavelength;   /* as it is written */
    int wavelength_unit; /* gonio_wavelength_unit; 0: not said */
    int quantity;        /* the same for the same word; 0: none */
    int unit;            /* gonio_angle_unit or gonio_value_kind; 0: not said */
    bool relative;       /* a deviation over its value */
} gonio_i_column_name;

/* Fills in what the words of a name say of an angle (csv_angle_names.c), of values or deviations
 * (csv_value_names.c). False, with an undefined name, if they say it of something else. */
bool gonio_i_take_angle_name(const gonio_i_words *words, gonio_i_column_name *name);
bool gonio_i_take_value_name(const char *text, gonio_i_words *words, gonio_i_column_name *name);

/* Numbers in names have decimal points. */
gonio_i_column_name gonio_i_column_name_of(const char *name);

/* gonio_angle_unit and gonio_value_kind that a text speaks of, whatever else it says; 0: none. */
int gonio_i_angle_unit_in(const char *text);
int gonio_i_value_kind_in(const char *text);

#endif
