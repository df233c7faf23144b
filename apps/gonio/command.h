/* The commands of the program, each in a file cmd_NAME.c, and their exit codes. */
#ifndef GONIO_COMMAND_H
#define GONIO_COMMAND_H

#include <stdbool.h>

enum { EXIT_DATA = 1, EXIT_USAGE = 2 }; /* 0 is success */

/* One command of the program: to add one, write cmd_NAME.c and add a line to the list below. */
typedef struct tool_command {
    const char *name;
    bool parallel; /* computes on several threads for longer than it takes to start it */
    const char *summary;
    int (*run)(int argc, const char **argv); /* argv[0] is the command's name; an exit code */
} tool_command;

/* The commands, in the order of the help: name, parallel, summary. A command's name has hyphens
 * where these have `_`. */
#define TOOL_COMMANDS(COMMAND)                                                                     \
    COMMAND(info, false, "describe materials, bases, plans, readings, meshes and images")          \
    COMMAND(convert, false, "convert materials and readings to other formats")                     \
    COMMAND(learn, true, "learn a basis from measured materials")                                  \
    COMMAND(check, false, "describe an instrument and draw what it reaches")                       \
    COMMAND(plan, true, "plan where to measure")                                                   \
    COMMAND(measure, false, "simulate an instrument, or follow a run on a real one")               \
    COMMAND(reconstruct, true, "reconstruct the whole BRDF from a few readings")                   \
    COMMAND(next, true, "plan where to measure next, given the readings so far")                   \
    COMMAND(check_isotropy, false, "say how certain it is that a sample is isotropic")             \
    COMMAND(compare, false, "compute errors of BRDFs and readings relative to a reference")        \
    COMMAND(report, true, "write a page for a browser: spheres, directions, lobes, errors")        \
    COMMAND(render, true, "render a material on a sphere or a mesh, or a comparison picture")      \
    COMMAND(reproduce, true, "run the paper's experiments on your materials")                      \
    COMMAND(benchmark, true, "compare how well methods complete BRDFs from n readings")            \
    COMMAND(demo, false, "run all steps on a built-in material")

#define TOOL_DECLARE_COMMAND(name, parallel, summary) int cmd_##name(int argc, const char **argv);
TOOL_COMMANDS(TOOL_DECLARE_COMMAND)

#endif
