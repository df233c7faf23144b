/* A Zemax BSDF file as it is: values on a grid of sample rotations, incidences, azimuths and radial
 * angles. Azimuths and radial angles are about the mirror direction. */
#ifndef GONIO_ZEMAX_GRID_H
#define GONIO_ZEMAX_GRID_H

#include "../../core/core.h"

enum {
    GONIO_I_ZEMAX_ROTATION,
    GONIO_I_ZEMAX_INCIDENCE,
    GONIO_I_ZEMAX_AZIMUTH,
    GONIO_I_ZEMAX_RADIAL,
    GONIO_I_ZEMAX_AXES
};

/* The words of the file for them. */
extern const char *const gonio_i_zemax_axis_names[GONIO_I_ZEMAX_AXES];

enum { GONIO_I_ZEMAX_PLANES = 3 };

typedef struct gonio_i_zemax_axis {
    size_t count;
    double *degrees; /* [count] */
} gonio_i_zemax_axis;

typedef struct gonio_i_zemax_grid {
    gonio_i_zemax_axis axis[GONIO_I_ZEMAX_AXES];
    size_t planes;                       /* 1, or X, Y, Z */
    double *value[GONIO_I_ZEMAX_PLANES]; /* [rotation][incidence][azimuth][radial] */
    size_t *line;                        /* the same, of the first plane */
} gonio_i_zemax_grid;

/* Whether the beginning of a text names two of the format's axes. */
bool gonio_i_zemax_recognises(const char *text, size_t size);

/* Reads the grid of a text; words without meaning for the values are skipped. Numbers are read in
 * the thread's locale. Errors: _FORMAT, _DATA (transmitted light), _MEMORY; nothing is to be freed
 * then. */
gonio_status gonio_i_zemax_read(gonio_context *context, const char *path, const char *text,
                                size_t size, gonio_i_zemax_grid *grid);
void gonio_i_zemax_free(gonio_i_zemax_grid *grid);

/* The number of values in a plane. */
size_t gonio_i_zemax_total(const gonio_i_zemax_grid *grid);

#endif
