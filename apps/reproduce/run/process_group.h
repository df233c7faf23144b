/* Several gonio processes that work together when started by mpirun; one on its own otherwise. */
#ifndef GONIO_REPRODUCE_PROCESS_GROUP_H
#define GONIO_REPRODUCE_PROCESS_GROUP_H

#include <stdbool.h>

/* Several processes, perhaps on several machines, that do one piece of work together. The library
 * does not know how they talk (MPI, say): the program that starts them tells it here. */
typedef struct process_group {
    int rank; /* which of them this process is: 0 .. size - 1 */
    int size; /* 1 for a process on its own */
    /* Waits until all have come here; false if that failed. May be NULL if size is 1. */
    bool (*barrier)(void *user);
    void *user; /* handed to the barrier */
} process_group;

/* Joins the group that mpirun (Open MPI, or another MPI with PMI or PMIx) has started, or makes a
 * group of one. False, after a message, if that cannot be. Must be called once, from main's thread;
 * only that may use the group. A rank other than 0 should print nothing but errors. */
bool process_group_join(process_group *group, const char *command);

/* Leaves the group with this process's exit code, which it returns. A code other than 0 ends the
 * whole group with exit code 1, lest the others wait for this one forever. */
int process_group_leave(int code);

#endif
