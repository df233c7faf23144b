/* Commands whose work several processes share when mpirun starts them. */
#ifndef GONIO_GROUP_COMMAND_H
#define GONIO_GROUP_COMMAND_H

#include "command_line.h"
#include "run/process_group.h"

/* The work of such a command. All ranks do the same. */
typedef struct tool_group_work {
    int (*run)(tool *t, const void *options, const process_group *group); /* returns an exit code */
    const void *options;
} tool_group_work;

/* The work and the options of a tool_command_line: `work` is a tool_group_work. Joins the group,
 * runs the work, and leaves the group. Only rank 0 prints what is not an error. */
int tool_run_in_group(tool *t, void *work);

#endif
