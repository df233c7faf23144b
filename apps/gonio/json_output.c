/* Results as JSON: see json_output.h. */
#include "json_output.h"

#include <math.h>
#include <stdio.h>

static json_t **kept_json = NULL;

void tool_keep_json(json_t **kept)
{
    kept_json = kept;
}

json_t *tool_json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *tool_error_json(const gonio_error *error)
{
    json_t *json = json_object();
    const gonio_metric_view *metric = NULL;
    for (int m = 0; (metric = gonio_metric_describe(m)) != NULL; m++) {
        json_object_set_new(json, metric->key, tool_json_number(error->value[m]));
    }
    return json;
}

int tool_print_json(const tool *t, json_t *json)
{
    if (json == NULL) {
        fprintf(stderr, "gonio %s: no JSON: a name is not UTF-8, or out of memory\n", t->name);
        return EXIT_DATA;
    }
    if (kept_json != NULL) {
        *kept_json = json;
        return 0;
    }
    json_dumpf(json, tool_results(), JSON_INDENT(2) | JSON_REAL_PRECISION(10));
    fputc('\n', tool_results());
    json_decref(json);
    return 0;
}
