/* Messages, the progress bar and interrupts. */
#ifndef GONIO_MESSAGES_H
#define GONIO_MESSAGES_H

#include <gonio/context.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Interrupts end the work at its next progress report. A closed pipe and a full disk are errors of
 * writing. */
void tool_catch_signals(void);

/* Ends the program by the signal that has interrupted it, so that those who started it know. */
void tool_end_if_interrupted(void);

/* Whether an interrupt asks to end the work. */
bool tool_is_interrupted(void);

/* Whether only errors are printed. */
extern int tool_quiet;

/* The stream of a command's results: standard output, or standard error if an output file is
 * standard output, so that results do not get into the file. */
FILE *tool_results(void);
void tool_keep_results_off_standard_output(bool kept);

/* The state of a command's messages on standard error. */
typedef struct tool_messages {
    const char *command;   /* its name */
    double progress_start; /* seconds */
    double progress_shown;
    bool progress_visible;
    bool any_error; /* was printed */
} tool_messages;

/* Prints a line on standard error. With --quiet only errors are printed. */
void tool_say(tool_messages *m, gonio_message_level level, const char *text);

/* The callbacks of a context whose user is a tool_messages. */
void tool_on_message(void *user, gonio_message_level level, const char *text);
int tool_on_progress(void *user, const char *task, double fraction);

/* Removes the progress bar from the terminal. */
void tool_clear_progress(tool_messages *m);

/* The plural ending for `count`: "s", or "" for 1. */
const char *tool_plural(size_t count);

#endif
