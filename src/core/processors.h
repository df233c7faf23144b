/* How many processors this process is given: the default number of threads. */
#ifndef GONIO_PROCESSORS_H
#define GONIO_PROCESSORS_H

/* The processors that the process may run on, at most the time that its control groups give it,
 * rounded up: a container with 1.5 of 64 processors has 2. Also at most one for each 64 MiB of
 * memory that they give, twice what a thread of the default method needs. At least 1. Found once,
 * at the first call; any thread may call. */
int gonio_i_processors(void);

typedef enum gonio_i_group_resource {
    GONIO_I_GROUP_PROCESSORS, /* 1.5 is three seconds of two */
    GONIO_I_GROUP_MEMORY      /* bytes */
} gonio_i_group_resource;

/* The least limit of the control groups that `groups` names, and of those above them; 0 if there is
 * none. `groups` is a file as /proc/self/cgroup, `root` a folder as /sys/fs/cgroup: cpu.max and
 * memory.max of version 2, cpu.cfs_quota_us with cpu.cfs_period_us and memory.limit_in_bytes of
 * version 1. Where a container does not see the folder of its group, the folder above that it sees
 * is its own. */
double gonio_i_group_limit(gonio_i_group_resource which, const char *groups, const char *root);

#endif
