/* Several processes, perhaps on several machines, that do one piece of work together. The library
 * does not know how they talk (MPI, say): the program that starts them tells it here. */
#ifndef GONIO_REPORT_TEAM_H
#define GONIO_REPORT_TEAM_H

#include <stdbool.h>

typedef struct gonio_team {
    int rank; /* which of them this process is: 0 .. size - 1 */
    int size; /* 1 for a process on its own */
    /* Waits until all have come here; false if that failed. May be NULL if size is 1. */
    bool (*barrier)(void *user);
    void *user; /* handed to the barrier */
} gonio_team;

#endif
