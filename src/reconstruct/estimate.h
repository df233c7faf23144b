/* Reconstruction by posterior: from readings to its columns, and from its field to a material. */
#ifndef GONIO_ESTIMATE_H
#define GONIO_ESTIMATE_H

#include <gonio/reconstruct.h>

#include "posterior.h"

/* Both fill in a new reconstruction. Errors: those of gonio_reconstruct; _ARGUMENT for a basis of
 * another mapping than log; _MISMATCH for spectra and a joint basis. */
gonio_status gonio_i_estimate_readings(gonio_context *context, const gonio_basis *basis,
                                       const gonio_readings *readings,
                                       const gonio_reconstruct_options *options,
                                       gonio_reconstruction **reconstruction);
gonio_status gonio_i_estimate_rows(gonio_context *context, const gonio_basis *basis,
                                   const gonio_reconstruct_options *options, const size_t *rows,
                                   size_t count, const double *b,
                                   gonio_reconstruction **reconstruction);

/* Readings as columns of observations, those of the channels that were read. `transform`: what
 * they are taken to mean; NULL for what they say. */
typedef struct gonio_i_columns {
    size_t count;
    gonio_i_column *column;
} gonio_i_columns;

typedef struct gonio_i_transform {
    double factor;                       /* of the values; */
    bool by_cosine;                      /* which are divided by cos theta_o too */
    bool merl;                           /* and multiplied by s */
    const double *dark;                  /* [channels]: added to them (dark.h), or NULL */
    gonio_pair (*turn)(gonio_pair pair); /* NULL: as they are */
} gonio_i_transform;

gonio_status gonio_i_columns_create(gonio_context *context, const gonio_basis_view *view,
                                    const gonio_readings *readings,
                                    const gonio_reconstruct_options *options,
                                    const gonio_i_transform *transform, gonio_i_columns *columns);
void gonio_i_columns_free(gonio_i_columns *columns);

/* What both need: a basis and options of the right kind; something in every column. `path`: of the
 * readings, for messages, or NULL. */
gonio_status gonio_i_estimate_check(gonio_context *context, const gonio_basis *basis,
                                    const gonio_readings *readings,
                                    const gonio_reconstruct_options *options);
gonio_status gonio_i_columns_check(gonio_context *context, const gonio_i_columns *columns,
                                   const char *path);

/* What the readings are taken to mean, unless options->believe: looks for a dark level (*dark,
 * which the caller frees, or NULL) and a usual mistake (*suspicion, static, or NULL), and makes the
 * columns again if there is a level. Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_columns_interpret(gonio_context *context, const gonio_i_prior *prior,
                                       const gonio_readings *readings,
                                       const gonio_reconstruct_options *options,
                                       gonio_i_columns *columns, double **dark,
                                       const char **suspicion);

/* Sets gonio_reconstruction.suspicion. dark: of the readings as they are (dark.h), or NULL. */
gonio_status gonio_i_suspect(gonio_context *context, const gonio_i_prior *prior,
                             const gonio_readings *readings,
                             const gonio_reconstruct_options *options, const double *dark,
                             const char **suspicion);

/* ln of how much a transform stretches the values of a column around them: sum ln(dg'/dv), without
 * bounds, which have a probability and no density. */
double gonio_i_transform_logarithm(const gonio_readings *readings, size_t channel,
                                   const gonio_reconstruct_options *options,
                                   const gonio_i_transform *transform);

/* Value of a field (or of a deviation) in a column at any directions. */
double gonio_i_field_at(const gonio_basis *basis, const double *field, int channel,
                        gonio_half_difference at);

/* A spectrum as linear R, G, B of the sRGB primaries, in which a flat spectrum is white. */
void gonio_i_spectrum_to_rgb(const double *wavelength, const double *value, size_t count,
                             double rgb[GONIO_CHANNELS]);

#endif
