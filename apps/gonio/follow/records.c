/* The records of a run: see records.h. */
#include "records.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "say.h"

/* ---- read again ---- */

static gonio_status take_plan_record(follower *f, const char *text)
{
    f->plan_before = strtoull(text, NULL, 16);
    return GONIO_OK;
}

static gonio_status take_line_record(follower *f, const char *text)
{
    char *end = NULL;
    gonio_status status = GONIO_OK;
    const size_t line = strtoull(text, &end, 10);
    const double seconds = strtod(end, &end);
    run_take(&f->run, line, seconds, end + (*end == ' '), &status);
    f->before = seconds > f->before ? seconds : f->before;
    return status;
}

static gonio_status take_ask_record(follower *f, const char *text)
{
    const size_t wanted = strtoull(text, NULL, 10);
    if (wanted < f->run.wanted_count) {
        run_ask(&f->run, wanted);
    }
    return GONIO_OK;
}

/* Angles, four a direction. */
static gonio_status take_adapt_record(follower *f, const char *text)
{
    const size_t room = strlen(text) / 8 + 1;
    double(*degrees)[4] = calloc(room, sizeof *degrees);
    size_t count = 0;
    char *end = NULL;
    for (const char *at = text; degrees != NULL && count < room * 4; at = end, count++) {
        const double angle = strtod(at, &end);
        if (end == at) {
            break;
        }
        degrees[count / 4][count % 4] = angle;
    }
    const gonio_status status = degrees != NULL
                                    ? run_replace(&f->run, (const double(*)[4])degrees, count / 4)
                                    : GONIO_ERROR_MEMORY;
    f->adapted_at = f->run.rows;
    free(degrees);
    return status;
}

typedef struct record_kind {
    const char *name;
    gonio_status (*take)(follower *f, const char *text);
} record_kind;

static const record_kind kinds[] = {{"plan", take_plan_record},
                                    {"line", take_line_record},
                                    {"ask", take_ask_record},
                                    {"adapt", take_adapt_record}};

static gonio_status take_record(void *user, const char *kind, const char *text)
{
    follower *f = user;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        if (strcmp(kinds[k].name, kind) == 0) {
            return kinds[k].take(f, text);
        }
    }
    return GONIO_OK;
}

/* ---- written ---- */

void follow_record(follower *f, const char *kind, const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    const bool made = vasprintf(&text, format, arguments) >= 0;
    va_end(arguments);
    if (f->status == GONIO_OK && (!made || !journal_append(f->journal, kind, text))) {
        follow_fail(f, GONIO_ERROR_IO, f->journal_path, strerror(errno));
    }
    free(made ? text : NULL);
}

void follow_flush(follower *f)
{
    if (f->status == GONIO_OK && !journal_flush(f->journal)) {
        follow_fail(f, GONIO_ERROR_IO, f->journal_path, strerror(errno));
    }
}

/* ---- opening ---- */

static void say_what_was_found(follower *f, const journal_found *found)
{
    if (found->cut > 0 || found->damaged > 0) {
        follow_say(
            f, GONIO_MESSAGE_NOTE,
            "%s: %zu line%s damaged and passed over; %zu byte%s of an unfinished line cut off",
            f->journal_path, found->damaged, tool_plural(found->damaged), found->cut,
            tool_plural(found->cut));
    }
    if (found->records > 0) {
        follow_say(f, GONIO_MESSAGE_NOTE, "%s: going on after %zu reading%s", f->journal_path,
                   run_counted(&f->run), tool_plural(run_counted(&f->run)));
    }
    if (f->plan_before != 0 && f->plan_before != f->plan) {
        follow_say(
            f, GONIO_MESSAGE_WARNING,
            "the plan is not the one that the run began with: %zu of its directions were read, "
            "%zu are left, and %zu readings are at none of them",
            run_directions_read(&f->run), run_left(&f->run),
            f->run.rows - run_directions_read(&f->run));
    }
}

gonio_status follow_open_journal(follower *f)
{
    journal_found found;
    char *problem = NULL;
    f->journal_path = f->o->journal != NULL ? strdup(f->o->journal) : NULL;
    if (f->o->journal == NULL && asprintf(&f->journal_path, "%s.journal", f->o->output) < 0) {
        f->journal_path = NULL;
    }
    f->status = f->journal_path == NULL
                    ? GONIO_ERROR_MEMORY
                    : journal_open(f->journal_path, take_record, f, &found, &f->journal, &problem);
    if (problem != NULL) {
        follow_say(f, GONIO_MESSAGE_ERROR, "%s", problem);
        free(problem);
    }
    if (f->status == GONIO_OK) {
        say_what_was_found(f, &found);
        if (f->plan_before != f->plan) {
            follow_record(f, "plan", "%016" PRIx64, f->plan);
        }
        follow_flush(f);
    }
    return f->status;
}
