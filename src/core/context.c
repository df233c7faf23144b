/* The context: messages, progress, threads; and the library's status texts and version. */
#include "blas_buffers.h"
#include "core.h"
#include "number.h"
#include "options.h"
#include "processors.h"

#include <ctype.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cblas.h>
#include <omp.h>

struct gonio_context {
    gonio_context_options options;
    pthread_mutex_t callbacks;
    bool cancelled;
    const char *task; /* the progress reported last */
    double fraction;
    gonio_context *above;      /* of a shared context or a piece: where its messages go */
    bool failed;               /* of a shared context: an error was reported */
    const char *piece;         /* of a piece: what its messages begin with */
    struct gonio_i_held *held; /* NULL while outputs are not held */
};

/* More threads than this a processor cost memory and are not faster. */
enum { MOST_THREADS_PER_PROCESSOR = 16 };

#define TEXT(x) #x
#define VERSION(major, minor, patch) TEXT(major) "." TEXT(minor) "." TEXT(patch)

const char *gonio_version(void)
{
    return VERSION(GONIO_VERSION_MAJOR, GONIO_VERSION_MINOR, GONIO_VERSION_PATCH);
}

int gonio_version_number(void)
{
    return 10000 * GONIO_VERSION_MAJOR + 100 * GONIO_VERSION_MINOR + GONIO_VERSION_PATCH;
}

const char *gonio_status_text(gonio_status status)
{
    static const char *const texts[] = {
        "success",
        "invalid argument",
        "out of memory",
        "input/output error",
        "wrong or damaged file",
        "unusable data",
        "inputs do not belong together",
        "too few independent readings",
        "cancelled",
        "numerical failure",
    };
    if (status < 0 || (size_t)status >= sizeof texts / sizeof *texts) {
        return "unknown status";
    }
    return texts[status];
}

void gonio_context_options_default_of(gonio_context_options *options, size_t size)
{
    const gonio_context_options usual = {0};
    gonio_i_give(&usual, sizeof usual, options, size);
}

gonio_status gonio_context_create(gonio_context **context, const gonio_context_options *options)
{
    gonio_context_options taken;
    gonio_context_options_default(&taken);
    if (!gonio_i_copy_known(options, &taken, sizeof taken) || taken.threads < 0) {
        return GONIO_ERROR_ARGUMENT;
    }
    gonio_context *made = calloc(1, sizeof *made);
    if (made == NULL) {
        if (taken.message != NULL) {
            taken.message(taken.user, GONIO_MESSAGE_ERROR, "out of memory");
        }
        return GONIO_ERROR_MEMORY;
    }
    made->options = taken;
    made->task = "";
    pthread_mutex_init(&made->callbacks, NULL);
    gonio_i_keep_blas_on_one_thread();
    const int threads = gonio_context_threads(made);
    if (!gonio_i_reserve_blas_buffers(threads)) {
        gonio_i_fail(made, GONIO_ERROR_MEMORY,
                     "out of memory: the address space is limited (ulimit -v), and each of %d "
                     "threads needs 160 MB of it; allow fewer threads or more room",
                     threads);
        gonio_context_free(&made);
        return GONIO_ERROR_MEMORY;
    }
    *context = made;
    return GONIO_OK;
}

void gonio_context_free(gonio_context **context)
{
    if (context == NULL || *context == NULL) {
        return;
    }
    pthread_mutex_destroy(&(*context)->callbacks);
    free(*context);
    *context = NULL;
}

void gonio_context_resume(gonio_context *context)
{
    if (context != NULL) {
        pthread_mutex_lock(&context->callbacks);
        context->cancelled = false;
        pthread_mutex_unlock(&context->callbacks);
    }
}

struct gonio_i_held **gonio_i_held_of(gonio_context *context)
{
    while (context != NULL && context->above != NULL) {
        context = context->above;
    }
    return context != NULL ? &context->held : NULL;
}

void gonio_i_keep_blas_on_one_thread(void)
{
    if (openblas_get_num_threads() != 1) {
        openblas_set_num_threads(1);
    }
}

int gonio_context_threads(const gonio_context *context)
{
    gonio_i_keep_blas_on_one_thread();
    if (omp_in_parallel()) {
        return 1;
    }
    const int processors = gonio_i_processors();
    if (context == NULL || context->options.threads == 0) {
        return processors;
    }
    const int most = MOST_THREADS_PER_PROCESSOR * processors;
    return context->options.threads < most ? context->options.threads : most;
}

gonio_context *gonio_i_shared_context_begin(gonio_context *context)
{
    gonio_context *shared = context != NULL ? calloc(1, sizeof *shared) : NULL;
    if (shared == NULL) {
        return context;
    }
    shared->options = context->options;
    shared->above = context;
    pthread_mutex_init(&shared->callbacks, NULL);
    return shared;
}

