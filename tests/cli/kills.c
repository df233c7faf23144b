/* kills SHIM COUNT SEED OUTPUT[,OUTPUT] PROGRAM ARGUMENT...: runs a command in this folder COUNT
 * times, each of which SIGKILL, SIGTERM or SIGHUP ends at another moment: after a random part of
 * the time that it takes, at a random allocation, or at one of the calls that write (faults_shim.c;
 * a SHIM of "-": at times only). What must hold, of files in this folder and in TMPDIR:
 *
 *     the signal ends the program, or all is as without it
 *     each output is as before or as without a signal; after TERM and HUP either all or none are
 *     there is no other new file; after KILL one that ends in .part may be left, of the short time
 *     in which an output gets its name, or a folder in which a figure is drawn
 *
 * An OUTPUT of "-" stands for none. Prints what does not hold; exit code 1 then. */
#include <ftw.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "outcome.h"

static const char *shim;
static subject tested;
static int problems;

/* When a run is to end, and how. */
typedef enum moment_kind { AT_TIME, AT_ALLOCATION, AT_CALL, MOMENT_KINDS } moment_kind;

typedef struct moment {
    moment_kind kind;
    long nth;   /* allocation or call; 0: none */
    long us;    /* after the start; -1: never */
    int signal; /* that ends it */
} moment;

static const char *const kind_names[MOMENT_KINDS] = {"time", "memory", "calls"};

/* ---- files ---- */

static int files, parts; /* what is whole, and what has a name that ends in .part, not gone into */

static bool is_part(const char *path)
{
    const size_t length = strlen(path);
    return length > 5 && strcmp(path + length - 5, ".part") == 0;
}

static int count_file(const char *path, const struct stat *about, int type, struct FTW *at)
{
    (void)about;
    (void)at;
    files += type != FTW_D && !is_part(path);
    parts += is_part(path);
    return is_part(path) && type == FTW_D ? FTW_SKIP_SUBTREE : FTW_CONTINUE;
}

static void count_files(void)
{
    const char *scratch = getenv("TMPDIR");
    files = parts = 0;
    if (nftw(".", count_file, 8, FTW_PHYS | FTW_ACTIONRETVAL) != 0 ||
        (scratch != NULL && nftw(scratch, count_file, 8, FTW_PHYS | FTW_ACTIONRETVAL) != 0)) {
        die("nftw");
    }
}

static int remove_part(const char *path, const struct stat *about, int type, struct FTW *at)
{
    (void)about;
    (void)at;
    if (is_part(path) || strstr(path, ".part/") != NULL) {
        (void)(type == FTW_DP ? rmdir(path) : unlink(path));
    }
    return 0;
}

/* ---- runs ---- */

static long microseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (long)now.tv_sec * 1000000L + now.tv_nsec / 1000L;
}

static void start(const moment *m)
{
    char number[32];
    setpgid(0, 0);
    if (m->kind != AT_TIME) {
        setenv("FAULT_KIND", kind_names[m->kind], 1);
        snprintf(number, sizeof number, "%ld", m->nth);
        setenv("FAULT_NTH", number, 1);
        snprintf(number, sizeof number, "%d", m->signal);
        setenv("FAULT_SIGNAL", number, 1);
        setenv("FAULT_COUNT", "../kills.count", 1);
        setenv("LD_PRELOAD", shim, 1);
    }
    outcome_start(&tested);
}

static void wait_and_kill(pid_t child, const moment *m)
{
    if (m->kind == AT_TIME && m->us >= 0) {
        const struct timespec pause = {m->us / 1000000L, m->us % 1000000L * 1000L};
        nanosleep(&pause, NULL);
        kill(child, m->signal);
    }
}

/* What the program started, and a kill left behind, is ended too. */
static void end_group(pid_t child)
{
    const struct timespec pause = {0, 1000000L};
    for (int k = 0; k < 100 && kill(-child, SIGKILL) == 0; k++) {
        nanosleep(&pause, NULL);
    }
}

static outcome run(const moment *m)
{
    int status = 0;
    put_old(&tested);
    const pid_t child = fork();
    if (child == 0) {
        start(m);
    }
    if (child > 0) {
        wait_and_kill(child, m);
    }
    if (child < 0 || waitpid(child, &status, 0) != child) {
        die("fork");
    }
    end_group(child);
    return outcome_take(&tested, status);
}

/* ---- judging ---- */

static bool is_ended_by(const outcome *o, int number)
{
    return WIFSIGNALED(o->status) && WTERMSIG(o->status) == number;
}

