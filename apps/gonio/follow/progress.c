/* What is said of a run: see progress.h. */
#include "progress.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "../json_output.h"

static const char *const ending_words[] = {"going on", "all read",    "target met",
                                           "time up",  "input ended", "interrupted"};

void follow_say(follower *f, gonio_message_level level, const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&text, format, arguments) >= 0) {
        tool_say(&f->t->messages, level, text);
        free(text);
    }
    va_end(arguments);
}

gonio_status follow_fail(follower *f, gonio_status status, const char *path, const char *text)
{
    follow_say(f, GONIO_MESSAGE_ERROR, "%s: %s", path, text);
    f->status = status;
    return status;
}

void follow_say_repeat(follower *f, size_t wanted, const char *why)
{
    const run_wanted *w = &f->run.wanted[wanted];
    FILE *stream = tool_json ? stderr : tool_results();
    tool_clear_progress(&f->t->messages);
    if (!tool_quiet) {
        fprintf(stream, "read again: theta_i %.4g, phi_i %.4g, theta_o %.4g, phi_o %.4g: %s\n",
                w->degrees[0], w->degrees[1], w->degrees[2], w->degrees[3], why);
        fflush(stream);
    }
}

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
    print_left(stream, left > 0 ? (double)left * run_reading_time(r) : NAN);
    fputc('\n', stream);
    fflush(stream);
}

int follow_report(follower *f, ending end)
{
    const run *r = &f->run;
    const size_t aside = run_set_aside(r);
    if (tool_json) {
        return tool_print_json(
            f->t, json_pack("{s:o, s:s, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:f}", "output",
                            tool_json_text(f->o->output), "ended", ending_words[end], "readings",
                            (json_int_t)run_counted(r), "directions_read",
                            (json_int_t)run_directions_read(r), "directions_left",
                            (json_int_t)run_left(r), "set_aside", (json_int_t)aside, "copies",
                            (json_int_t)r->copies, "not_understood", (json_int_t)r->unclear,
                            "expected_e6_percent", tool_json_number(f->verdict.expected), "seconds",
                            follow_elapsed(f)));
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
        fputc('\n', tool_results());
    }
    return 0;
}
