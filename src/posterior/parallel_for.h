/* A parallel loop over independent tasks, one for each column. */
#ifndef GONIO_PARALLEL_FOR_H
#define GONIO_PARALLEL_FOR_H

#include "../core/core.h"

/* Progress over several calls. */
typedef struct gonio_i_steps {
    const char *task; /* NULL: nothing is told */
    size_t done;
    size_t all;
} gonio_i_steps;

/* Calls work(data, context, k) for every k < count, by as many threads as the context has; the
 * context that work gets is shared (core.h). After a failure no further task is begun; the status
 * is that of the first task that failed. steps: counts the tasks and reports progress. Errors:
 * those of the work; _CANCELLED. */
typedef gonio_status (*gonio_i_parallel_body)(void *data, gonio_context *context, size_t k);
gonio_status gonio_i_parallel_for(gonio_context *context, gonio_i_steps *steps, size_t count,
                                  gonio_i_parallel_body work, void *data);

#endif
