/* The commands of the program, each in a file cmd_NAME.c, and their exit codes. */
#ifndef GONIO_COMMAND_H
#define GONIO_COMMAND_H

enum { EXIT_DATA = 1, EXIT_USAGE = 2 }; /* 0 is success */

/* One command of the program: to add one, write cmd_NAME.c and add a line to the list below. */
typedef struct tool_command {
    const char *name;
    const char *summary;
    int (*run)(int argc, const char **argv); /* argv[0] is the command's name; an exit code */
} tool_command;

/* The commands, in the order of the help. */
#define TOOL_COMMANDS(COMMAND)                                                                     \
    COMMAND(info, "what a file is: materials, bases, plans, readings, meshes, images")             \
    COMMAND(convert, "materials and readings to other formats")                                    \
    COMMAND(learn, "a basis from measured materials")                                              \
    COMMAND(plan, "where to measure")                                                              \
    COMMAND(measure, "a simulated instrument reads a known material")                              \
    COMMAND(reconstruct, "the whole BRDF from a few readings")                                     \
    COMMAND(next, "where to measure next, given what was read")                                    \
    COMMAND(compare, "how far BRDFs are from a reference")                                         \
    COMMAND(report, "a page for a browser: spheres, directions, lobes, errors")                    \
    COMMAND(render, "a material on a sphere or a mesh, comparison pictures")                       \
    COMMAND(reproduce, "the paper's experiments on your materials")                                \
    COMMAND(benchmark, "how well BRDFs are completed from n readings")                             \
    COMMAND(demo, "the whole chain on a built-in material")

#define TOOL_DECLARE_COMMAND(name, summary) int cmd_##name(int argc, const char **argv);
TOOL_COMMANDS(TOOL_DECLARE_COMMAND)

#endif
