/* Readings as columns of observations: values in the basis's log space with their variances. */
#ifndef GONIO_OBSERVATIONS_H
#define GONIO_OBSERVATIONS_H

#include <gonio/measurement.h>

#include "posterior.h"

/* The noise of an instrument, where the readings state no standard deviation of a value. */
typedef struct gonio_i_noise {
    double relative;   /* standard deviation relative to the value */
    double floor;      /* standard deviation of a reading of zero, 1/sr */
    double saturation; /* readings of this value or more, 1/sr, are lower bounds; 0: none are */
} gonio_i_noise;

/* A transform of readings: how the values and directions of the material follow from those read. */
typedef struct gonio_i_transform {
    double factor;                         /* of the values; */
    bool by_cosine;                        /* which are divided by cos theta_o too */
    bool by_cosine_i;                      /* and by cos theta_i */
    bool merl;                             /* and multiplied by s */
    const double *dark;                    /* [channels]: added to them (dark_level.h), or NULL */
    gonio_pair (*change)(gonio_pair pair); /* of directions; NULL: none */
} gonio_i_transform;

/* The readings of each channel; of all channels together for a joint basis. */
typedef struct gonio_i_columns {
    size_t count;
    gonio_i_column *column;
} gonio_i_columns;

/* Makes columns of what was read, as the readings say; a value of NaN was not read. To be freed in
 * any case. Errors: _MEMORY. */
gonio_status gonio_i_columns_create(gonio_context *context, const gonio_basis_view *view,
                                    const gonio_readings *readings, const gonio_i_noise *noise,
                                    gonio_i_columns *columns);
void gonio_i_columns_free(gonio_i_columns *columns);

/* Sets the observations of a column to the same readings under a transform. */
void gonio_i_column_transform(const gonio_readings *readings, const gonio_i_noise *noise,
                              const gonio_i_transform *transform, gonio_i_column *column);

/* _UNDETERMINED if a column has no reading. readings: whose names the message uses, or NULL. */
gonio_status gonio_i_columns_check(gonio_context *context, const gonio_i_columns *columns,
                                   const gonio_readings *readings);

/* The value that a dark level subtracts from a reading of a channel, 1/sr. dark: of the columns, or
 * NULL for none. */
double gonio_i_dark_level_missing(const double *dark, size_t channel, double theta_i);

/* ln of the Jacobian of a transform at a value: ln(dg'/dv). */
double gonio_i_transform_slope(const gonio_readings *readings, size_t reading, size_t channel,
                               const gonio_i_transform *transform);

#endif
