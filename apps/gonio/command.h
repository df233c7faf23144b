/* The commands of the program, each in a file cmd_NAME.c, and their exit codes. */
#ifndef GONIO_COMMAND_H
#define GONIO_COMMAND_H

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

#endif
