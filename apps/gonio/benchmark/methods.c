/* Methods that complete a BRDF from readings: see methods.h. */
#include "methods.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/core.h"

static const benchmark_method *const list[] = {&benchmark_posterior, &benchmark_interpolation,
                                               &benchmark_lambert_ggx, &benchmark_external};

enum { METHODS = sizeof list / sizeof *list };

const benchmark_method *benchmark_method_at(int index)
{
    return index >= 0 && index < METHODS ? list[index] : NULL;
}

int benchmark_method_find(const char *name)
{
    for (int k = 0; k < METHODS; k++) {
        if (strcmp(list[k]->name, name) == 0) {
            return k;
        }
    }
    return -1;
}

void benchmark_completion_free(benchmark_completion *completion)
{
    if (completion->release != NULL) {
        completion->release(completion->self);
    }
    *completion = (benchmark_completion){0};
}

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
