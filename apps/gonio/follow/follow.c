/* A run on a real instrument, from its journal to its readings: see follow.h. */
#include "follow.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../builtin_basis.h"
#include "../duration.h"
#include "../inputs.h"
#include "../json_output.h"
#include "../planning_options.h"
#include "command_source.h"
#include "journal.h"
#include "judge.h"
#include "line_source.h"

enum {
    WAIT = 100,       /* milliseconds between looks at the file */
    ADAPT_EVERY = 5,  /* readings after which the rest is planned again */
    MOST_FAILURES = 3 /* of a command, one after another */
};

static const double LONG_PENDING = 5.0; /* seconds after which half a line is spoken of */

/* Why a run ended. */
typedef enum ending { GOING_ON, ALL_READ, TARGET_MET, TIME_UP, INPUT_ENDED, INTERRUPTED } ending;

static const char *const ending_words[] = {"going on", "all read",    "target met",
                                           "time up",  "input ended", "interrupted"};

typedef struct follower {
    tool *t;
    const follow_options *o;
    run run;
    judge judge;
    judge_verdict verdict;
    gonio_basis *basis;
    planning_inputs inputs;
    journal *journal;
    char *journal_path;
    line_source source;
    uint64_t plan;        /* fingerprint of the plan, */
    uint64_t plan_before; /* and of that of the journal; 0: there was none */
    double began;         /* the clock at the beginning, */
    double before;        /* and the seconds that earlier parts of the run took */
    double budget;        /* seconds; infinite: none */
    double target;        /* per cent; 0: none */
    double idle_since;
    size_t adapted_at; /* rows when the rest was planned last */
    size_t fresh;      /* rows that are not judged yet */
    size_t failures;   /* of the command, one after another */
    bool said_waiting;
    bool said_pending;
    gonio_status status;
} follower;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double elapsed(const follower *f)
{
    return f->before + now() - f->began;
}

/* ---- saying ---- */

__attribute__((format(printf, 3, 4))) static void say(follower *f, gonio_message_level level,
                                                      const char *format, ...)
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

static gonio_status fail(follower *f, gonio_status status, const char *path, const char *text)
{
    say(f, GONIO_MESSAGE_ERROR, "%s: %s", path, text);
    f->status = status;
    return status;
}

static void say_repeat(follower *f, size_t wanted, const char *why)
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

/* The mean time of a reading; NaN: not known. Lines that come together say nothing of it. */
static double time_of_reading(const run *r)
{
    const double taken = r->rows > 1 ? r->row[r->rows - 1].seconds - r->row[0].seconds : 0.0;
    return taken > 0.0 ? taken / (double)(r->rows - 1) : NAN;
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

static size_t directions_read(const run *r)
{
    size_t count = 0;
    for (size_t k = 0; k < r->wanted_count; k++) {
        count += r->wanted[k].row != RUN_NOWHERE;
    }
    return count;
}

/* One line: how far the run is. */
static void show_progress(follower *f)
{
    const run *r = &f->run;
    const size_t left = run_left(r);
    if (tool_quiet || tool_json) {
        return;
    }
    FILE *stream = tool_results();
    fprintf(stream, "%zu read, %zu left", directions_read(r), left);
    if (!isnan(f->verdict.expected)) {
        fprintf(stream, "; expected error (E6) %.2f %%", f->verdict.expected);
    }
    print_left(stream, left > 0 ? (double)left * time_of_reading(r) : NAN);
    fputc('\n', stream);
    fflush(stream);
}

/* ---- the journal ---- */

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

__attribute__((format(printf, 3, 4))) static void record(follower *f, const char *kind,
                                                         const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    const bool made = vasprintf(&text, format, arguments) >= 0;
    va_end(arguments);
    if (f->status == GONIO_OK && (!made || !journal_append(f->journal, kind, text))) {
        fail(f, GONIO_ERROR_IO, f->journal_path, strerror(errno));
    }
    free(made ? text : NULL);
}

static void flush(follower *f)
{
    if (f->status == GONIO_OK && !journal_flush(f->journal)) {
        fail(f, GONIO_ERROR_IO, f->journal_path, strerror(errno));
    }
}

static void say_what_was_found(follower *f, const journal_found *found)
{
    if (found->cut > 0 || found->damaged > 0) {
        say(f, GONIO_MESSAGE_NOTE,
            "%s: %zu line%s damaged and passed over; %zu byte%s of an unfinished line cut off",
            f->journal_path, found->damaged, tool_plural(found->damaged), found->cut,
            tool_plural(found->cut));
    }
    if (found->records > 0) {
        say(f, GONIO_MESSAGE_NOTE, "%s: going on after %zu reading%s", f->journal_path, f->run.rows,
            tool_plural(f->run.rows));
    }
    if (f->plan_before != 0 && f->plan_before != f->plan) {
        say(f, GONIO_MESSAGE_WARNING,
            "the plan is not the one that the run began with: %zu of its directions were read, "
            "%zu are left, and %zu readings are at none of them",
            directions_read(&f->run), run_left(&f->run), f->run.rows - directions_read(&f->run));
    }
}

static gonio_status open_journal(follower *f)
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
        say(f, GONIO_MESSAGE_ERROR, "%s", problem);
        free(problem);
    }
    if (f->status == GONIO_OK) {
        say_what_was_found(f, &found);
        if (f->plan_before != f->plan) {
            record(f, "plan", "%016" PRIx64, f->plan);
        }
        flush(f);
    }
    return f->status;
}

