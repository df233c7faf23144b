/* Plans and their history as CSV (docs/plan-and-readings.md). */
#include "plan_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "../core/core.h"
#include "../core/csv.h"

const char *gonio_i_planned_channel_name(int channel)
{
    static const char *const names[] = {"all", "R", "G", "B"};
    return names[channel - GONIO_ALL_CHANNELS];
}

static bool add_origin(gonio_i_comments *comments, const char *kind, const char *command)
{
    return gonio_i_comments_add(comments, "gonio %s", kind) &&
           gonio_i_comments_add(comments, "program: gonio %s", gonio_version()) &&
           (command == NULL || gonio_i_comments_add(comments, "command: %s", command));
}

static bool add_quality(gonio_i_comments *comments, const gonio_plan *plan)
{
    if (plan->expected != NULL) {
        return gonio_i_comments_add(comments, "expected_e6_percent: %.4g",
                                    plan->expected[plan->count - 1]);
    }
    return plan->condition_number == 0.0 ||
           gonio_i_comments_add(comments, "condition_number: %.6g", plan->condition_number);
}

/* What a plan does not have, basis, components or condition number, is 0 and not stated. */
static bool add_plan_notes(gonio_i_comments *comments, const gonio_plan *plan)
{
    return (plan->basis == 0 ||
            gonio_i_comments_add(comments, "basis: %016" PRIx64, plan->basis)) &&
           (plan->expected != NULL || plan->components == 0 ||
            gonio_i_comments_add(comments, "components: %zu", plan->components)) &&
           gonio_i_comments_add(comments, "method: %s", plan->method) &&
           add_quality(comments, plan) &&
           (plan->run == NULL ||
            (gonio_i_comments_add(comments, "instrument: %s", plan->run->instrument) &&
             gonio_i_comments_add(comments, "duration_s: %.1f", plan->run->duration))) &&
           gonio_i_comments_add(comments, "grid: half/difference 90 x 90 x 180") &&
           gonio_i_comments_add(comments,
                                "theta from the normal, phi about it, incident (i) towards "
                                "the light, outgoing (o) towards the detector; a row asks "
                                "for one channel, other channels read there may be kept");
}

bool gonio_i_plan_comments(const gonio_plan *plan, gonio_i_comments *comments)
{
    return gonio_i_comments_add(comments, "gonio plan") && add_plan_notes(comments, plan);
}

/* Degrees that rounding does not move to the horizon. */
static double above_horizon(double theta)
{
    return fmin(theta * 180.0 / M_PI, 89.999999999);
}

static bool add_entry(gonio_i_csv *csv, const gonio_plan_entry *entry)
{
    const double degrees = 180.0 / M_PI;
    const size_t row = csv->rows;
    return gonio_i_csv_add_row(csv, 0) &&
           gonio_i_csv_set(csv, row, 0, "%.9f", above_horizon(entry->pair.incident.theta)) &&
           gonio_i_csv_set(csv, row, 1, "%.9f", entry->pair.incident.phi * degrees) &&
           gonio_i_csv_set(csv, row, 2, "%.9f", above_horizon(entry->pair.outgoing.theta)) &&
           gonio_i_csv_set(csv, row, 3, "%.9f", entry->pair.outgoing.phi * degrees) &&
           gonio_i_csv_set(csv, row, 4, "%s", gonio_i_planned_channel_name(entry->channel));
}

/* Columns of the axes and of the time, of plans for an instrument. */
static bool add_run_columns(gonio_i_csv *csv, const gonio_plan_run *run)
{
    bool done = true;
    for (size_t k = 0; k < run->axes && done; k++) {
        char name[GONIO_NAME_ROOM + 16];
        snprintf(name, sizeof name, "axis_%s_deg", run->axis[k]);
        done = !run->shown[k] || gonio_i_csv_add_column(csv, name);
    }
    return done && gonio_i_csv_add_column(csv, "time_s");
}

static bool add_run(gonio_i_csv *csv, const gonio_plan_run *run, size_t row, size_t column)
{
    bool done = true;
    for (size_t k = 0; k < run->axes && done; k++) {
        const double degrees = run->setting[row].axis[k] * 180.0 / M_PI;
        done = !run->shown[k] || gonio_i_csv_set(csv, row, column++, "%.4f", degrees + 0.0);
    }
    return done && gonio_i_csv_set(csv, row, column, "%.1f", run->time[row]);
}

static bool fill_plan(gonio_i_csv *csv, const gonio_plan *plan, const char *command)
{
    bool done =
        add_origin(&csv->comment, "plan", command) && add_plan_notes(&csv->comment, plan) &&
        gonio_i_csv_add_column(csv, "theta_i_deg") && gonio_i_csv_add_column(csv, "phi_i_deg") &&
        gonio_i_csv_add_column(csv, "theta_o_deg") && gonio_i_csv_add_column(csv, "phi_o_deg") &&
        gonio_i_csv_add_column(csv, "channel") &&
        (plan->expected == NULL || gonio_i_csv_add_column(csv, "expected_e6_percent")) &&
        (plan->run == NULL || add_run_columns(csv, plan->run));
    for (size_t k = 0; done && k < plan->count; k++) {
        done = add_entry(csv, &plan->entries[k]) &&
               (plan->expected == NULL || gonio_i_csv_set(csv, k, 5, "%.4g", plan->expected[k])) &&
               (plan->run == NULL || add_run(csv, plan->run, k, plan->expected != NULL ? 6 : 5));
    }
    return done;
}

static bool fill_history(gonio_i_csv *csv, const gonio_plan *plan, const char *command)
{
    bool done = add_origin(&csv->comment, "plan history", command) &&
                gonio_i_csv_add_column(csv, "restart") && gonio_i_csv_add_column(csv, "swap") &&
                gonio_i_csv_add_column(csv, "condition_number");
    for (size_t k = 0; done && k < plan->steps; k++) {
        const gonio_plan_step *step = &plan->history[k];
        done = gonio_i_csv_add_row(csv, 0) &&
               gonio_i_csv_set(csv, k, 0, "%d", (int)step->restart) &&
               gonio_i_csv_set(csv, k, 1, "%d", (int)step->swap) &&
               gonio_i_csv_set(csv, k, 2, "%.10g", step->condition_number);
    }
    return done;
}

static gonio_status write_table(gonio_context *context, const gonio_plan *plan, const char *command,
                                const char *path,
                                bool (*fill)(gonio_i_csv *, const gonio_plan *, const char *))
{
    gonio_i_csv *csv = gonio_i_csv_create(context);
    if (csv == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status = fill(csv, plan, command) ? gonio_i_csv_write(context, csv, path)
                                                         : gonio_i_fail(context, GONIO_ERROR_MEMORY,
                                                                        "%s: out of memory", path);
    gonio_i_csv_free(&csv);
    return status;
}

gonio_status gonio_plan_write(gonio_context *context, const gonio_plan *plan, const char *command,
                              const char *path)
{
    for (size_t k = 0; k < plan->count; k++) {
        const int channel = plan->entries[k].channel;
        if (channel < GONIO_ALL_CHANNELS || channel >= GONIO_CHANNELS) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                "%s: entry %zu of the plan reads channel %d", path, k + 1, channel);
        }
    }
    return write_table(context, plan, command, path, fill_plan);
}

gonio_status gonio_plan_write_history(gonio_context *context, const gonio_plan *plan,
                                      const char *command, const char *path)
{
    return write_table(context, plan, command, path, fill_history);
}
