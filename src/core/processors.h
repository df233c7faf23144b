/* How many processors this process is given: the default number of threads. */
#ifndef GONIO_PROCESSORS_H
#define GONIO_PROCESSORS_H

/* The processors that the process may run on, at most the time that its control groups give it,
 * rounded up: a container with 1.5 of 64 processors has 2. At least 1. Found once, at the first
 * call; any thread may call. */
int gonio_i_processors(void);

/* The least share of processor time of the control groups that `groups` names, and of those above
 * them: 1.5 is three seconds of two. 0 if there is no limit. `groups` is a file as
 * /proc/self/cgroup, `root` a folder as /sys/fs/cgroup: cpu.max of version 2, cpu.cfs_quota_us and
 * cpu.cfs_period_us of version 1. Where a container does not see the folder of its group, the
 * folder above that it sees is its own. */
double gonio_i_processor_share(const char *groups, const char *root);

#endif
