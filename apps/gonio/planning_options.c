/* What a plan is to aim at, for the commands that plan: see planning_options.h. */
#include "planning_options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const metrics[] = {"e6", "cube-root", "log-relative"};

int tool_metric(const char *name)
{
    for (int k = 0; k < 3; k++) {
        if (strcmp(name, metrics[k]) == 0) {
            return k;
        }
    }
    return -1;
}

double tool_percent(const char *text)
{
    char *end = NULL;
    const double percent = strtod(text, &end);
    end += *end == '%';
    return *end == '\0' && percent > 0.0 && isfinite(percent) ? percent : -1.0;
}

gonio_status tool_candidates(tool *t, const char *path, gonio_pair **pairs, size_t *count)
{
    const gonio_readings_options how = {.average_repeats = true, .negative_to_zero = true};
    gonio_readings *readings = NULL;
    gonio_status status = gonio_readings_read(t->context, path, &how, &readings);
    if (status != GONIO_OK) {
        return status;
    }
    const gonio_readings_view view = gonio_readings_describe(readings);
    *pairs = calloc(view.count, sizeof **pairs);
    *count = view.count;
    for (size_t k = 0; *pairs != NULL && k < view.count; k++) {
        (*pairs)[k] = view.pair[k];
    }
    gonio_readings_free(&readings);
    return *pairs != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}
