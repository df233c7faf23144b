/* What is said of a run: see progress.h. */
#include "progress.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "../json_output.h"
#include "settings.h"

static const char *const ending_words[] = {"going on",   "all read",    "target met",
                                           "time up",    "input ended", "nothing more came",
                                           "interrupted"};

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
                w->degrees[0], w->degrees[1] + 0.0, w->degrees[2], w->degrees[3] + 0.0, why);
        fflush(stream);
    }
}

/* A number for a note without its numbers, and for plurals as for one. */
static uint64_t kind_of(const char *note)
{
    uint64_t hash = 14695981039346656037U;
    for (; *note != '\0'; note++) {
        const bool plural = *note == 's' && !isalpha((unsigned char)note[1]);
        if (isalpha((unsigned char)*note) && !plural) {
            hash = (hash ^ (unsigned char)*note) * 1099511628211U;
        }
    }
    return hash;
}

/* Whether a kind of note is new; it is not any more then. */
static bool is_new_kind(follower *f, uint64_t kind)
{
    size_t k = 0;
    while (k < f->said_count && f->said[k] != kind) {
        k++;
    }
    uint64_t *more =
        k == f->said_count ? reallocarray(f->said, f->said_count + 1, sizeof *more) : NULL;
    if (more == NULL) {
        return false;
    }
    f->said = more;
    f->said[f->said_count++] = kind;
    return true;
}

void follow_say_notes(follower *f, const gonio_readings_view *readings)
{
    for (size_t k = 0; k < readings->notes; k++) {
        if (is_new_kind(f, kind_of(readings->note[k]))) {
            follow_say(f, GONIO_MESSAGE_NOTE, "%s: %s", f->run.path, readings->note[k]);
        }
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
