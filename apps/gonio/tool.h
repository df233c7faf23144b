/* What the commands share: options, messages, progress, exit codes. */
#ifndef GONIO_TOOL_H
#define GONIO_TOOL_H

#include <gonio/gonio.h>
#include <jansson.h>
#include <popt.h>

enum { EXIT_DATA = 1, EXIT_USAGE = 2 }; /* 0 is success */

/* One command of the program: to add one, write cmd_NAME.c and add a line to the table in main.c.
 */
typedef struct tool_command {
    const char *name;
    const char *summary;
    int (*run)(int argc, const char **argv); /* argv[0] is the command's name; an exit code */
} tool_command;

/* The commands, each in its file. */
int cmd_info(int argc, const char **argv);
int cmd_convert(int argc, const char **argv);
int cmd_learn(int argc, const char **argv);
int cmd_plan(int argc, const char **argv);
int cmd_next(int argc, const char **argv);
int cmd_measure(int argc, const char **argv);
int cmd_reconstruct(int argc, const char **argv);
int cmd_compare(int argc, const char **argv);
int cmd_report(int argc, const char **argv);
int cmd_render(int argc, const char **argv);
int cmd_reproduce(int argc, const char **argv);
int cmd_demo(int argc, const char **argv);

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
    double progress_start;            /* seconds */
    double progress_shown;
    bool progress_visible;
} tool;

/* The options of every command, to be included with TOOL_OPTIONS at the end of a table. */
extern int tool_threads;
extern int tool_quiet;
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

/* A BASIS argument, or with NULL the basis of the built-in materials, made on first use and kept in
 * the cache folder. */
gonio_status tool_basis(tool *t, const char *path, const char *method, gonio_basis **basis);

/* The built-in basis's path, made if need be; to be released with free(). */
gonio_status tool_builtin_basis(tool *t, bool paper, char **path);

/* Says on standard error what would explain readings better (gonio_reconstruction.suspicion), and
 * nothing for NULL. path: what is concerned. */
void tool_note_suspicion(const char *command, const char *path, const char *suspicion);

/* What makes a noun one of `count`: "s", or nothing for one. */
const char *tool_plural(size_t count);

/* Whether a file is a plan or readings, by its content: text. */
bool tool_is_readings(const char *path);

/* Where albedos are taken: theta_i in degrees. */
enum { TOOL_INCIDENCES = 6 };
extern const double tool_incidence_deg[TOOL_INCIDENCES];

/* The albedos there; returns the index of the incidence with the largest of any channel, which goes
 * to *largest. */
int tool_albedos(const gonio_table *table, double albedo[TOOL_INCIDENCES][GONIO_CHANNELS],
                 double *largest);

/* A JSON number; null if it is infinite or NaN, which JSON lacks. */
json_t *tool_json_number(double value);

/* Prints JSON to standard output and releases it; NULL, from a json_pack that failed, is an error.
 */
int tool_print_json(const tool *t, json_t *json);

#endif
