/* The command line of a command: see command_line.h. */
#include "command_line.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int tool_threads = 0;
int tool_json = 0;
const char *tool_instrument;

struct poptOption tool_common_options[] = {
    {"threads", '\0', POPT_ARG_INT, &tool_threads, 0, "Use at most N threads (default: all)", "N"},
    {"quiet", 'q', POPT_ARG_NONE, &tool_quiet, 0, "Only errors, no notes and no progress", NULL},
    {"json", '\0', POPT_ARG_NONE, &tool_json, 0, "Print the result as JSON", NULL},
    POPT_TABLEEND};

static bool is_plain(const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "-_./:=,+%@";
    return *word != '\0' && word[strspn(word, plain)] == '\0';
}

/* Appends a word in quotes as the shell has them, on one line. Returns the end. */
static char *quote(const char *word, char *end)
{
    *end++ = '\'';
    for (const char *c = word; *c != '\0'; c++) {
        if (*c == '\'') {
            end = stpcpy(end, "'\\''");
        } else {
            *end++ = (char)(*c == '\n' || *c == '\r' ? ' ' : *c);
        }
    }
    *end++ = '\'';
    return end;
}

/* The command line as typed, quoted where the shell would need it. NULL: out of memory. */
static char *join(int argc, const char **argv)
{
    enum { QUOTED = 4 /* bytes that a quoted one takes */ };
    size_t room = sizeof "gonio";
    for (int k = 0; k < argc; k++) {
        room += QUOTED * strlen(argv[k]) + sizeof " ''";
    }
    char *text = malloc(room);
    char *end = text != NULL ? stpcpy(text, "gonio") : NULL;
    for (int k = 0; end != NULL && k < argc; k++) {
        *end++ = ' ';
        end = is_plain(argv[k]) ? stpcpy(end, argv[k]) : quote(argv[k], end);
    }
    if (end != NULL) {
        *end = '\0';
    }
    return text;
}

bool tool_refuse(const tool *t, const char *format, ...)
{
    va_list arguments;
    fprintf(stderr, "gonio %s: ", t->name);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fprintf(stderr, " (see gonio %s -h)\n", t->name);
    return false;
}

static bool is_end(const struct poptOption *option)
{
    return option->longName == NULL && option->shortName == '\0' && option->arg == NULL;
}

/* Prints a line for each option: "-n --number N". */
static void list_options(const struct poptOption *table)
{
    for (const struct poptOption *option = table; !is_end(option); option++) {
        if ((option->argInfo & POPT_ARG_MASK) == POPT_ARG_INCLUDE_TABLE) {
            list_options(option->arg);
        } else if ((option->argInfo & POPT_ARGFLAG_DOC_HIDDEN) == 0) {
            const char *value = option->argDescrip;
            if (option->shortName != '\0') {
                printf("-%c ", option->shortName);
            }
            printf("--%s%s%s\n", option->longName, value != NULL ? " " : "",
                   value != NULL ? value : "");
        }
    }
}

/* Reads the options. Returns an exit code, or -1 to go on. */
static int parse(tool *t, const tool_command_line *line)
{
    int code = 0;
    while ((code = poptGetNextOpt(t->options)) > 0) {
        if (code == TOOL_HELP) {
            poptPrintHelp(t->options, stdout, 0);
            printf("\n%s\n", line->text);
            return 0;
        }
        if (code == TOOL_LIST_OPTIONS) {
            list_options(t->table);
            return 0;
        }
    }
    if (code < -1) {
        tool_refuse(t, "%s: %s", poptBadOption(t->options, POPT_BADOPTION_NOALIAS),
                    poptStrerror(code));
        return EXIT_USAGE;
    }
    return tool_check_not_negative(t, "--threads", tool_threads) ? -1 : EXIT_USAGE;
}

/* Whether an option's value is a string. popt gives a copy, which the caller frees. */
static bool holds_string(const struct poptOption *option)
{
    return (option->argInfo & POPT_ARG_MASK) == POPT_ARG_STRING && option->arg != NULL;
}

static void remember_defaults(tool *t)
{
    for (int k = 0; k < TOOL_MOST_OPTIONS && !is_end(&t->table[k]); k++) {
        t->defaults[k] = holds_string(&t->table[k]) ? *(const char **)t->table[k].arg : NULL;
    }
}

static void free_strings(tool *t)
{
    for (int k = 0; k < TOOL_MOST_OPTIONS && !is_end(&t->table[k]); k++) {
        if (holds_string(&t->table[k])) {
            char **value = t->table[k].arg;
            if (*value != t->defaults[k]) {
                free(*value);
                *value = NULL;
            }
        }
    }
}

gonio_status tool_read_instrument(tool *t, const char *path)
{
    return gonio_instrument_read(t->context, path, &t->instrument);
}

/* Prepares a command. Returns an exit code, or -1 to go on. */
static int begin(tool *t, int argc, const char **argv, const tool_command_line *line)
{
    *t = (tool){.table = line->table,
                .name = argv[0],
                .messages.command = argv[0],
                .command_line = join(argc, argv)};
    remember_defaults(t);
    if (asprintf(&t->title, "gonio %s", argv[0]) < 0) {
        t->title = NULL;
    }
    argv[0] = t->title != NULL ? t->title : argv[0]; /* the program's name in the help */
    t->options = t->title != NULL ? poptGetContext(t->title, argc, argv, t->table, 0) : NULL;
    if (t->options == NULL || t->command_line == NULL) {
        tool_say(&t->messages, GONIO_MESSAGE_ERROR, "out of memory");
        return EXIT_DATA;
    }
    poptSetOtherOptionHelp(t->options, line->usage);
    const int code = parse(t, line);
    if (code >= 0) {
        return code;
    }
    const gonio_context_options options = {.size = sizeof options,
                                           .message = tool_on_message,
                                           .progress = tool_on_progress,
                                           .user = &t->messages,
                                           .threads = tool_threads};
    tool_catch_signals();
    gonio_status status = gonio_context_create(&t->context, &options);
    if (status == GONIO_OK && tool_instrument != NULL) {
        status = tool_read_instrument(t, tool_instrument);
    }
    return status == GONIO_OK ? -1 : tool_exit_code(status);
}

