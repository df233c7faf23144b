/* A parallel loop: see parallel_for.h. */
#include "parallel_for.h"

#include <stdlib.h>

static gonio_status step_on(gonio_context *context, gonio_i_steps *steps)
{
    size_t done;
#pragma omp atomic capture
    done = ++steps->done;
    if (steps->task == NULL) {
        return GONIO_OK;
    }
    return gonio_i_progress(context, steps->task, (double)done / (double)steps->all);
}

gonio_status gonio_i_parallel_for(gonio_context *context, gonio_i_steps *steps, size_t count,
                                  gonio_i_parallel_body work, void *data)
{
    const size_t threads = (size_t)gonio_context_threads(context);
    gonio_context *shared = gonio_i_shared_context_begin(context);
    gonio_status result = GONIO_OK;
    size_t failed = count;
    /* Fewer tasks than threads are done one by one, each by all threads. */
#pragma omp parallel for schedule(dynamic, 1) if (count >= threads) num_threads((int)threads)
    for (size_t k = 0; k < count; k++) {
        size_t before;
#pragma omp atomic read
        before = failed;
        if (before < k) {
            continue;
        }
        gonio_status status = work(data, shared, k);
        status = status == GONIO_OK ? step_on(shared, steps) : status;
#pragma omp critical(gonio_parallel_for)
        if (status != GONIO_OK && k < failed) {
#pragma omp atomic write
            failed = k;
            result = status;
        }
    }
    gonio_i_shared_context_end(shared, context);
    return result;
}
