/* The files that a run writes: see outputs.h. */
#include "outputs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "flags.h"
#include "say.h"
#include "settings.h"

/* Writes the readings that count. */
void follow_save(follower *f)
{
    size_t size = 0;
    gonio_readings *readings = NULL;
    gonio_readings_options how = f->run.how;
    how.average_repeats = true;
    if (f->status != GONIO_OK || run_counted(&f->run) == 0) {
        return;
    }
    char *text = run_text(&f->run, &size, NULL);
    f->status = text == NULL ? GONIO_ERROR_MEMORY
                             : gonio_readings_read_text(f->judge.silent, f->run.path, text, size,
                                                        &how, &readings);
    if (f->status == GONIO_OK) {
        follow_say_notes(f, gonio_readings_describe(readings));
        follow_check_values(f, readings);
        f->status = gonio_readings_write(f->t->context, readings, f->t->command_line, f->o->output);
    }
    gonio_readings_free(&readings);
    free(text);
}

static void set_entry(const double degrees[4], gonio_plan_entry *entry)
{
    const double scale = M_PI / 180.0;
    *entry = (gonio_plan_entry){.channel = GONIO_ALL_CHANNELS,
                                .pair = {{degrees[0] * scale, degrees[1] * scale},
                                         {degrees[2] * scale, degrees[3] * scale}}};
}

/* The names of the instrument, and room for the run of the rest. */
static gonio_status begin_run(const follower *f, size_t count, gonio_plan_run *made)
{
    const gonio_instrument_view *view = gonio_instrument_describe(f->inputs.instrument);
    *made = (gonio_plan_run){.axes = view->axes};
    snprintf(made->instrument, sizeof made->instrument, "%s", view->name);
    for (size_t k = 0; k < view->axes; k++) {
        snprintf(made->axis[k], sizeof made->axis[k], "%s", view->axis[k].name);
        made->shown[k] = view->axis[k].present;
    }
    made->setting = calloc(count + 1, sizeof *made->setting);
    made->time = calloc(count + 1, sizeof *made->time);
    return made->setting != NULL && made->time != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* How the instrument reads the rest: settings and times from now on. */
static gonio_status set_run(follower *f, const size_t *open, gonio_plan *plan, gonio_plan_run *made)
{
    const gonio_instrument *instrument = f->inputs.instrument;
    const double exposure = gonio_instrument_describe(instrument)->exposure;
    gonio_setting at;
    const gonio_status status = begin_run(f, plan->count, made);
    follow_place(f, &at);
    for (size_t k = 0; k < plan->count && status == GONIO_OK; k++) {
        gonio_setting *next = &made->setting[k];
        *next = at;
        if (follow_setting(f, f->run.wanted[open[k]].degrees, &at, next)) {
            plan->entries[k].pair = next->pair;
        }
        made->duration += gonio_instrument_travel(instrument, &at, next) + exposure;
        made->time[k] = made->duration;
        at = *next;
    }
    plan->run = made;
    return status;
}

static gonio_status fill_plan(follower *f, const size_t *open, gonio_plan *plan,
                              gonio_plan_run *made)
{
    plan->entries = calloc(plan->count + 1, sizeof *plan->entries);
    if (plan->entries == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < plan->count; k++) {
        set_entry(f->run.wanted[open[k]].degrees, &plan->entries[k]);
    }
    return f->inputs.instrument != NULL ? set_run(f, open, plan, made) : GONIO_OK;
}

/* Writes what is left to be read, in order. */
void follow_save_remaining(follower *f)
{
    gonio_plan plan = {.method = "expected-error", .basis = f->plan_basis};
    gonio_plan_run made = {0};
    if (f->status != GONIO_OK || f->o->remaining == NULL) {
        return;
    }
    size_t *open = calloc(f->run.wanted_count + 1, sizeof *open);
    plan.count = open != NULL ? run_list_open(&f->run, open) : 0;
    f->status = open != NULL ? fill_plan(f, open, &plan, &made) : GONIO_ERROR_MEMORY;
    if (f->status == GONIO_OK) {
        f->status = gonio_plan_write(f->t->context, &plan, f->t->command_line, f->o->remaining);
    }
    free(plan.entries);
    free(made.setting);
    free(made.time);
    free(open);
}
