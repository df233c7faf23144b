/* The positions of axes that a plan has in its columns. */
#ifndef GONIO_PLAN_AXES_H
#define GONIO_PLAN_AXES_H

#include <gonio/instrument.h>
#include <gonio/measurement.h>

/* Reads the columns axis_NAME_deg of a plan: setting[count], in the order of its readings, *found
 * if there is such a column for every axis of the instrument and a number in each line. Errors:
 * those of reading the file. */
gonio_status plan_axes_read(gonio_context *context, const gonio_instrument *instrument,
                            const gonio_readings *plan, const char *path, gonio_setting *setting,
                            bool *found);

/* Whether a setting reads a pair, to within a tenth of a degree; both may be turned about the
 * normal, and mirrored. */
bool plan_axes_agree(const gonio_setting *setting, gonio_pair pair);

#endif
