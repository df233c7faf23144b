/* The program gonio: a table of commands. */
#include "command.h"
#include "json_output.h"
#include "library_settings.h"
#include "messages.h"

#include <gonio/gonio.h>

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define ROW(name, parallel, summary) {#name, parallel, summary, cmd_##name},
static const tool_command commands[] = {TOOL_COMMANDS(ROW)};

enum { COMMANDS = sizeof commands / sizeof *commands, NAME_WIDTH = 14 };

/* Whether a word of the command line is a name of the table, which has `_` for hyphens. */
static bool is_name(const char *word, const char *name)
{
    while (*word != '\0' && (*word == *name || (*word == '-' && *name == '_'))) {
        word++;
        name++;
    }
    return *word == '\0' && *name == '\0';
}

static void print_name(FILE *stream, const char *name)
{
    fputs("  ", stream);
    int width = 0;
    for (; name[width] != '\0'; width++) {
        fputc(name[width] == '_' ? '-' : name[width], stream);
    }
    fprintf(stream, "%*s", NAME_WIDTH - width, "");
}

static void print_help(FILE *stream)
{
    fputs("gonio plans BRDF measurements and completes them.\n\n"
          "Usage: gonio COMMAND ...\n\nCommands:\n",
          stream);
    for (int k = 0; k < COMMANDS; k++) {
        print_name(stream, commands[k].name);
        fprintf(stream, " %s\n", commands[k].summary);
    }
    fputs("\n'gonio COMMAND -h' explains a command. 'gonio demo' runs them in turn.\n"
          "gonio --version prints the version.\n",
          stream);
}

/* Flushes the output, so that a full disk makes the command fail. */
static int finish_output(const char *name, int code)
{
    const bool flushed = fflush(stdout) == 0;
    if (flushed && ferror(stdout) == 0) {
        return code;
    }
    if (flushed || errno != EPIPE) { /* a closed pipe needs no message */
        fprintf(stderr, "gonio %s: cannot write to standard output: %s\n", name,
                flushed ? "some of it was lost" : strerror(errno));
    }
    return code != 0 ? code : EXIT_DATA;
}

/* The command of this name; NULL if there is none. */
static const tool_command *find_command(const char *name)
{
    for (int k = 0; k < COMMANDS; k++) {
        if (is_name(name, commands[k].name)) {
            return &commands[k];
        }
    }
    return NULL;
}

static int run_command(const char *name, int argc, const char **argv)
{
    const tool_command *command = find_command(name);
    if (command != NULL) {
        const int code = finish_output(name, command->run(argc, argv));
        tool_end_if_interrupted();
        return code;
    }
    fprintf(stderr, "gonio: no command is called '%s'\n\n", name);
    print_help(stderr);
    return EXIT_USAGE;
}

int main(int argc, char **argv)
{
    const char *name = argc > 1 ? argv[1] : "";
    if (strcmp(name, "--version") == 0 || strcmp(name, "-V") == 0) {
        printf("gonio %s\n", gonio_version());
        return 0;
    }
    if (strcmp(name, "help") == 0 && argc > 2) {
        const char *words[] = {argv[2], "-h", NULL};
        return run_command(argv[2], 2, words);
    }
    if (strcmp(name, "-h") == 0 || strcmp(name, "--help") == 0 || strcmp(name, "help") == 0) {
        print_help(stdout);
        return 0;
    }
    if (argc < 2) {
        print_help(stderr);
        return EXIT_USAGE;
    }
    const tool_command *command = find_command(name);
    library_settings_choose(argv, command != NULL && command->parallel);
    tool_watch_json_memory();
    return run_command(name, argc - 1, (const char **)(argv + 1));
}
