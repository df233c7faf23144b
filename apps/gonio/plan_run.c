/* What a plan for an instrument costs: see plan_run.h. */
#include "plan_run.h"

#include <math.h>
#include <stdio.h>

#include "duration.h"
#include "json_output.h"

/* A share of the pairs that is worth a word. */
static const double WORTH_SAYING = 0.0005;

static void print_parts(FILE *stream, const gonio_plan_run *run)
{
    const gonio_plan_part *reached = &run->part[0];
    if (reached->share > WORTH_SAYING) {
        fprintf(stream, "reached: %.1f %% of all pairs, standard deviation there %.1f %%\n",
                100.0 * reached->share, 100.0 * reached->deviation);
    }
    const char *begin = "blind: ";
    for (size_t k = 1; k < run->parts; k++) {
        const gonio_plan_part *part = &run->part[k];
        if (part->share > WORTH_SAYING) {
            fprintf(stream, "%s%.1f %% by %s (%.1f %%)", begin, 100.0 * part->share, part->obstacle,
                    100.0 * part->deviation);
            begin = ", ";
        }
    }
    fputs(begin[0] == ',' ? "\n" : "", stream);
}

void plan_run_print(const gonio_plan *plan, const char *output)
{
    const gonio_plan_run *run = plan->run;
    FILE *stream = tool_results();
    fprintf(stream, "%s: %zu reading%s of the %s in ", output, plan->count,
            tool_plural(plan->count), run->instrument);
    tool_print_duration(stream, run->duration);
    fputs(" (", stream);
    tool_print_duration(stream, run->unordered);
    fprintf(stream, " in the order of choice)\nexpected error (E6) %.2f %%",
            plan->expected[plan->count - 1]);
    if (isfinite(run->free_expected)) {
        fprintf(stream, "; %.2f %% without the limits and the noise of the instrument",
                run->free_expected);
    }
    fputc('\n', stream);
    print_parts(stream, run);
}

void plan_run_add_json(const gonio_plan *plan, json_t *json)
{
    const gonio_plan_run *run = plan->run;
    if (run == NULL) {
        return;
    }
    json_t *blind = json_array();
    for (size_t k = 1; k < run->parts; k++) {
        json_array_append_new(
            blind, json_pack("{s:o, s:f, s:f}", "obstacle", tool_json_text(run->part[k].obstacle),
                             "share", run->part[k].share, "deviation", run->part[k].deviation));
    }
    json_object_set_new(json, "run",
                        json_pack("{s:o, s:f, s:f, s:o, s:f, s:f, s:o}", "instrument",
                                  tool_json_text(run->instrument), "duration_s", run->duration,
                                  "unordered_s", run->unordered, "free_expected_e6_percent",
                                  tool_json_number(run->free_expected), "reached_share",
                                  run->part[0].share, "reached_deviation", run->part[0].deviation,
                                  "blind", blind));
}
