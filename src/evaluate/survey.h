/* The parts of a survey of readings: see evaluate.h. */
#ifndef GONIO_SURVEY_H
#define GONIO_SURVEY_H

#include <gonio/evaluate.h>

/* Fills in what readings of one incidence cover, the largest share of one of them, and the albedo
 * of each channel. member[count]: their indices. albedo[channels]. Errors: _MEMORY. */
gonio_status gonio_i_survey_albedo(gonio_context *context, const gonio_readings *readings,
                                   const size_t *member, gonio_incidence *incidence,
                                   double *albedo);

/* What repeats, turned readings, reciprocal pairs and neighbours differ by. Errors: _MEMORY. */
void gonio_i_survey_repeats(const gonio_readings *readings, gonio_survey *survey);
gonio_status gonio_i_survey_turned(gonio_context *context, const gonio_readings *readings,
                                   gonio_survey *survey);
gonio_status gonio_i_survey_reciprocity(gonio_context *context, const gonio_readings *readings,
                                        gonio_survey *survey);
gonio_status gonio_i_survey_outliers(gonio_context *context, const gonio_readings *readings,
                                     gonio_survey *survey);

#endif
