/* Tables whose rows and columns both say where or at which wavelength a value was read: theta_o
 * against phi_o, geometries or angles against wavelengths. What their lines say. */
#ifndef GONIO_CROSSED_H
#define GONIO_CROSSED_H

#include "csv_cells.h"
#include "csv_names.h"
#include "format.h"

enum { GONIO_I_SETTINGS = GONIO_I_ASPECULAR + 1 };

/* Numbers above columns that are less are no wavelengths of light, of which CSV makes columns. */
enum { GONIO_I_LEAST_LIGHT = 100 };

/* What is known of a value: angles by their index in csv_names.h, and its wavelength. */
typedef struct gonio_i_settings {
    unsigned bits; /* which angles, 1 << index */
    double angle[GONIO_I_SETTINGS];
    double wavelength; /* 0: none */
} gonio_i_settings;

/* What the numbers along a side are. */
enum { GONIO_I_NO_AXIS = -1, GONIO_I_WAVELENGTH_AXIS = -2, GONIO_I_GEOMETRY_AXIS = -3 };

typedef struct gonio_i_axis {
    int index; /* of an angle, or one of the above */
    int unit;  /* gonio_angle_unit or gonio_wavelength_unit; 0: not stated */
} gonio_i_axis;

/* The axis that a text names: "theta_o (deg)", "phi", "wavelength_nm". theta and phi alone are
 * those of the detector. */
gonio_i_axis gonio_i_axis_of(gonio_i_line text);

/* The axes that the corner of a table names, "theta\phi": that along rows, the first column, and
 * that along columns. False if it does not name two. */
bool gonio_i_axes_of_corner(gonio_i_line corner, gonio_i_axis *down, gonio_i_axis *across);

/* A line of one angle or wavelength and its number: "theta_i = 30", "AOI;30 deg;;". */
bool gonio_i_setting_of(gonio_i_line line, gonio_i_axis *axis, double *number);

/* A geometry by its usual name, the light before the detector, in the plane of incidence: "45/0",
 * "45:-15" (the mirror's side has equal signs), and by the angle from the mirror direction towards
 * the light, "45as15", "r45as15". False for anything else. */
bool gonio_i_geometry_of(gonio_i_line text, gonio_i_settings *settings);

/* Refuses aspecular geometries of values without a unit: spectrophotometers with several angles
 * give reflectance factors, as such or in per cent, and a factor of 100 is not to be guessed.
 * Errors: _FORMAT, always. */
gonio_status gonio_i_refuse_aspecular(gonio_context *context, const char *path);

/* A cell as a number or an angle with its sign. */
bool gonio_i_cell_number(gonio_i_line cell, char separator, double *number);

/* A cell without quotes around it. */
gonio_i_line gonio_i_unquoted(gonio_i_line cell);

/* What a line is. */
typedef enum gonio_i_crossed_kind {
    GONIO_I_OTHER_LINE,
    GONIO_I_SETTING_LINE, /* one angle or wavelength */
    GONIO_I_CORNER_LINE,  /* two axes in the first cell, then numbers */
    GONIO_I_STACKED_LINE, /* an angle's name, then its number for each column */
    GONIO_I_BARE_LINE,    /* nothing, then numbers */
    GONIO_I_NAMED_LINE,   /* the name of wavelengths, then geometries */
    GONIO_I_BEGIN_LINE,   /* the name of wavelengths, then anything else */
    GONIO_I_ROW_LINE      /* numbers */
} gonio_i_crossed_kind;

typedef struct gonio_i_crossed_line {
    gonio_i_crossed_kind kind;
    gonio_i_line text; /* without comment marks */
    char separator;
    size_t cells;
    gonio_i_axis down, across; /* of GONIO_I_SETTING_LINE and GONIO_I_STACKED_LINE: down */
    double number;             /* of GONIO_I_SETTING_LINE; the least of the columns' */
} gonio_i_crossed_line;

/* A comment may hold a setting, or names. */
gonio_i_crossed_line gonio_i_crossed_take(gonio_i_line line);

/* The text behind a key, "rows: theta_o"; NULL for another line. */
const char *gonio_i_crossed_key(const char *text, const char *key);

/* What the lines of a file state of the units of angles, wavelengths and values. Errors: _FORMAT
 * where they differ. */
gonio_status gonio_i_crossed_units(const gonio_i_readings_file *file, gonio_convention *stated);

/* Copies a text; false if it does not fit. */
bool gonio_i_line_text(gonio_i_line line, size_t room, char *text);

#endif
