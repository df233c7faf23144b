/* Several processes that work together, by MPI: see process_group.h. */
#include "process_group.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#ifdef HAVE_MPI
#include "mpi_library.h"
#endif

/* Whether an MPI launcher has started this process; without one MPI need not even be asked. */
static bool is_launched(void)
{
    static const char *const signs[] = {"OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMI_SIZE",
                                        "PMIX_RANK"};
    for (size_t k = 0; k < sizeof signs / sizeof *signs; k++) {
        if (getenv(signs[k]) != NULL) {
            return true;
        }
    }
    return false;
}

#ifdef HAVE_MPI

/* Looks a hundred times a second: MPI's own barrier would keep a processor busy. */
static bool wait_for_all(void *user)
{
    (void)user;
    const struct timespec pause = {.tv_nsec = 10 * 1000 * 1000};
    MPI_Request request;
    int there = 0;
    if (MPI_Ibarrier(MPI_COMM_WORLD, &request) != MPI_SUCCESS) {
        return false;
    }
    for (;;) {
        if (MPI_Test(&request, &there, MPI_STATUS_IGNORE) != MPI_SUCCESS) {
            return false;
        }
        if (there) {
            return true;
        }
        nanosleep(&pause, NULL);
    }
}

static bool join(process_group *group, const char *command)
{
    int provided = 0;
    if (mpi_load(NULL) != GONIO_OK ||
        MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS) {
        fprintf(stderr, "gonio %s: MPI does not start\n", command);
        return false;
    }
    MPI_Comm_rank(MPI_COMM_WORLD, &group->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &group->size);
    group->barrier = wait_for_all;
    return true;
}

static void leave(int code)
{
    int initialized = 0;
    if (is_launched() && mpi_load(NULL) == GONIO_OK) {
        MPI_Initialized(&initialized);
    }
    if (initialized && code != 0) {
        fflush(NULL);
        MPI_Abort(MPI_COMM_WORLD, 1);
    } else if (initialized) {
        MPI_Finalize();
    }
}

#else

static bool join(process_group *group, const char *command)
{
    (void)group;
    fprintf(stderr,
            "gonio %s: started by mpirun, but built without MPI: install libopenmpi-dev and build "
            "gonio again, or start it without mpirun\n",
            command);
    return false;
}

static void leave(int code)
{
    (void)code;
}

#endif

bool process_group_join(process_group *group, const char *command)
{
    *group = (process_group){.rank = 0, .size = 1};
    return !is_launched() || join(group, command);
}

int process_group_leave(int code)
{
    leave(code);
    return code;
}
