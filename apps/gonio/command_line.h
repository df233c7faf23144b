/* The command line of a command: its options, help, arguments and the checks of values. */
#ifndef GONIO_COMMAND_LINE_H
#define GONIO_COMMAND_LINE_H

#include <gonio/gonio.h>
#include <popt.h>

#include "command.h"
#include "messages.h"

enum { TOOL_MOST_OPTIONS = 32 };

/* The state that every command has. */
typedef struct tool {
    gonio_context *context;
    gonio_instrument *instrument; /* that made the readings (tool_instrument); NULL: not known */
    poptContext options;
    const struct poptOption *table;
    const char
        *defaults[TOOL_MOST_OPTIONS]; /* of the table's strings, which are not popt's copies */
    char *command_line;               /* for the record in output files */
    const char *name;                 /* of the command */
    char *title;                      /* "gonio NAME" */
    tool_messages messages;
} tool;

/* The file or word of --instrument, where a command only takes readings as the instrument gives
 * them; it is read before the command's work. NULL: none. */
extern const char *tool_instrument;
#define TOOL_INSTRUMENT_OPTION                                                                     \
    {                                                                                              \
        "instrument", '\0', POPT_ARG_STRING, &tool_instrument, 0,                                  \
            "Readings were made by this instrument, a file or in-plane, two-arms or four-axis: "   \
            "numbers of which a table does not say what they are, are what it gives",              \
            "INSTRUMENT"                                                                           \
    }

/* The options of every command, to be included with TOOL_OPTIONS at the end of a table. */
extern int tool_threads;
extern int tool_json; /* whether the result is to be printed as JSON */
extern struct poptOption tool_common_options[];
enum { TOOL_HELP = 'h', TOOL_LIST_OPTIONS = 'l' };
#define TOOL_OPTIONS                                                                               \
    {NULL, '\0', POPT_ARG_INCLUDE_TABLE, tool_common_options, 0, "Common options:", NULL},         \
        {"list-options", '\0', POPT_ARG_NONE | POPT_ARGFLAG_DOC_HIDDEN, NULL, TOOL_LIST_OPTIONS,   \
         NULL,           NULL},                                                                    \
        {"help", 'h', POPT_ARG_NONE, NULL, TOOL_HELP, "Show this help", NULL}, POPT_TABLEEND

/* The work of a command, and the usage of its command line. */
typedef struct tool_command_line {
    const struct poptOption *table; /* ends with TOOL_OPTIONS */
    const char *usage;              /* stands behind the command's name in the help */
    const char *text;               /* stands below the options in the help */
    /* The work, once the options are read; returns an exit code. */
    int (*work)(tool *t, void *options);
    void *options; /* where the table puts the values */
} tool_command_line;

/* Runs a command: reads its options, does its work unless help is asked for, and frees everything.
 * Returns the exit code. --list-options, which the help does not show, prints a line for each
 * option: its names and, if it takes a value, the value's name in the help. */
int tool_run(int argc, const char **argv, const tool_command_line *line);

/* The arguments that are not options. */
const char **tool_arguments(const tool *t, size_t *count);

/* Prints an error in the command line. Returns false, so that checks can end with
 * `return tool_refuse(...)`. The exit code is then EXIT_USAGE. */
bool tool_refuse(const tool *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Reads the instrument that made the readings, t->instrument. Errors: gonio_instrument_read's. */
gonio_status tool_read_instrument(tool *t, const char *path);

/* The exit code of a status: 0, 1 or 2. */
int tool_exit_code(gonio_status status);

/* Checks of the command line. Each returns true, or false after an error message. */

/* Checks that an output is given and differs from the inputs (NULL: none) and the instrument. If it
 * is standard output, results are printed to standard error from now on (tool_results). */
bool tool_check_output(const tool *t, const char *output, const char *const *inputs, size_t count);

/* Whether two outputs are one file, by whatever names, and not a device. */
bool tool_is_one_output(const char *a, const char *b);

/* Checks that an integer is at least `least`. */
bool tool_check_count(const tool *t, const char *option, long value, long least);

/* Checks that a number is not negative. */
bool tool_check_not_negative(const tool *t, const char *option, double value);

/* Finds a word in a list that ends with NULL. *choice: its place. */
bool tool_check_word(const tool *t, const char *option, const char *text, const char *const *words,
                     int *choice);

#endif