/* ---- lines ---- */

static void say_unread(follower *f)
{
    say(f, GONIO_MESSAGE_WARNING, "%s (kept in %s; the direction stays open)",
        f->run.problem != NULL ? f->run.problem : "a line is not understood", f->journal_path);
}

/* Says what is unusual of a new row, the first time that it happens. */
static void look_at_row(follower *f, size_t unordered, size_t backwards)
{
    const run *r = &f->run;
    const run_row *row = &r->row[r->rows - 1];
    if (row->of_sample && row->wanted == RUN_NOWHERE) {
        say(f, GONIO_MESSAGE_NOTE,
            "%s:%zu: no direction of the plan is within a degree of this one; the reading is kept",
            r->path, row->line);
    }
    if (r->unordered == 1 && unordered == 0) {
        say(f, GONIO_MESSAGE_NOTE,
            "%s:%zu: the readings come in another order than that of the plan", r->path, row->line);
    }
    if (r->backwards > backwards) {
        say(f, GONIO_MESSAGE_WARNING, "%s:%zu: the time is before that of the line above", r->path,
            row->line);
    }
}

static bool is_saturated(const follower *f, const run_row *row)
{
    bool saturated = false;
    for (size_t k = 0; k < row->channels; k++) {
        saturated = saturated || (f->o->posterior.saturation > 0.0 &&
                                  row->value[k] >= f->o->posterior.saturation);
    }
    return saturated;
}

static void ask(follower *f, size_t wanted, const char *why)
{
    if (run_ask(&f->run, wanted)) {
        record(f, "ask", "%zu", wanted);
        say_repeat(f, wanted, why);
    }
}

/* Takes one line: journal first. */
static void take_line(follower *f, size_t line, const char *text)
{
    const size_t unordered = f->run.unordered;
    const size_t backwards = f->run.backwards;
    const double seconds = elapsed(f);
    const size_t head = strlen(f->run.head);
    const run_fate fate = run_take(&f->run, line, seconds, text, &f->status);
    const bool is_new = fate != RUN_KNOWN || strlen(f->run.head) != head;
    if (f->status == GONIO_OK && is_new) {
        record(f, "line", "%zu %.3f %s", line, seconds, text);
    }
    if (fate == RUN_READING) {
        f->fresh++;
        look_at_row(f, unordered, backwards);
        const run_row *row = &f->run.row[f->run.rows - 1];
        if (row->wanted != RUN_NOWHERE && is_saturated(f, row)) {
            ask(f, row->wanted, "saturated: with less light, please");
        }
    } else if (fate == RUN_COPY) {
        say(f, GONIO_MESSAGE_NOTE, "%s:%zu: the same as an earlier line; left out", f->run.path,
            line);
    } else if (fate == RUN_UNCLEAR && f->status == GONIO_OK) {
        say_unread(f);
    } else if (fate == RUN_USELESS) {
        f->status = GONIO_ERROR_FORMAT;
        say(f, GONIO_MESSAGE_ERROR, "%s",
            f->run.problem != NULL ? f->run.problem : "the names of columns are not understood");
    }
}