static int count_new(const outcome *o, const outcome *good)
{
    int count = 0;
    for (int k = 0; k < tested.outputs; k++) {
        count += is_same(o->output[k], good->output[k]);
    }
    return count;
}

static bool are_old_or_new(const outcome *o, const outcome *good)
{
    bool all = true;
    for (int k = 0; k < tested.outputs; k++) {
        all = all && (is_old(o->output[k]) || is_same(o->output[k], good->output[k]));
    }
    return all;
}

/* What is wrong; NULL for nothing. */
static const char *judge(const outcome *o, const outcome *good, const moment *m, int good_files)
{
    const bool killed = is_ended_by(o, m->signal);
    const int made = count_new(o, good);
    if (!killed && (!WIFEXITED(o->status) || WEXITSTATUS(o->status) != 0)) {
        return "neither ended by the signal nor well";
    }
    if (!are_old_or_new(o, good)) {
        return "an output is neither the old nor the new one";
    }
    if (m->signal == SIGKILL || !killed ? !killed && made < tested.outputs
                                        : made > 0 && made < tested.outputs) {
        return "some outputs are old, some new";
    }
    if (m->signal != SIGKILL && o->text[1].size > 0 && !is_one_line(o->text[1])) {
        return "more than one line on standard error";
    }
    count_files();
    if (files != good_files) {
        return "files are left, or missing";
    }
    return parts > (m->signal == SIGKILL) ? "unfinished files are left" : NULL;
}

static void tell(const moment *m, const outcome *o, const char *problem)
{
    printf("%s %ld, signal %d: %s (status %d)\n", kind_names[m->kind],
           m->kind == AT_TIME ? m->us : m->nth, m->signal, problem, o->status);
    outcome_print(o, &tested);
    problems++;
}

/* ---- moments ---- */

static uint32_t random_state;

static long random_below(long limit)
{
    random_state = random_state * 1664525U + 1013904223U;
    return (long)((double)random_state / 4294967296.0 * (double)(limit > 0 ? limit : 1));
}

/* How much of each kind there is in a run without a signal: microseconds, allocations, calls. */
static long extent[MOMENT_KINDS];

static void measure(outcome *good)
{
    for (int kind = 0; kind < (strcmp(shim, "-") == 0 ? 1 : MOMENT_KINDS); kind++) {
        const moment none = {.kind = (moment_kind)kind, .us = -1};
        const long begin = microseconds();
        outcome o = run(&none);
        if (o.status != 0 || (kind > 0 && count_new(&o, good) < tested.outputs)) {
            tell(&none, &o, "fails without a signal, or is another each time");
            exit(1);
        }
        extent[kind] = microseconds() - begin;
        if (kind > 0) {
            content c = read_content("../kills.count");
            extent[kind] = c.data != NULL ? strtol(c.data, NULL, 10) : 0;
            free(c.data);
            outcome_free(&o, &tested);
        } else {
            *good = o;
        }
    }
}

static moment choose(long k)
{
    static const int signals[] = {SIGKILL, SIGTERM, SIGHUP};
    moment m = {.kind = (moment_kind)(k / 3 % MOMENT_KINDS), .signal = signals[k % 3], .us = -1};
    if (extent[m.kind] == 0) {
        m.kind = AT_TIME;
    }
    if (m.kind == AT_TIME) {
        m.us = random_below(extent[AT_TIME]);
    } else {
        m.nth = 1 + random_below(extent[m.kind]);
    }
    return m;
}

int main(int argc, char **argv)
{
    if (argc < 6) {
        fprintf(stderr, "usage: kills SHIM COUNT SEED OUTPUT[,OUTPUT] PROGRAM ARGUMENT...\n");
        return 2;
    }
    shim = argv[1];
    random_state = (uint32_t)strtoul(argv[3], NULL, 10);
    tested = subject_of(argv[4], argv + 5);
    outcome good;
    measure(&good);
    count_files();
    const int good_files = files;
    int ended = 0;
    for (long k = 0; k < strtol(argv[2], NULL, 10); k++) {
        const moment m = choose(k);
        outcome o = run(&m);
        const char *problem = judge(&o, &good, &m, good_files);
        if (problem != NULL) {
            tell(&m, &o, problem);
        }
        ended += WIFSIGNALED(o.status);
        nftw(".", remove_part, 8, FTW_PHYS | FTW_DEPTH);
        outcome_free(&o, &tested);
    }
    printf("%ld us, %ld allocations, %ld calls: %d ended by a signal\n", extent[AT_TIME],
           extent[AT_ALLOCATION], extent[AT_CALL], ended);
    outcome_free(&good, &tested);
    free(tested.list);
    return problems > 0 ? 1 : 0;
}
