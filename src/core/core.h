/* What every stage needs: failing with a message, progress, checked allocation. */
#ifndef GONIO_CORE_H
#define GONIO_CORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gonio/context.h>

/* Functions that gain from wider vectors are compiled for several processors; one is chosen at run
 * time. (Not under the sanitizers: their start-up fails with the resolvers.) */
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) &&       \
    !defined(GONIO_NO_CLONES)
#define GONIO_I_VECTORISED __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define GONIO_I_VECTORISED
#endif

#define GONIO_I_PRINTF(text, first) __attribute__((format(printf, text, first)))

/* Sends one line to the message callback and returns the status, so that a failing function can end
 * with `return gonio_i_fail(...)`. */
gonio_status gonio_i_fail(gonio_context *context, gonio_status status, const char *format, ...)
    GONIO_I_PRINTF(3, 4);
void gonio_i_warn(gonio_context *context, const char *format, ...) GONIO_I_PRINTF(2, 3);
void gonio_i_note(gonio_context *context, const char *format, ...) GONIO_I_PRINTF(2, 3);

/* A context that the threads of one call share, for the length of that call. It passes everything
 * on to `context`, except that it reports only the first error: a failure has one message. Without
 * a context or memory the result is `context` itself. */
gonio_context *gonio_i_shared_context_begin(gonio_context *context);
void gonio_i_shared_context_end(gonio_context *shared, const gonio_context *context);

/* A context with one thread, for one of many independent pieces of work that run in parallel. Its
 * messages begin with "name: ". Progress reported to it only asks whether to stop: the callback
 * gets the last progress of the whole work again. `name` must outlive the context. Errors:
 * _MEMORY. */
gonio_status gonio_i_piece_begin(gonio_context *context, const char *name, gonio_context **piece);
void gonio_i_piece_end(gonio_context *piece);

/* Reports progress; GONIO_ERROR_CANCELLED once the callback has asked to stop. Thread-safe;
 * `task` must last as long as the context. */
gonio_status gonio_i_progress(gonio_context *context, const char *task, double fraction);

/* Where the outputs that a context holds are kept, that of the context above if it has one; NULL
 * without a context. Used by output.c alone. */
struct gonio_i_held;
struct gonio_i_held **gonio_i_held_of(gonio_context *context);

/* Limits OpenBLAS to one thread a call, process-wide, because gonio runs its own threads. To be
 * called before threads are started and before every call of OpenBLAS. Thread-safe. */
void gonio_i_keep_blas_on_one_thread(void);

/* Zeroed memory for count x size bytes, with the product checked for overflow. NULL after a
 * message. Released with free(). */
void *gonio_i_allocate(gonio_context *context, size_t count, size_t size);

/* A formatted string; NULL when out of memory. */
char *gonio_i_format(const char *format, ...) GONIO_I_PRINTF(1, 2);

/* A file's base name without folder and, if wanted, without its extension; NULL when out of memory.
 */
char *gonio_i_base_name(const char *path, bool keep_extension);

#endif