/* ---- after new readings ---- */

/* Writes the readings that count. */
static void save(follower *f)
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
static void save_remaining(follower *f)
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

static void ask_for_doubts(follower *f)
{
    for (size_t k = 0; k < f->verdict.doubts; k++) {
        const judge_doubt *doubt = &f->verdict.doubt[k];
        const run_row *row = &f->run.row[doubt->row];
        char why[128];
        snprintf(why, sizeof why, "line %zu is %.3g times what the others predict", row->line,
                 doubt->ratio);
        if (row->wanted != RUN_NOWHERE) {
            ask(f, row->wanted, why);
        } else {
            say(f, GONIO_MESSAGE_NOTE, "%s:%zu: %s", f->run.path, row->line, why);
        }
    }
}

static void adapt(follower *f)
{
    double(*degrees)[4] = NULL;
    size_t count = 0;
    char *text = NULL;
    size_t size = 0;
    if (f->status != GONIO_OK || !f->o->adapt || f->run.rows < f->adapted_at + ADAPT_EVERY) {
        return;
    }
    f->status = judge_plan(&f->judge, &f->run, &degrees, &count);
    FILE *stream = f->status == GONIO_OK && count > 0 ? open_memstream(&text, &size) : NULL;
    for (size_t k = 0; stream != NULL && k < 4 * count; k++) {
        fprintf(stream, " %.9f", degrees[k / 4][k % 4]);
    }
    if (stream != NULL && fclose(stream) == 0) {
        record(f, "adapt", "%s", text);
        f->status = f->status == GONIO_OK ? run_replace(&f->run, (const double(*)[4])degrees, count)
                                          : f->status;
        f->adapted_at = f->run.rows;
    }
    free(text);
    free(degrees);
}

/* Does what new readings ask for. They are on the disk before anything else. */
static void act(follower *f)
{
    flush(f);
    save(f);
    if (f->status == GONIO_OK) {
        free(f->verdict.doubt);
        f->verdict.doubt = NULL;
        f->verdict.doubts = 0;
        f->status = judge_run(&f->judge, &f->run, &f->verdict);
    }
    if (f->status == GONIO_OK) {
        ask_for_doubts(f);
        adapt(f);
        flush(f);
    }
    save_remaining(f);
    if (f->status == GONIO_OK) {
        show_progress(f);
    }
    f->fresh = 0;
}

/* ---- sources ---- */

static void wait_a_while(void)
{
    poll(NULL, 0, WAIT);
}

static void say_pending(follower *f)
{
    if (line_source_pending(&f->source) > 0 && !f->said_pending &&
        now() - f->idle_since > LONG_PENDING) {
        say(f, GONIO_MESSAGE_NOTE, "%s:%zu: a line without an end is waited for", f->run.path,
            f->source.line + 1);
        f->said_pending = true;
    }
    if (f->source.descriptor < 0 && !f->said_waiting) {
        say(f, GONIO_MESSAGE_NOTE, "%s is not there yet: waiting", f->run.path);
        f->said_waiting = true;
    }
}

static ending end_of_input(follower *f)
{
    if (line_source_pending(&f->source) > 0) {
        say(f, GONIO_MESSAGE_WARNING,
            "%s:%zu: the last line has no end: it may be half of one, and is not taken",
            f->run.path, f->source.line + 1);
    }
    return INPUT_ENDED;
}

