/* The errors that the experiments report: see reported_errors.h. */
#include "reported_errors.h"

#include <math.h>

#include "../figures/figure_writer.h"

const gonio_metric gonio_i_reported[GONIO_I_REPORTED] = {GONIO_E6, GONIO_CUBE_ROOT,
                                                         GONIO_LOG_RELATIVE_ERROR};

static const char *key(int k)
{
    return gonio_metric_describe((int)gonio_i_reported[k])->key;
}

void gonio_i_put_error_columns(FILE *f)
{
    for (int k = 0; k < GONIO_I_REPORTED; k++) {
        fprintf(f, "%s%c", key(k), k + 1 < GONIO_I_REPORTED ? ',' : '\n');
    }
}

void gonio_i_put_error(FILE *f, gonio_error error)
{
    for (int k = 0; k < GONIO_I_REPORTED; k++) {
        gonio_i_put_number(f, error.value[gonio_i_reported[k]]);
        fputc(k + 1 < GONIO_I_REPORTED ? ',' : '\n', f);
    }
}

json_t *gonio_i_reported_json(gonio_error error)
{
    json_t *json = json_object();
    for (int k = 0; k < GONIO_I_REPORTED; k++) {
        const double value = error.value[gonio_i_reported[k]];
        json_object_set_new(json, key(k), isfinite(value) ? json_real(value) : json_null());
    }
    return json;
}
