/* Readings in log space: see logs.h. */
#include "logs.h"

#include <math.h>

#include "core/core.h"
#include "measurement/readings.h"

gonio_status benchmark_logs(gonio_context *context, const gonio_readings *readings, double **logs)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    double *g = gonio_i_allocate(context, view->count * view->channels, sizeof *g);
    for (size_t k = 0; g != NULL && k < view->count * view->channels; k++) {
        g[k] = log1p(view->value[k] / gonio_readings_scale(readings, k % view->channels));
    }
    *logs = g;
    return g != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}