/* Takes what the file has that is new. */
static ending take_from_file(follower *f)
{
    const line_state state = line_source_read(&f->source);
    if (state == LINE_FAILED) {
        fail(f, GONIO_ERROR_IO, f->run.path, strerror(errno));
    }
    if (f->source.renewed) {
        say(f, GONIO_MESSAGE_WARNING,
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
        f->idle_since = now();
        f->said_pending = false;
    } else if (f->fresh == 0 && f->source.ended) {
        return end_of_input(f);
    } else if (f->fresh == 0) {
        say_pending(f);
        wait_a_while();
    }
    return GOING_ON;
}

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
static ending take_from_command(follower *f)
{
    const size_t wanted = run_next(&f->run);
    double degrees[4];
    char *output = NULL;
    char *problem = NULL;
    if (wanted == RUN_NOWHERE) {
        return GOING_ON;
    }
    memcpy(degrees, f->run.wanted[wanted].degrees, sizeof degrees);
    command_source_run(f->o->command, degrees, &output, &problem);
    if (problem == NULL && output != NULL) {
        take_command_output(f, degrees, output, &problem);
    }
    if (problem != NULL) {
        f->failures++;
        say(f, GONIO_MESSAGE_WARNING, "%s: at theta_i %.4g, theta_o %.4g: %s", f->o->command,
            degrees[0], degrees[2], problem);
    }
    if (f->failures >= MOST_FAILURES && f->status == GONIO_OK) {
        fail(f, GONIO_ERROR_IO, f->o->command,
             "failed several times, one after another; the same command line goes on with the run");
    }
    free(output);
    free(problem);
    return GOING_ON;
}

/* ---- the run ---- */

/* Whether the time is up, or would be before another reading is made. */
static bool is_time_up(const follower *f)
{
    const double next = f->o->command != NULL ? time_of_reading(&f->run) : 0.0;
    return elapsed(f) + (isnan(next) ? 0.0 : next) > f->budget;
}

static ending find_ending(const follower *f, ending input)
{
    if (tool_is_interrupted()) {
        return INTERRUPTED;
    }
    if (f->target > 0.0 && f->verdict.expected <= f->target) {
        return TARGET_MET;
    }
    return run_left(&f->run) == 0 ? ALL_READ : is_time_up(f) ? TIME_UP : input;
}

/* One round: what is new, and what follows from it. */
static ending go_on(follower *f)
{
    const ending input = f->o->command != NULL ? take_from_command(f) : take_from_file(f);
    if (f->fresh > 0 && f->status == GONIO_OK) {
        act(f);
    }
    return find_ending(f, input);
}

static ending follow_all(follower *f)
{
    ending end = GOING_ON;
    if (f->run.rows > 0 && f->status == GONIO_OK) {
        act(f);
        end = f->o->command != NULL ? find_ending(f, GOING_ON) : GOING_ON;
    }
    while (end == GOING_ON && f->status == GONIO_OK) {
        end = go_on(f);
    }
    if (f->status == GONIO_ERROR_CANCELLED) {
        f->status = GONIO_OK;
        end = INTERRUPTED;
    }
    return end;
}

static size_t rows_set_aside(const run *r)
{
    size_t count = 0;
    for (size_t k = 0; k < r->rows; k++) {
        count += r->row[k].set_aside;
    }
    return count;
}

static int report(follower *f, ending end)
{
    const run *r = &f->run;
    const size_t aside = rows_set_aside(r);
    if (tool_json) {
        return tool_print_json(
            f->t,
            json_pack("{s:o, s:s, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:f}", "output",
                      tool_json_text(f->o->output), "ended", ending_words[end], "readings",
                      (json_int_t)run_counted(r), "directions_read", (json_int_t)directions_read(r),
                      "directions_left", (json_int_t)run_left(r), "set_aside", (json_int_t)aside,
                      "copies", (json_int_t)r->copies, "not_understood", (json_int_t)r->unclear,
                      "expected_e6_percent", tool_json_number(f->verdict.expected), "seconds",
                      elapsed(f)));
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

/* ---- beginning and end ---- */

static gonio_status begin_judge(follower *f)
{
    const gonio_context_options silent = {.size = sizeof silent, .threads = tool_threads};
    const planning_options planning = {.count = PLANNING_USUAL_COUNT,
                                       .candidates = f->o->candidates};
    judge *j = &f->judge;
    j->context = f->t->context;
    gonio_reconstruct_options_default(&j->how);
    posterior_options_apply(&f->o->posterior, &j->how);
    j->how.other_basis = true;
    j->how.no_checks = true;
    j->how.method = "posterior";
    gonio_plan_options_default(&j->plan);
    f->verdict.expected = NAN;
    gonio_status status = gonio_context_create(&j->silent, &silent);
    if (status == GONIO_OK) {
        status = planning_options_apply(f->t, &planning, &j->plan, &f->inputs);
    }
    if (status == GONIO_OK && !f->o->no_basis) {
        status = tool_basis(f->t, f->o->basis, NULL, &f->basis);
    }
    j->basis = f->basis;
    return status;
}

static gonio_status begin(follower *f, const char *path)
{
    const gonio_readings_options any = {
        .size = sizeof any, .average_repeats = true, .negative_to_zero = true};
    gonio_readings_options how = tool_any_values;
    gonio_readings *plan = NULL;
    gonio_status status =
        tool_convention_of(f->t, f->o->follow != NULL ? f->o->follow : "-", &how.as);
    if (status == GONIO_OK) {
        status = tool_read_readings(f->t, path, &any, &plan);
    }
    if (status == GONIO_OK) {
        const char *from = f->o->follow != NULL ? f->o->follow : "readings";
        f->plan = run_fingerprint(plan);
        status = run_begin(&f->run, plan, &how, strcmp(from, "-") == 0 ? "standard input" : from);
    }
    if (status == GONIO_OK) {
        status = begin_judge(f);
    }
    gonio_readings_free(&plan);
    f->began = now();
    return status == GONIO_OK ? open_journal(f) : status;
}

static void end(follower *f)
{
    run_end(&f->run);
    journal_close(&f->journal);
    line_source_end(&f->source);
    gonio_basis_free(&f->basis);
    gonio_context_free(&f->judge.silent);
    free(f->verdict.doubt);
    planning_inputs_free(&f->inputs);
    free(f->journal_path);
}

int follow_run(tool *t, const follow_options *o, const char *plan)
{
    follower f = {.t = t, .o = o, .budget = INFINITY};
    if (o->budget != NULL) {
        tool_duration(o->budget, &f.budget);
    }
    f.target = o->target != NULL ? planning_percent(o->target) : 0.0;
    f.idle_since = now();
    line_source_begin(&f.source, o->follow != NULL ? o->follow : "");
    f.status = begin(&f, plan);
    ending how = GOING_ON;
    if (f.status == GONIO_OK) {
        how = follow_all(&f);
    }
    if (f.status == GONIO_ERROR_MEMORY) {
        say(&f, GONIO_MESSAGE_ERROR, "out of memory");
    }
    const int code = f.status == GONIO_OK ? report(&f, how) : tool_exit_code(f.status);
    end(&f);
    return code;
}

bool follow_check(const tool *t, const follow_options *o, const char *const *arguments,
                  size_t count)
{
    double budget = 0.0;
    if (count != 1) {
        return tool_refuse(t, "--follow and --exec take one PLAN, and no MATERIAL");
    }
    if (o->follow != NULL && o->command != NULL) {
        return tool_refuse(t, "--follow and --exec exclude each other");
    }
    if (o->adapt && o->no_basis) {
        return tool_refuse(t, "--adapt needs a basis");
    }
    if (o->target != NULL && (o->no_basis || !(planning_percent(o->target) > 0.0))) {
        return tool_refuse(t, "--target-error needs a basis, and an error in per cent above 0");
    }
    if (o->budget != NULL && !tool_duration(o->budget, &budget)) {
        return tool_refuse(t, "--budget: '%s' is not a duration such as 45min, 2h or 90s",
                           o->budget);
    }
    const char *inputs[] = {arguments[0], o->follow, o->basis, o->candidates};
    const size_t inputs_count = sizeof inputs / sizeof *inputs;
    if (o->journal == NULL && o->output != NULL && strcmp(o->output, "-") == 0) {
        return tool_refuse(t, "-o -: give --journal FILE");
    }
    return tool_check_output(t, o->output, inputs, inputs_count) &&
           (o->journal == NULL || tool_check_output(t, o->journal, inputs, inputs_count)) &&
           (o->remaining == NULL || tool_check_output(t, o->remaining, inputs, inputs_count)) &&
           posterior_options_check(t, &o->posterior);
}
