/* The files that a run writes: see outputs.h. */
#include "outputs.h"

#include <math.h>
#include <stdlib.h>

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

/* Writes what is left to be read, in order. */
void follow_save_remaining(follower *f)
{
    const run *r = &f->run;
    gonio_plan plan = {.method = "expected-error"};
    if (f->status != GONIO_OK || f->o->remaining == NULL) {
        return;
    }
    plan.entries = calloc(r->wanted_count + 1, sizeof *plan.entries);
    f->status = plan.entries == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (int again = 1; again >= 0 && plan.entries != NULL; again--) {
        for (size_t k = 0; k < r->wanted_count; k++) {
            const run_wanted *w = &r->wanted[k];
            const bool open = w->asked || w->row == RUN_NOWHERE;
            if (!w->dropped && open && w->asked == (again == 1)) {
                set_entry(w->degrees, &plan.entries[plan.count++]);
            }
        }
    }
    if (f->status == GONIO_OK) {
        f->status = gonio_plan_write(f->t->context, &plan, f->t->command_line, f->o->remaining);
    }
    free(plan.entries);
}
