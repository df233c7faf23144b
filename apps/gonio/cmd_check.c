/* gonio check: an instrument in words, a plan as it makes it, and pictures of both. */
#include "command_line.h"
#include "inputs.h"
#include "instrument_words.h"
#include "json_output.h"
#include "plan_tour.h"
#include "reach_figure.h"

#include <stdio.h>

typedef struct options {
    const char *output;
} options;

/* What is checked. */
typedef struct checked {
    gonio_instrument *instrument;
    gonio_reach reach;
    const char *path;     /* of the plan; NULL: none */
    gonio_readings *plan; /* or NULL */
    plan_tour tour;
} checked;

static int report(tool *t, const checked *c)
{
    const gonio_instrument_view *view = gonio_instrument_describe(c->instrument);
    if (tool_json) {
        json_t *json = instrument_json(view, &c->reach);
        if (c->plan != NULL) {
            json_object_set_new(json, "run", plan_tour_json(c->path, &c->tour));
        }
        return tool_print_json(t, json);
    }
    instrument_print(tool_results(), view, &c->reach);
    if (c->plan != NULL) {
        plan_tour_print(t, tool_results(), c->path, &c->tour);
    }
    return 0;
}

static gonio_status read_plan(tool *t, checked *c)
{
    const gonio_readings_options any = {.size = sizeof any,
                                        .average_repeats = true,
                                        .negative_to_zero = true,
                                        .instrument = c->instrument};
    gonio_status status = tool_read_readings(t, c->path, &any, &c->plan);
    if (status == GONIO_OK) {
        status = plan_tour_make(t, c->instrument, c->plan, c->path, &c->tour);
    }
    return status;
}

static gonio_status draw(const tool *t, const checked *c, const char *folder)
{
    gonio_status status = reach_figure(t->context, c->instrument, c->plan, folder);
    if (status == GONIO_OK && c->plan != NULL) {
        status = plan_tour_draw(t->context, c->instrument, &c->tour, folder);
    }
    return status;
}

static gonio_status check(tool *t, const options *o, const char *path, checked *c)
{
    const gonio_freedom freedom = GONIO_ALL_FREEDOM;
    gonio_status status = gonio_instrument_read(t->context, path, &c->instrument);
    if (status == GONIO_OK) {
        status = gonio_instrument_survey(t->context, c->instrument, freedom, &c->reach);
    }
    if (status == GONIO_OK && c->path != NULL) {
        status = read_plan(t, c);
    }
    if (status == GONIO_OK && o->output != NULL) {
        status = draw(t, c, o->output);
    }
    return status;
}

static int run(tool *t, void *given)
{
    const options *o = given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (count != 1 && count != 2) {
        tool_refuse(t, "INSTRUMENT is needed: a file or one of the words below; PLAN may follow");
        return EXIT_USAGE;
    }
    checked c = {.path = count > 1 ? arguments[1] : NULL};
    const gonio_status status = check(t, o, arguments[0], &c);
    const int code = status == GONIO_OK ? report(t, &c) : tool_exit_code(status);
    plan_tour_free(&c.tour);
    gonio_readings_free(&c.plan);
    gonio_instrument_free(&c.instrument);
    return code;
}

int cmd_check(int argc, const char **argv)
{
    options o = {0};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0,
         "Draw in this folder: reach.svg, .pdf and .png, what the instrument reaches; with PLAN "
         "tour.svg, .pdf and .png, its axes over time",
         "DIR"},
        TOOL_OPTIONS};
    char words[512];
    size_t used = (size_t)snprintf(words, sizeof words, "Instruments that come with gonio:\n");
    for (int k = 0; gonio_instrument_word(k) != NULL && used < sizeof words; k++) {
        used += (size_t)snprintf(words + used, sizeof words - used, "  %-12s %s\n",
                                 gonio_instrument_word(k), gonio_instrument_summary(k));
    }
    snprintf(words + used, used < sizeof words ? sizeof words - used : 0,
             "Example: gonio check rig.json plan.csv -o picture");
    const tool_command_line line = {.table = table,
                                    .usage = "[OPTION...] INSTRUMENT [PLAN]",
                                    .text = words,
                                    .work = run,
                                    .options = &o};
    return tool_run(argc, argv, &line);
}
