/* How far a run is, and how it ended: see progress.h. */
#include "progress.h"

#include <math.h>
#include <stdio.h>

#include "../json_output.h"
#include "settings.h"

static const char *const ending_words[] = {"going on",   "all read",    "target met",
                                           "time up",    "input ended", "nothing more came",
                                           "interrupted"};

static void print_left(FILE *stream, double seconds)
{
    if (isnan(seconds)) {
        return;
    }
    if (seconds >= 120.0) {
        fprintf(stream, "; about %.0f min left", seconds / 60.0);
    } else {
        fprintf(stream, "; about %.0f s left", seconds);
    }
}

void follow_show_beginning(follower *f)
{
    if (f->inputs.instrument == NULL || tool_quiet || tool_json) {
        return;
    }
    fprintf(tool_results(), "%s: %zu direction%s to read",
            gonio_instrument_describe(f->inputs.instrument)->name, run_left(&f->run),
            tool_plural(run_left(&f->run)));
    print_left(tool_results(), run_left(&f->run) > 0 ? follow_time_left(f) : NAN);
    fputc('\n', tool_results());
    fflush(tool_results());
}

/* Seconds that the rest takes: by the instrument, otherwise by the pace so far. */
static double time_left(follower *f)
{
    const size_t left = run_left(&f->run);
    return f->inputs.instrument != NULL ? follow_time_left(f)
                                        : (double)left * run_reading_time(&f->run);
}

/* One line: how far the run is. */
void follow_show_progress(follower *f)
{
    const run *r = &f->run;
    const size_t left = run_left(r);
    if (tool_quiet || tool_json) {
        return;
    }
    FILE *stream = tool_results();
    fprintf(stream, "%zu read, %zu left", run_directions_read(r), left);
    if (!isnan(f->verdict.expected)) {
        fprintf(stream, "; expected error (E6) %.2f %%", f->verdict.expected);
    }
    print_left(stream, left > 0 ? time_left(f) : NAN);
    fputc('\n', stream);
    fflush(stream);
}

int follow_report(follower *f, ending end)
{
    const run *r = &f->run;
    const size_t aside = run_set_aside(r);
    if (tool_json) {
        return tool_print_json(
            f->t,
            json_pack("{s:o, s:s, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:f, s:o}", "output",
                      tool_json_text(f->o->output), "ended", ending_words[end], "readings",
                      (json_int_t)run_counted(r), "directions_read",
                      (json_int_t)run_directions_read(r), "directions_left",
                      (json_int_t)run_left(r), "set_aside", (json_int_t)aside, "copies",
                      (json_int_t)r->copies, "not_understood", (json_int_t)r->unclear,
                      "at_dark_level", (json_int_t)f->at_dark, "expected_e6_percent",
                      tool_json_number(f->verdict.expected), "seconds", follow_elapsed(f),
                      "seconds_left", tool_json_number(run_left(r) > 0 ? time_left(f) : 0.0)));
    }
    if (!tool_quiet) {
        fprintf(tool_results(), "%s: %s: %zu reading%s, %zu direction%s left", f->o->output,
                ending_words[end], run_counted(r), tool_plural(run_counted(r)), run_left(r),
                tool_plural(run_left(r)));
        if (aside > 0) {
            fprintf(tool_results(), "; %zu reading%s set aside, as another was made in its place",
                    aside, tool_plural(aside));
        }
        if (r->unclear > 0) {
            fprintf(tool_results(), "; %zu line%s not understood", r->unclear,
                    tool_plural(r->unclear));
        }
        if (f->at_dark > 0) {
            fprintf(tool_results(), "; %zu at the dark level", f->at_dark);
        }
        fputc('\n', tool_results());
        if (end == NOTHING_CAME && run_unread(r) == 0) {
            fprintf(tool_results(), "the directions that are left were asked for again and not "
                                    "read; their first readings count\n");
        }
    }
    return 0;
}
