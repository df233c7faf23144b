/* The command line of a command: its options, help, arguments and the checks of values. */
#ifndef GONIO_COMMAND_LINE_H
#define GONIO_COMMAND_LINE_H

#include <gonio/gonio.h>
#include <popt.h>

#include "command.h"
#include "messages.h"

enum { TOOL_MOST_OPTIONS = 32 };

/* What every command has. */
typedef struct tool {
    gonio_context *context;
    poptContext options;
    const struct poptOption *table;
    const char
        *defaults[TOOL_MOST_OPTIONS]; /* of the table's strings, which are not popt's copies */
    char *command_line;               /* for the record in output files */
    const char *name;                 /* of the command */
    char *title;                      /* "gonio NAME" */
    tool_messages messages;
} tool;

/* The options of every command, to be included with TOOL_OPTIONS at the end of a table. */
extern int tool_threads;
extern struct poptOption tool_common_options[];
#define TOOL_OPTIONS                                                                               \
    {NULL, '\0', POPT_ARG_INCLUDE_TABLE, tool_common_options, 0, "Common options:", NULL},         \
        {"help", 'h', POPT_ARG_NONE, NULL, 'h', "Show this help", NULL}, POPT_TABLEEND

/* Parses the options. `usage` stands behind the command's name in the help, `text` below it.
 * Returns an exit code, or -1 to go on. The tool must be ended with tool_end in any case. */
int tool_begin(tool *t, int argc, const char **argv, const struct poptOption *table,
               const char *usage, const char *text);
void tool_end(tool *t);

/* The arguments that are not options. */
const char **tool_arguments(const tool *t, size_t *count);

/* Complains about the command line; returns EXIT_USAGE. */
int tool_usage_error(const tool *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The exit code of a status: 0, 1 or 2. */
int tool_exit_code(gonio_status status);

/* Refuses an output that is one of the inputs; returns 0 or EXIT_USAGE. */
int tool_check_output(const tool *t, const char *output, const char *const *inputs, size_t count);

/* A count given by the user: an integer from `least` on; EXIT_USAGE otherwise, 0 if fine. */
int tool_check_count(const tool *t, const char *option, long value, long least);

#endif
