/* Where readings come from: see sources.h. */
#include "sources.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../duration.h"
#include "command_source.h"
#include "flags.h"
#include "say.h"
#include "records.h"
#include "settings.h"

enum {
    WAIT = 100,        /* milliseconds between looks at the file */
    OUTSIDE_TOLD = 10, /* readings outside the plan */
    MOST_FAILURES = 3  /* of a command, one after another */
};

static const double LONG_PENDING = 5.0; /* seconds after which half a line is spoken of */

/* ---- lines ---- */

static void say_unread(follower *f)
{
    follow_say(f, GONIO_MESSAGE_WARNING, "%s (kept in %s; the direction stays open)",
               f->run.problem != NULL ? f->run.problem : "a line is not understood",
               f->journal_path);
}

/* A reading at no direction of the plan. Of a file of other directions not each line is told. */
static void say_outside(follower *f, const run_row *row)
{
    f->outside++;
    if (f->outside <= OUTSIDE_TOLD) {
        follow_say(f, GONIO_MESSAGE_NOTE,
                   "%s:%zu: no direction of the plan is within a degree of this one; the reading "
                   "is kept%s",
                   f->run.path, row->line,
                   f->outside == OUTSIDE_TOLD ? ", as others like it from here on" : "");
    }
}

/* Says what is unusual of a new row, the first time that it happens. */
static void look_at_row(follower *f, size_t unordered, size_t backwards)
{
    const run *r = &f->run;
    const run_row *row = &r->row[r->rows - 1];
    if (row->of_sample && row->wanted == RUN_NOWHERE) {
        say_outside(f, row);
    }
    if (row->unlike != RUN_NOWHERE) {
        follow_say(f, GONIO_MESSAGE_WARNING,
                   "%s:%zu: the direction of line %zu again, with another value: both count",
                   r->path, row->line, r->row[row->unlike].line);
    }
    if (r->unordered == 1 && unordered == 0) {
        follow_say(f, GONIO_MESSAGE_NOTE,
                   "%s:%zu: the readings come in another order than that of the plan", r->path,
                   row->line);
    }
    if (r->backwards > backwards) {
        follow_say(f, GONIO_MESSAGE_WARNING, "%s:%zu: the time is before that of the line above",
                   r->path, row->line);
    }
}

/* Takes one line: journal first. */
static void take_line(follower *f, size_t line, const char *text)
{
    const size_t unordered = f->run.unordered;
    const size_t backwards = f->run.backwards;
    const double seconds = follow_elapsed(f);
    const size_t head = strlen(f->run.head);
    const run_fate fate = run_take(&f->run, line, seconds, text, &f->status);
    const bool is_new = fate != RUN_KNOWN || strlen(f->run.head) != head;
    if (f->status == GONIO_OK && is_new) {
        follow_record(f, "line", "%zu %.3f %s", line, seconds, text);
    }
    if (fate == RUN_READING) {
        f->fresh++;
        look_at_row(f, unordered, backwards);
        follow_flag(f);
    } else if (fate == RUN_COPY) {
        follow_say(f, GONIO_MESSAGE_NOTE, "%s:%zu: the same as an earlier line; left out",
                   f->run.path, line);
    } else if (fate == RUN_UNCLEAR && f->status == GONIO_OK) {
        say_unread(f);
    } else if (fate == RUN_USELESS) {
        f->status = GONIO_ERROR_FORMAT;
        follow_say(f, GONIO_MESSAGE_ERROR, "%s",
                   f->run.problem != NULL ? f->run.problem
                                          : "the names of columns are not understood");
    }
}

/* ---- a file that grows, standard input ---- */

static void wait_a_while(void)
{
    poll(NULL, 0, WAIT);
}

static void say_pending(follower *f)
{
    if (line_source_pending(&f->source) > 0 && !f->said_pending &&
        tool_seconds() - f->idle_since > LONG_PENDING) {
        follow_say(f, GONIO_MESSAGE_NOTE, "%s:%zu: a line without an end is waited for",
                   f->run.path, f->source.line + 1);
        f->said_pending = true;
    }
    if (run_unread(&f->run) == 0 && !f->said_repeats) {
        follow_say(f, GONIO_MESSAGE_NOTE,
                   "only repeats are left: %zu; waiting for them, %.3g s after the last line",
                   run_left(&f->run), follow_patience(f));
        f->said_repeats = true;
    }
    if (f->source.descriptor < 0 && !f->said_waiting) {
        follow_say(f, GONIO_MESSAGE_NOTE, "%s is not there yet: waiting", f->run.path);
        f->said_waiting = true;
    }
}

