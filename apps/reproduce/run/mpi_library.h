/* MPI, loaded when it is used. After mpi_load has succeeded, its functions are called as if it were
 * linked: see core/on_demand.h. */
#ifndef GONIO_MPI_LIBRARY_H
#define GONIO_MPI_LIBRARY_H

#include <mpi.h>

#include "core/on_demand.h"

#ifdef OPEN_MPI
#define MPI_DATA(X) X(ompi_mpi_comm_world)
#else
#define MPI_DATA(X)
#endif

#define MPI_SYMBOLS(X)                                                                             \
    X(MPI_Abort)                                                                                   \
    X(MPI_Comm_rank)                                                                               \
    X(MPI_Comm_size)                                                                               \
    X(MPI_Finalize) X(MPI_Ibarrier) X(MPI_Init_thread) X(MPI_Initialized) X(MPI_Test) MPI_DATA(X)

struct mpi {
    MPI_SYMBOLS(GONIO_I_SYMBOL_POINTER)
};

extern struct mpi mpi;

gonio_status mpi_load(gonio_context *context);

#ifndef MPI_ITSELF
#define MPI_Abort (*mpi.MPI_Abort)
#define MPI_Comm_rank (*mpi.MPI_Comm_rank)
#define MPI_Comm_size (*mpi.MPI_Comm_size)
#define MPI_Finalize (*mpi.MPI_Finalize)
#define MPI_Ibarrier (*mpi.MPI_Ibarrier)
#define MPI_Init_thread (*mpi.MPI_Init_thread)
#define MPI_Initialized (*mpi.MPI_Initialized)
#define MPI_Test (*mpi.MPI_Test)
#define ompi_mpi_comm_world (*mpi.ompi_mpi_comm_world)
#endif

#endif
