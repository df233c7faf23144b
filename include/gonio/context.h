/* The context: where messages and progress go, and how many threads may be used.
 *
 * Every function that takes a context accepts NULL: silent, one thread per processor. A context may
 * be used from several threads; its callbacks are called one at a time. */
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
     * a non-zero return cancels the work with GONIO_ERROR_CANCELLED. NULL for none. */
    int (*progress)(void *user, const char *task, double fraction);
    void *user;  /* handed to both callbacks */
    int threads; /* most threads to use; 0 for one per processor */
} gonio_context_options;

/* Silence, no progress, one thread per processor. */
GONIO_API void gonio_context_options_default(gonio_context_options *options);

/* Makes a context; options may be NULL for the defaults. gonio runs its own threads, so this also
 * asks OpenBLAS (process-wide) to run each call on one thread.
 * Errors: GONIO_ERROR_MEMORY; GONIO_ERROR_ARGUMENT for threads < 0. */
GONIO_API gonio_status gonio_context_create(gonio_context **context,
                                            const gonio_context_options *options);

GONIO_API void gonio_context_free(gonio_context **context);

/* The number of threads that work under this context uses. */
GONIO_API int gonio_context_threads(const gonio_context *context);

#ifdef __cplusplus
}
#endif
#endif
