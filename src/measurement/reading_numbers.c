/* The numbers of a reading, checked: see reading_numbers.h. */
#include "reading_numbers.h"

#include <math.h>

#include "rules.h"

static gonio_status bad_number(gonio_context *context, const gonio_readings *r, size_t line,
                               const char *name, double number, const char *problem,
                               gonio_status status)
{
    return gonio_i_fail(context, status, "%s:%zu: %s '%.9g' %s", r->path, line, name, number,
                        problem);
}

gonio_status gonio_i_check_angles(gonio_context *context, const gonio_readings *r, size_t line,
                                  const double degrees[4])
{
    for (int k = 0; k < 4; k++) {
        gonio_status status = GONIO_OK;
        const char *problem = gonio_i_angle_problem(k, degrees[k], &status);
        if (problem != NULL) {
            return bad_number(context, r, line, gonio_i_angle_names[k], degrees[k], problem,
                              status);
        }
    }
    return GONIO_OK;
}

gonio_status gonio_i_take_value(gonio_context *context, const gonio_readings *r, size_t line,
                                size_t channel, const gonio_readings_options *options, double value,
                                double *to)
{
    gonio_status status = GONIO_OK;
    const char *problem = isnan(value) ? NULL : gonio_i_value_problem(value, options, &status);
    if (problem != NULL) {
        char name[GONIO_I_NAME_ROOM];
        gonio_i_value_name(r, channel, false, name);
        return bad_number(context, r, line, name, value, problem, status);
    }
    *to = isnan(value) ? value : fmax(value, 0.0);
    return GONIO_OK;
}

gonio_status gonio_i_take_deviation(gonio_context *context, const gonio_readings *r, size_t line,
                                    size_t channel, double deviation, double *to)
{
    gonio_status status = GONIO_OK;
    const char *problem = isnan(deviation) ? NULL : gonio_i_deviation_problem(deviation, &status);
    if (problem != NULL) {
        char name[GONIO_I_NAME_ROOM];
        gonio_i_value_name(r, channel, true, name);
        return bad_number(context, r, line, name, deviation, problem, status);
    }
    *to = deviation;
    return GONIO_OK;
}
