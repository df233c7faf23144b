/* A run on a real instrument, from its journal to its readings: see follow.h. */
#include "follow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../builtin_basis.h"
#include "../duration.h"
#include "../inputs.h"
#include "../planning_options.h"
#include "flags.h"
#include "follower.h"
#include "outputs.h"
#include "progress.h"
#include "say.h"
#include "records.h"
#include "requests.h"
#include "settings.h"
#include "sources.h"

/* ---- the run ---- */

/* Does what new readings ask for. They are on the disk before anything else. */
static void act(follower *f)
{
    follow_flush(f);
    follow_save(f);
    if (f->status == GONIO_OK) {
        free(f->verdict.doubt);
        f->verdict.doubt = NULL;
        f->verdict.doubts = 0;
        f->status = judge_run(&f->judge, &f->run, &f->verdict);
    }
    if (f->status == GONIO_OK) {
        follow_ask_for_doubts(f);
        follow_adapt(f);
        follow_flush(f);
    }
    follow_save_remaining(f);
    if (f->status == GONIO_OK) {
        follow_show_progress(f);
    }
    f->fresh = 0;
    f->idle_since = tool_seconds();
}

/* Whether the time is up, or would be before another reading is made. */
static bool is_time_up(follower *f)
{
    const double usual = run_reading_time(&f->run);
    const double next =
        f->o->command == NULL
            ? 0.0
            : fmax(f->inputs.instrument != NULL ? follow_time_of_next(f) : usual, usual);
    return follow_elapsed(f) + (isnan(next) ? 0.0 : next) > f->budget;
}

static bool is_idle(const follower *f)
{
    return f->o->command == NULL && tool_seconds() - f->idle_since > follow_patience(f);
}

static ending find_ending(follower *f, ending input)
{
    if (tool_is_interrupted()) {
        return INTERRUPTED;
    }
    if (f->target > 0.0 && f->verdict.expected <= f->target) {
        return TARGET_MET;
    }
    if (run_left(&f->run) == 0) {
        return ALL_READ;
    }
    return is_time_up(f) ? TIME_UP : is_idle(f) ? NOTHING_CAME : input;
}

/* One round: what is new, and what follows from it. */
static ending go_on(follower *f)
{
    const ending input =
        f->o->command != NULL ? follow_take_from_command(f) : follow_take_from_file(f);
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

/* ---- beginning and end ---- */

static gonio_status begin_judge(follower *f)
{
    const gonio_context_options silent = {.size = sizeof silent, .threads = tool_threads};
    const planning_options planning = {.count = PLANNING_USUAL_COUNT,
                                       .candidates = f->o->candidates,
                                       .instrument = f->o->instrument};
    posterior_options judged = f->o->posterior;
    judge *j = &f->judge;
    j->context = f->t->context;
    gonio_reconstruct_options_default(&j->how);
    j->how.other_basis = true;
    j->how.no_checks = true;
    j->how.method = "posterior";
    gonio_plan_options_default(&j->plan);
    f->verdict.expected = NAN;
    gonio_status status = gonio_context_create(&j->silent, &silent);
    if (status == GONIO_OK) {
        status = planning_options_apply(f->t, &planning, &j->plan, &f->inputs);
    }
    if (status == GONIO_OK) {
        follow_set_limits(f, &judged);
        posterior_options_apply(&judged, &j->how);
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
        f->plan_basis = gonio_readings_describe(plan)->basis;
        status = run_begin(&f->run, plan, &how, strcmp(from, "-") == 0 ? "standard input" : from);
    }
    if (status == GONIO_OK) {
        status = begin_judge(f);
        f->run.how.instrument = f->inputs.instrument;
    }
    if (status == GONIO_OK) {
        follow_note_instrument(f, plan);
        status = follow_check_reach(f);
    }
    gonio_readings_free(&plan);
    f->began = tool_seconds();
    return status == GONIO_OK ? follow_open_journal(f) : status;
}

static void end(follower *f)
{
    run_end(&f->run);
    journal_close(&f->journal);
    line_source_end(&f->source);
    gonio_basis_free(&f->basis);
    gonio_context_free(&f->judge.silent);
    free(f->verdict.doubt);
    free(f->said);
    planning_inputs_free(&f->inputs);
    free(f->journal_path);
}

int follow_run(tool *t, const follow_options *o, const char *plan)
{
    follower f = {.t = t, .o = o, .budget = INFINITY};
    if (o->budget != NULL) {
        tool_duration(o->budget, &f.budget);
    }
    if (o->idle != NULL) {
        tool_duration(o->idle, &f.idle);
    }
    f.target = o->target != NULL ? planning_percent(o->target) : 0.0;
    f.idle_since = tool_seconds();
    line_source_begin(&f.source, o->follow != NULL ? o->follow : "");
    f.status = begin(&f, plan);
    ending how = GOING_ON;
    if (f.status == GONIO_OK) {
        follow_show_beginning(&f);
        how = follow_all(&f);
    }
    if (f.status == GONIO_ERROR_MEMORY) {
        follow_say(&f, GONIO_MESSAGE_ERROR, "out of memory");
    }
    const int code = f.status == GONIO_OK ? follow_report(&f, how) : tool_exit_code(f.status);
    end(&f);
    return code;
}

bool follow_check(const tool *t, const follow_options *o, const char *const *arguments,
                  size_t count)
{
    double budget = 0.0;
    double idle = 0.0;
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
    if (o->idle != NULL && !tool_duration(o->idle, &idle)) {
        return tool_refuse(t, "--idle: '%s' is not a duration such as 45min, 2h or 90s", o->idle);
    }
    if (o->instrument != NULL && o->candidates != NULL) {
        return tool_refuse(t, "give --instrument or --candidates, not both");
    }
    const char *inputs[] = {arguments[0], o->follow, o->basis, o->candidates, o->instrument};
    const size_t inputs_count = sizeof inputs / sizeof *inputs;
    if (o->journal == NULL && o->output != NULL && strcmp(o->output, "-") == 0) {
        return tool_refuse(t, "-o -: give --journal FILE");
    }
    return tool_check_output(t, o->output, inputs, inputs_count) &&
           (o->journal == NULL || tool_check_output(t, o->journal, inputs, inputs_count)) &&
           (o->remaining == NULL || tool_check_output(t, o->remaining, inputs, inputs_count)) &&
           posterior_options_check(t, &o->posterior);
}
