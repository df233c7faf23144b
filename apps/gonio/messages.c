/* Messages, the progress bar and interrupts: see messages.h. */
#include "messages.h"

#include "duration.h"

#include <signal.h>
#include <stdio.h>
#include <unistd.h>

int tool_quiet = 0;

static bool standard_output_is_taken = false;

FILE *tool_results(void)
{
    return standard_output_is_taken ? stderr : stdout;
}

void tool_keep_results_off_standard_output(bool kept)
{
    standard_output_is_taken = kept;
}

static const int ends[] = {SIGINT, SIGTERM, SIGHUP};

enum { ENDS = sizeof ends / sizeof *ends };

/* The signal of the first interrupt. The work then ends at its next progress report and cleans up.
 */
static volatile sig_atomic_t interrupted = 0;

static void on_interrupt(int signal_number)
{
    interrupted = signal_number;
    for (int k = 0; k < ENDS; k++) {
        signal(ends[k], SIG_DFL);
    }
}

/* Calls that wait, as for the writer of a pipe, end with EINTR. What nohup has turned off stays so.
 */
void tool_catch_signals(void)
{
    const struct sigaction action = {.sa_handler = on_interrupt};
    struct sigaction before;
    for (int k = 0; k < ENDS; k++) {
        if (ends[k] != SIGHUP || sigaction(SIGHUP, NULL, &before) != 0 ||
            before.sa_handler != SIG_IGN) {
            sigaction(ends[k], &action, NULL);
        }
    }
    signal(SIGXFSZ, SIG_IGN); /* a file-size limit becomes an error like a full disk */
    signal(SIGPIPE, SIG_IGN);
}

void tool_end_if_interrupted(void)
{
    if (interrupted != 0) {
        signal(interrupted, SIG_DFL);
        raise(interrupted);
    }
}

bool tool_is_interrupted(void)
{
    return interrupted != 0;
}

void tool_clear_progress(tool_messages *m)
{
    if (m->progress_visible) {
        fputs("\r\033[K", stderr);
        m->progress_visible = false;
    }
}

void tool_say(tool_messages *m, gonio_message_level level, const char *text)
{
    if (level != GONIO_MESSAGE_ERROR && tool_quiet) {
        return;
    }
    tool_clear_progress(m);
    m->any_error = m->any_error || level == GONIO_MESSAGE_ERROR;
    const char *kind = level == GONIO_MESSAGE_ERROR     ? ""
                       : level == GONIO_MESSAGE_WARNING ? "warning: "
                                                        : "note: ";
    fprintf(stderr, "gonio %s: %s%s\n", m->command, kind, text);
}

void tool_on_message(void *user, gonio_message_level level, const char *text)
{
    tool_say(user, level, text);
}

/* Prints the remaining time, in minutes if it is long. */
static void draw_time_left(double seconds)
{
    if (seconds >= 120.0) {
        fprintf(stderr, ", %.0f min left", seconds / 60.0);
    } else {
        fprintf(stderr, ", %.0f s left", seconds);
    }
}

static void draw_progress(const char *task, double fraction, double elapsed)
{
    enum { WIDTH = 30 };
    char bar[WIDTH + 1];
    const int full = (int)(fraction * WIDTH);
    for (int k = 0; k < WIDTH; k++) {
        bar[k] = k < full ? '#' : '.';
    }
    bar[WIDTH] = '\0';
    fprintf(stderr, "\r\033[K%s [%s] %3.0f%% %.0f s", task, bar, 100.0 * fraction, elapsed);
    if (fraction > 0.02 && elapsed > 5.0) {
        draw_time_left(elapsed * (1.0 - fraction) / fraction);
    }
    fflush(stderr);
}

/* Draws a bar on a terminal, ten times a second, once the work has taken a second. */
int tool_on_progress(void *user, const char *task, double fraction)
{
    tool_messages *m = user;
    const double time = tool_seconds();
    if (m->progress_start == 0.0) {
        m->progress_start = time;
    }
    if (fraction >= 1.0) {
        tool_clear_progress(m);
        m->progress_start = 0.0;
    } else if (!tool_quiet && time - m->progress_start > 1.0 && time - m->progress_shown > 0.1 &&
               isatty(STDERR_FILENO)) {
        draw_progress(task, fraction, time - m->progress_start);
        m->progress_shown = time;
        m->progress_visible = true;
    }
    return interrupted != 0;
}

const char *tool_plural(size_t count)
{
    return count == 1 ? "" : "s";
}
