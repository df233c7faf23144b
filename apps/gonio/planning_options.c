/* The options of planning that several commands share: see planning_options.h. */
#include "planning_options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "duration.h"
#include "inputs.h"

/* Checks that plans can be made for a metric. */
static bool check_metric(const tool *t, const char *name)
{
    const char *names[GONIO_MOST_METRICS + 1] = {NULL};
    size_t count = 0;
    int choice = 0;
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        if (gonio_metric_describe(m)->plannable) {
            names[count++] = gonio_metric_describe(m)->name;
        }
    }
    return tool_check_word(t, "--metric", name, names, &choice);
}

double planning_percent(const char *text)
{
    char *end = NULL;
    const double value = strtod(text, &end);
    end += *end == '%';
    return *end == '\0' && value > 0.0 && isfinite(value) ? value : -1.0;
}

/* BRDF JSON holds readings; it has no place for what else a plan says. */
static bool check_format(const tool *t, const char *output)
{
    const char *dot = output != NULL ? strrchr(output, '.') : NULL;
    if (dot != NULL && (strcasecmp(dot, ".json") == 0 || strcasecmp(dot, ".brdf") == 0)) {
        return tool_refuse(t, "-o %s: a plan is CSV; name it %.*s.csv", output, (int)(dot - output),
                           output);
    }
    return true;
}

static bool check_instrument(const tool *t, const planning_options *o)
{
    double seconds = 0.0;
    if (o->instrument == NULL && (o->budget != NULL || o->nested)) {
        return tool_refuse(t, "%s needs --instrument", o->budget != NULL ? "--budget" : "--nested");
    }
    if (o->budget != NULL && !tool_duration(o->budget, &seconds)) {
        return tool_refuse(t, "--budget: '%s' is not a time like 45min, 2h or 900s", o->budget);
    }
    if (o->budget != NULL && o->target != NULL) {
        return tool_refuse(t, "give --budget or --target-error, not both");
    }
    return o->instrument == NULL || o->candidates == NULL ||
           tool_refuse(t, "give --instrument or --candidates, not both");
}

bool planning_options_check(const tool *t, const planning_options *o, const char *output)
{
    return (o->count == PLANNING_USUAL_COUNT || tool_check_count(t, "-n", o->count, 1)) &&
           (o->metric == NULL || check_metric(t, o->metric)) &&
           (o->target == NULL || planning_percent(o->target) > 0.0 ||
            tool_refuse(t, "--target-error: '%s' is not an error in per cent above 0",
                        o->target)) &&
           check_format(t, output) && check_instrument(t, o) &&
           (o->candidates == NULL || tool_check_output(t, output, &o->candidates, 1)) &&
           (o->instrument == NULL || tool_check_output(t, output, &o->instrument, 1));
}

/* Reads the directions of a readings file, with or without values. */
static gonio_status read_directions(const tool *t, const char *path, gonio_pair **pairs,
                                    size_t *count)
{
    const gonio_readings_options how = {.size = sizeof how,
                                        .average_repeats = true,
                                        .negative_to_zero = true,
                                        .directions_only = true};
    gonio_readings *readings = NULL;
    gonio_status status = tool_read_readings(t, path, &how, &readings);
    if (status != GONIO_OK) {
        return status;
    }
    const gonio_readings_view *view = gonio_readings_describe(readings);
    *pairs = calloc(view->count, sizeof **pairs);
    *count = view->count;
    for (size_t k = 0; *pairs != NULL && k < view->count; k++) {
        (*pairs)[k] = view->pair[k];
    }
    gonio_readings_free(&readings);
    return *pairs != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

gonio_status planning_options_apply(const tool *t, const planning_options *o,
                                    gonio_plan_options *how, planning_inputs *inputs)
{
    gonio_status status = GONIO_OK;
    *inputs = (planning_inputs){NULL, NULL};
    how->count = o->count != PLANNING_USUAL_COUNT ? (size_t)o->count : how->count;
    how->metric = o->metric != NULL ? (gonio_metric)gonio_metric_find(o->metric) : how->metric;
    how->anisotropic = o->anisotropic != 0;
    how->target = o->target != NULL ? planning_percent(o->target) : 0.0;
    if (o->budget != NULL) {
        tool_duration(o->budget, &how->budget);
    }
    how->nested = o->nested != 0;
    if (o->candidates != NULL) {
        status = read_directions(t, o->candidates, &inputs->candidates, &how->candidate_count);
        how->candidates = inputs->candidates;
    }
    if (status == GONIO_OK && o->instrument != NULL) {
        status = gonio_instrument_read(t->context, o->instrument, &inputs->instrument);
        how->instrument = inputs->instrument;
    }
    return status;
}

void planning_inputs_free(planning_inputs *inputs)
{
    free(inputs->candidates);
    gonio_instrument_free(&inputs->instrument);
}