static ending end_of_input(follower *f)
{
    if (line_source_pending(&f->source) > 0) {
        follow_say(f, GONIO_MESSAGE_WARNING,
                   "%s:%zu: the last line has no end: it may be half of one, and is not taken",
                   f->run.path, f->source.line + 1);
    }
    return INPUT_ENDED;
}

/* Takes what the file has that is new. */
ending follow_take_from_file(follower *f)
{
    const line_state state = line_source_read(&f->source);
    if (state == LINE_FAILED) {
        follow_fail(f, GONIO_ERROR_IO, f->run.path, strerror(errno));
    }
    if (f->source.renewed) {
        follow_say(
            f, GONIO_MESSAGE_WARNING,
            "%s was shortened or replaced: it is read from its beginning; lines that came before "
            "are known",
            f->run.path);
        f->source.renewed = false;
    }
    const char *line = NULL;
    while (f->status == GONIO_OK && (line = line_source_next(&f->source)) != NULL) {
        take_line(f, f->source.line, line);
    }
    if (state == LINE_READY) {
        f->idle_since = tool_seconds();
        f->said_pending = false;
    } else if (f->fresh == 0 && f->source.ended) {
        return end_of_input(f);
    } else if (f->fresh == 0) {
        say_pending(f);
        wait_a_while();
    }
    return GOING_ON;
}

/* ---- a command ---- */

/* Takes the names of the values, the first time. False if they are others than before. */
static bool take_command_names(follower *f, const char *names)
{
    char *text = NULL;
    if (asprintf(&text, "theta_i_deg;phi_i_deg;theta_o_deg;phi_o_deg;%s", names) < 0) {
        f->status = GONIO_ERROR_MEMORY;
        return false;
    }
    if (f->run.names == NULL) {
        take_line(f, 1, text);
    }
    const bool same = f->run.names != NULL && strcmp(text, f->run.names) == 0;
    free(text);
    return same;
}

static void take_command_output(follower *f, const double degrees[4], const char *output,
                                char **problem)
{
    char *names = NULL;
    char *values = NULL;
    char *text = NULL;
    command_source_values(output, &names, &values, problem);
    if (*problem == NULL && !take_command_names(f, names) && f->status == GONIO_OK) {
        *problem = strdup("it printed other values than before");
    }
    if (*problem == NULL && f->status == GONIO_OK &&
        asprintf(&text, "%.9f;%.9f;%.9f;%.9f;%s", degrees[0], degrees[1], degrees[2], degrees[3],
                 values) >= 0) {
        const size_t unclear = f->run.unclear;
        take_line(f, f->run.rows + f->run.unclear + f->run.copies + 2, text);
        f->failures = f->run.unclear > unclear ? f->failures + 1 : 0;
        free(text);
    }
    free(names);
    free(values);
}

/* Has one direction read. */
ending follow_take_from_command(follower *f)
{
    const size_t wanted = run_next(&f->run);
    double degrees[4];
    char *output = NULL;
    char *problem = NULL;
    if (wanted == RUN_NOWHERE) {
        return GOING_ON;
    }
    memcpy(degrees, f->run.wanted[wanted].degrees, sizeof degrees);
    double position[GONIO_MOST_AXES];
    const size_t axes = follow_positions(f, degrees, position);
    command_source_run(f->o->command, degrees, position, axes, &output, &problem);
    if (problem == NULL && output != NULL) {
        take_command_output(f, degrees, output, &problem);
    }
    if (problem != NULL) {
        f->failures++;
        follow_say(f, GONIO_MESSAGE_WARNING, "%s: at theta_i %.4g, theta_o %.4g: %s", f->o->command,
                   degrees[0], degrees[2], problem);
    }
    if (f->failures >= MOST_FAILURES && f->status == GONIO_OK) {
        follow_fail(
            f, GONIO_ERROR_IO, f->o->command,
            "failed several times, one after another; the same command line goes on with the run");
    }
    free(output);
    free(problem);
    return GOING_ON;
}