static void end(tool *t)
{
    tool_clear_progress(&t->messages);
    gonio_instrument_free(&t->instrument);
    gonio_context_free(&t->context);
    if (t->options != NULL) {
        poptFreeContext(t->options);
    }
    free_strings(t);
    free(t->title);
    free(t->command_line);
}

/* Whether a command ended by GONIO_ERROR_MEMORY. The library says so itself; allocations of the
 * program's own do not. */
static bool ran_out_of_memory;

int tool_run(int argc, const char **argv, const tool_command_line *line)
{
    tool t;
    tool_keep_results_off_standard_output(false);
    ran_out_of_memory = false;
    int code = begin(&t, argc, argv, line);
    if (code < 0) {
        code = line->work(&t, line->options);
    }
    if (ran_out_of_memory && !t.messages.any_error) {
        tool_say(&t.messages, GONIO_MESSAGE_ERROR, "out of memory");
    }
    end(&t);
    return code;
}

const char **tool_arguments(const tool *t, size_t *count)
{
    const char **arguments = poptGetArgs(t->options);
    *count = 0;
    while (arguments != NULL && arguments[*count] != NULL) {
        (*count)++;
    }
    return arguments;
}

int tool_exit_code(gonio_status status)
{
    ran_out_of_memory = ran_out_of_memory || status == GONIO_ERROR_MEMORY;
    return status == GONIO_OK ? 0 : status == GONIO_ERROR_ARGUMENT ? EXIT_USAGE : EXIT_DATA;
}

/* Whether a file is the target of standard output. A device such as /dev/null does not count. */
static bool is_standard_output(const char *path)
{
    struct stat file;
    struct stat standard;
    if (strcmp(path, "-") == 0) {
        return true;
    }
    return stat(path, &file) == 0 && fstat(STDOUT_FILENO, &standard) == 0 &&
           file.st_dev == standard.st_dev && file.st_ino == standard.st_ino &&
           (!S_ISCHR(file.st_mode) || isatty(STDOUT_FILENO));
}

/* Whether two paths that are not there name one file of one folder. */
static bool is_same_place(const char *a, const char *b)
{
    struct stat first;
    struct stat second;
    const char *name_a = strrchr(a, '/') != NULL ? strrchr(a, '/') + 1 : a;
    const char *name_b = strrchr(b, '/') != NULL ? strrchr(b, '/') + 1 : b;
    char *folder_a = name_a > a ? strndup(a, (size_t)(name_a - a)) : strdup(".");
    char *folder_b = name_b > b ? strndup(b, (size_t)(name_b - b)) : strdup(".");
    const bool same = folder_a != NULL && folder_b != NULL && strcmp(name_a, name_b) == 0 &&
                      stat(folder_a, &first) == 0 && stat(folder_b, &second) == 0 &&
                      first.st_dev == second.st_dev && first.st_ino == second.st_ino;
    free(folder_a);
    free(folder_b);
    return same;
}

/* Whether two paths name one file, by whatever name or link. */
static bool is_same_file(const char *a, const char *b)
{
    struct stat first;
    struct stat second;
    const bool there = stat(a, &first) == 0;
    if (there != (stat(b, &second) == 0)) {
        return false;
    }
    return there ? first.st_dev == second.st_dev && first.st_ino == second.st_ino
                 : is_same_place(a, b);
}

static bool is_regular(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

static bool is_overwritten(const char *input, const char *output)
{
    return input != NULL && is_regular(input) && is_same_file(input, output);
}

bool tool_check_output(const tool *t, const char *output, const char *const *inputs, size_t count)
{
    if (output == NULL || *output == '\0') {
        return tool_refuse(t, "no output: give -o FILE");
    }
    bool overwritten = is_overwritten(tool_instrument, output);
    for (size_t k = 0; k < count; k++) {
        overwritten = overwritten || is_overwritten(inputs[k], output);
    }
    if (overwritten) {
        return tool_refuse(t, "%s is an input: give another name for the output", output);
    }
    if (is_standard_output(output)) {
        tool_keep_results_off_standard_output(true);
    }
    return true;
}

bool tool_is_one_output(const char *a, const char *b)
{
    struct stat status;
    const bool device = stat(a, &status) == 0 && !S_ISREG(status.st_mode);
    return strcmp(a, b) == 0 || (!device && is_same_file(a, b));
}

bool tool_check_count(const tool *t, const char *option, long value, long least)
{
    return value >= least ||
           tool_refuse(t, "%s: %ld is too small, at least %ld", option, value, least);
}

bool tool_check_not_negative(const tool *t, const char *option, double value)
{
    return value >= 0.0 || tool_refuse(t, "%s cannot be negative", option);
}

bool tool_check_word(const tool *t, const char *option, const char *text, const char *const *words,
                     int *choice)
{
    char list[128] = "";
    for (int k = 0; words[k] != NULL; k++) {
        if (strcmp(text, words[k]) == 0) {
            *choice = k;
            return true;
        }
        strncat(list, k > 0 ? ", " : "", sizeof list - strlen(list) - 1);
        strncat(list, words[k], sizeof list - strlen(list) - 1);
    }
    return tool_refuse(t, "%s: '%s' is none of %s", option, text, list);
}
