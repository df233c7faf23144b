/* Several gonio processes that work together when started by mpirun; one on its own otherwise. */
#ifndef GONIO_PROCESSES_H
#define GONIO_PROCESSES_H

#include <gonio/report.h>

/* Joins the team that mpirun (Open MPI, or another MPI with PMI or PMIx) has started, or makes a
 * team of one. False, after a message, if that cannot be. Must be called once, from main's thread;
 * only that may use the team. A rank other than 0 should print nothing but errors. */
bool processes_begin(gonio_team *team, const char *command);

/* Leaves the team with this process's exit code, which it returns. A code other than 0 ends the
 * whole team with exit code 1, lest the others wait for this one forever. */
int processes_end(int code);

#endif
