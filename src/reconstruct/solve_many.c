/* Many materials solved side by side: see solve_many.h. */
#include "solve_many.h"

#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "../posterior/parallel_for.h"

/* A message that waits for those of the materials before it. */
typedef struct kept_message {
    struct kept_message *next;
    gonio_message_level level;
    char text[];
} kept_message;

/* One material, and what was said of it. */
typedef struct one_material {
    struct many *all;
    kept_message *first, **last;
    bool lost; /* an error, for want of memory */
} one_material;

typedef struct many {
    gonio_context *context;
    const gonio_basis *basis;
    const gonio_readings *const *readings;
    const gonio_reconstruct_options *options;
    gonio_reconstruction **made;
    one_material *one; /* [count] */
    size_t count;
    gonio_i_steps steps;
} many;

/* ---- messages ---- */

static void keep_message(void *user, gonio_message_level level, const char *text)
{
    one_material *one = user;
    kept_message *kept = malloc(sizeof *kept + strlen(text) + 1);
    if (kept == NULL) {
        one->lost = one->lost || level == GONIO_MESSAGE_ERROR;
        return;
    }
    kept->next = NULL;
    kept->level = level;
    strcpy(kept->text, text);
    *one->last = kept;
    one->last = &kept->next;
}

static void tell(gonio_context *context, const kept_message *kept)
{
    if (kept->level == GONIO_MESSAGE_ERROR) {
        (void)gonio_i_fail(context, GONIO_ERROR_DATA, "%s", kept->text);
    } else if (kept->level == GONIO_MESSAGE_WARNING) {
        gonio_i_warn(context, "%s", kept->text);
    } else {
        gonio_i_note(context, "%s", kept->text);
    }
}

/* Passes the messages of a material on, or forgets them. */
static void end_messages(gonio_context *context, one_material *one, bool told)
{
    for (kept_message *kept = one->first; kept != NULL; kept = one->first) {
        if (told) {
            tell(context, kept);
        }
        one->first = kept->next;
        free(kept);
    }
    if (told && one->lost) {
        (void)gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
}

/* ---- solving ---- */

/* How far a single material is says little: told is how many are done. */
static int ask_whether_to_stop(void *user, const char *task, double fraction)
{
    const one_material *one = user;
    const many *m = one->all;
    size_t done;
    (void)task;
    (void)fraction;
#pragma omp atomic read
    done = m->steps.done;
    return gonio_i_progress(m->context, "reconstructing", (double)done / (double)(m->count + 1)) !=
           GONIO_OK;
}

static gonio_status solve_one(void *data, gonio_context *shared, size_t k)
{
    many *m = data;
    one_material *one = &m->one[k];
    gonio_context *own = NULL;
    const gonio_context_options options = {.size = sizeof options,
                                           .message = keep_message,
                                           .progress = ask_whether_to_stop,
                                           .user = one,
                                           .threads = gonio_context_threads(m->context)};
    (void)shared;
    one->all = m;
    one->last = &one->first;
    gonio_status status = gonio_context_create(&own, &options);
    if (status == GONIO_OK) {
        status = gonio_reconstruct(own, m->basis, m->readings[k], m->options, &m->made[k]);
    }
    gonio_context_free(&own);
    return status;
}

/* Keeps what was made before the first that failed. Returns its number. */
static size_t keep_first(const many *m)
{
    size_t solved = 0;
    while (solved < m->count && m->made[solved] != NULL) {
        solved++;
    }
    for (size_t k = 0; k < m->count; k++) {
        end_messages(m->context, &m->one[k], k <= solved);
        if (k > solved) {
            gonio_reconstruction_free(&m->made[k]);
        }
    }
    return solved;
}

gonio_status gonio_i_solve_many(gonio_context *context, const gonio_basis *basis,
                                const gonio_readings *const *readings, size_t count,
                                const gonio_reconstruct_options *options,
                                gonio_reconstruction **made, size_t *solved)
{
    many m = {context, basis, readings, options, made, NULL, count, {.task = NULL}};
    gonio_status status = GONIO_ERROR_MEMORY;
    *solved = 0;
    m.one = gonio_i_allocate(context, count, sizeof *m.one);
    if (m.one != NULL) {
        status = gonio_i_parallel_for(context, &m.steps, count, solve_one, &m);
        *solved = keep_first(&m);
        free(m.one);
    }
    return status;
}