void gonio_i_shared_context_end(gonio_context *shared, const gonio_context *context)
{
    if (shared != context) {
        gonio_context_free(&shared);
    }
}

gonio_status gonio_i_piece_begin(gonio_context *context, const char *name, gonio_context **piece)
{
    gonio_context *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->options.threads = 1;
    made->above = context;
    made->piece = name;
    pthread_mutex_init(&made->callbacks, NULL);
    *piece = made;
    return GONIO_OK;
}

void gonio_i_piece_end(gonio_context *piece)
{
    gonio_context_free(&piece);
}

/* Whether a shared context reports this error: only the first. */
static bool is_first_error(gonio_context *shared)
{
    pthread_mutex_lock(&shared->callbacks);
    const bool first = !shared->failed;
    shared->failed = true;
    pthread_mutex_unlock(&shared->callbacks);
    return first;
}

/* Names and cells of files may contain control characters. A message is one line. */
static void keep_to_one_line(char *text)
{
    for (char *c = text; *c != '\0'; c++) {
        *c = iscntrl((unsigned char)*c) ? '?' : *c;
    }
}

/* Changes `text` to "name: text", truncated to its size. */
static void put_in_front(const char *name, char *text, size_t size)
{
    char longer[4096 + 256];
    snprintf(longer, sizeof longer, "%.200s: %s", name, text);
    longer[size - 1] = '\0';
    strcpy(text, longer);
}

static void send(gonio_context *context, gonio_message_level level, const char *format,
                 va_list arguments)
{
    char text[4096];
    gonio_i_print_list(text, sizeof text, format, arguments);
    for (; context != NULL && context->above != NULL; context = context->above) {
        if (context->piece != NULL) {
            put_in_front(context->piece, text, sizeof text);
        } else if (level == GONIO_MESSAGE_ERROR && !is_first_error(context)) {
            return;
        }
    }
    if (context == NULL || context->options.message == NULL) {
        return;
    }
    keep_to_one_line(text);
    pthread_mutex_lock(&context->callbacks);
    context->options.message(context->options.user, level, text);
    pthread_mutex_unlock(&context->callbacks);
}

gonio_status gonio_i_fail(gonio_context *context, gonio_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send(context, GONIO_MESSAGE_ERROR, format, arguments);
    va_end(arguments);
    return status;
}

void gonio_i_warn(gonio_context *context, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send(context, GONIO_MESSAGE_WARNING, format, arguments);
    va_end(arguments);
}

void gonio_i_note(gonio_context *context, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send(context, GONIO_MESSAGE_NOTE, format, arguments);
    va_end(arguments);
}

gonio_status gonio_i_progress(gonio_context *context, const char *task, double fraction)
{
    bool of_piece = false;
    for (; context != NULL && context->above != NULL; context = context->above) {
        of_piece = of_piece || context->piece != NULL;
    }
    if (context == NULL || context->options.progress == NULL) {
        return GONIO_OK;
    }
    pthread_mutex_lock(&context->callbacks);
    if (of_piece) {
        task = context->task;
        fraction = context->fraction;
    }
    context->task = task;
    context->fraction = fraction;
    if (!context->cancelled) {
        context->cancelled = context->options.progress(context->options.user, task, fraction) != 0;
    }
    const bool cancelled = context->cancelled;
    pthread_mutex_unlock(&context->callbacks);
    return cancelled ? GONIO_ERROR_CANCELLED : GONIO_OK;
}

enum { LARGE = 4 << 20 }; /* bytes */

/* Asks for large pages for large blocks. A basis of the full grid has a million small pages, and
 * their page faults would take as long as its arithmetic. */
static void use_large_pages(void *made, size_t bytes)
{
    const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
    const uintptr_t first = ((uintptr_t)made + page - 1) / page * page;
    const uintptr_t end = ((uintptr_t)made + bytes) / page * page;
    madvise((char *)made + (first - (uintptr_t)made), end - first, MADV_HUGEPAGE);
}

void *gonio_i_allocate(gonio_context *context, size_t count, size_t size)
{
    void *made = calloc(count > 0 ? count : 1, size);
    if (made != NULL && size > 0 && count > LARGE / size) {
        use_large_pages(made, count * size);
    }
    if (made == NULL) {
        gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory: %zu x %zu bytes needed", count,
                     size);
    }
    return made;
}

char *gonio_i_format(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *text = gonio_i_format_list(format, arguments);
    va_end(arguments);
    return text;
}

char *gonio_i_base_name(const char *path, bool keep_extension)
{
    const char *slash = strrchr(path, '/');
    char *name = strdup(slash != NULL ? slash + 1 : path);
    if (name != NULL && !keep_extension) {
        char *dot = strrchr(name, '.');
        if (dot != NULL && dot != name) {
            *dot = '\0';
        }
    }
    return name;
}
