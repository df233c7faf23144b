/* The trial of a transform of readings: how well the prior explains the readings if their values or
 * directions were other ones.
 *
 * Each reading is predicted from the others, under a few models of usual and of unusual materials.
 * The score of a reading is ln of Student's density of its value, as it was read, in that
 * prediction: a mean over at most 3 columns, because the errors of channels are common to them. At
 * most 64 readings are tried. Transforms are compared reading by reading. So no reading can decide
 * alone, as one at a narrow peak would. */
#ifndef GONIO_TRANSFORM_TRIAL_H
#define GONIO_TRANSFORM_TRIAL_H

#include "observations.h"
#include "sites.h"

enum { GONIO_I_TRIAL_COLUMNS = 3 };

typedef struct gonio_i_transform_trial {
    gonio_context *context;
    const gonio_i_prior *prior;
    const gonio_readings *readings;
    const gonio_i_noise *noise;
    size_t count;                          /* of columns that are tried */
    size_t channel[GONIO_I_TRIAL_COLUMNS]; /* of the readings */
    gonio_i_column column[GONIO_I_TRIAL_COLUMNS];
    gonio_i_sites *sites[GONIO_I_TRIAL_COLUMNS]; /* of the directions as they were read */
} gonio_i_transform_trial;

/* What a trial of a transform finds. */
typedef struct gonio_i_verdict {
    double *score; /* [readings], 0 for those that were not tried */
    double sum;    /* of the scores */
    int model;     /* the likeliest */
} gonio_i_verdict;

/* The columns are of the readings as given, of separate channels. The prior, the readings and the
 * noise must outlive the trial, which is to be ended in any case. Errors: _MEMORY. */
gonio_status gonio_i_transform_trial_begin(gonio_context *context, const gonio_i_prior *prior,
                                           const gonio_readings *readings,
                                           const gonio_i_noise *noise,
                                           const gonio_i_columns *columns,
                                           gonio_i_transform_trial *trial);
void gonio_i_transform_trial_end(gonio_i_transform_trial *trial);

/* Whether the directions of the readings exist under a transform. */
bool gonio_i_transform_trial_is_possible(const gonio_i_transform_trial *trial,
                                         const gonio_i_transform *transform);

/* verdict->score is to be freed in any case. Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_transform_trial_judge(gonio_i_transform_trial *trial,
                                           const gonio_i_transform *transform,
                                           gonio_i_verdict *verdict);

/* The albedo of the readings under a transform, by the model of its verdict, a mean over three
 * incidences: largest, of the columns, and the mean of them. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_transform_trial_albedo(gonio_i_transform_trial *trial,
                                            const gonio_i_transform *transform,
                                            const gonio_i_verdict *verdict, double *largest,
                                            double *mean);

/* By how much the scores of a verdict exceed those of another one, where each reading counts at
 * most a few units. */
double gonio_i_transform_trial_margin(const gonio_i_transform_trial *trial,
                                      const gonio_i_verdict *verdict, const gonio_i_verdict *other);

#endif
