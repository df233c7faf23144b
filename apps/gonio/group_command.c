/* Commands whose work several processes share: see group_command.h. */
#include "group_command.h"

int tool_run_in_group(tool *t, void *work)
{
    const tool_group_work *w = work;
    process_group group;
    if (!process_group_join(&group, t->name)) {
        return EXIT_DATA;
    }
    tool_quiet = tool_quiet || group.rank != 0;
    return process_group_leave(w->run(t, w->options, &group));
}
