/* The context: callbacks for messages and progress, and the number of threads.
 *
 * Every function that takes a context accepts NULL: silent, one thread per processor. Processors
 * are those that the process may run on, at most the time that its control group gives it (cgroup
 * v1, v2; rounded up), at most one for each 64 MiB of its memory. A context may be used from
 * several threads; its callbacks are called one at a time.
 *
 * gonio runs its own threads. They do not nest: a function that is called from a parallel region of
 * OpenMP works on the calling thread. OpenBLAS is set, process-wide, to run each call on one
 * thread. */
#ifndef GONIO_CONTEXT_H
#define GONIO_CONTEXT_H

#include <stddef.h>

#include <gonio/status.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_context gonio_context;

typedef enum gonio_message_level {
    GONIO_MESSAGE_ERROR,   /* the detail of a status that is being returned */
    GONIO_MESSAGE_WARNING, /* the work goes on, but the user should know */
    GONIO_MESSAGE_NOTE     /* a choice made on the user's behalf */
} gonio_message_level;

typedef struct gonio_context_options {
    size_t size; /* of this struct, which gonio_context_options_default sets */
    /* Called with one line of UTF-8 text without a newline; NULL for silence. */
    void (*message)(void *user, gonio_message_level level, const char *text);
    /* Called now and then during long work with 0 <= fraction <= 1 (1 exactly once, at the end);
     * a non-zero return cancels all work under this context with GONIO_ERROR_CANCELLED, until
     * gonio_context_resume. NULL for none. */
    int (*progress)(void *user, const char *task, double fraction);
    void *user;  /* handed to both callbacks */
    int threads; /* most threads to use; 0 for one per processor that the process is given */
} gonio_context_options;

/* The defaults: silence, no progress, one thread per processor. */
GONIO_API void gonio_context_options_default_of(gonio_context_options *options, size_t size);
static inline void gonio_context_options_default(gonio_context_options *options)
{
    gonio_context_options_default_of(options, sizeof *options);
}

/* Makes a context; options may be NULL for the defaults. *context is the caller's. If the
 * address space is limited, room for the matrix products of each thread is reserved. Errors:
 * GONIO_ERROR_MEMORY; without a message GONIO_ERROR_ARGUMENT for threads < 0 and for options that
 * were not initialised. */
GONIO_API gonio_status gonio_context_create(gonio_context **context,
                                            const gonio_context_options *options);

GONIO_API void gonio_context_free(gonio_context **context);

/* Lets a cancelled context work again. Until then all work under it stops, at once if it has begun
 * and at its first report of progress if not; so call this when no cancelled work still runs. Does
 * nothing to a context that was not cancelled, and to NULL. Thread-safe. */
GONIO_API void gonio_context_resume(gonio_context *context);

/* Several output files that appear together, or none of them: what is written from now on under
 * this context, and is finished, waits for gonio_outputs_release. That puts the files in place, in
 * order, if `status` is GONIO_OK, and otherwise removes them; it returns `status`, or _IO if a file
 * cannot be put in place (those before it are then). Each hold needs its release, before the
 * context is freed. Errors of holding: _ARGUMENT without a context, and if outputs are held
 * already; _MEMORY. */
GONIO_API gonio_status gonio_outputs_hold(gonio_context *context);
GONIO_API gonio_status gonio_outputs_release(gonio_context *context, gonio_status status);

/* The number of threads that work under this context, or under NULL, uses; 1 in a parallel region
 * of OpenMP. Thread-safe. */
GONIO_API int gonio_context_threads(const gonio_context *context);

#ifdef __cplusplus
}
#endif
#endif
