/* Structs that callers fill in. They begin with their size, so that fields can be added at the end:
 * a caller that was built with an older header gives fewer fields, and the others get defaults. */
#ifndef GONIO_OPTIONS_H
#define GONIO_OPTIONS_H

#include <string.h>

#include "core.h"

/* The limits of a size in bytes. Outside of them it was not set. */
enum { GONIO_I_SMALLEST_STRUCT = sizeof(size_t), GONIO_I_LARGEST_STRUCT = 4096 };

/* Copies the fields that both builds know from *given to *taken. *taken has `size` bytes and holds
 * the defaults. Both begin with their size. given may be NULL. False, without copying, if the size
 * of *given was not set. */
static inline bool gonio_i_copy_known(const void *given, void *taken, size_t size)
{
    size_t known = size;
    if (given != NULL) {
        memcpy(&known, given, sizeof known);
    }
    const bool set = known >= GONIO_I_SMALLEST_STRUCT && known <= GONIO_I_LARGEST_STRUCT;
    if (set && given != NULL) {
        memcpy(taken, given, known < size ? known : size);
    }
    memcpy(taken, &size, sizeof size);
    return set;
}

/* The other direction: copies the defaults that the caller's build knows, and sets the size. *given
 * has `size` bytes. */
static inline void gonio_i_give(const void *usual, size_t known, void *given, size_t size)
{
    memset(given, 0, size);
    memcpy(given, usual, known < size ? known : size);
    memcpy(given, &size, sizeof size);
}

/* Copies a caller's struct, with a message on failure. `type` is the struct's name, `remedy` says
 * what the caller should do. Errors: _ARGUMENT if the size of *given was not set. */
gonio_status gonio_i_take(gonio_context *context, const char *type, const char *remedy,
                          const void *given, void *taken, size_t size);

/* For a struct with a _default function: GONIO_I_TAKE(context, gonio_plan_options, given,
 * &options).
 */
#define GONIO_I_TAKE(context, type, given, taken)                                                  \
    (type##_default(taken),                                                                        \
     gonio_i_take(context, #type, "call " #type "_default first", given, taken, sizeof *(taken)))

/* For a struct without a _default function. Its defaults are zeros. */
#define GONIO_I_TAKE_PLAIN(context, type, given, taken)                                            \
    (*(taken) = (type){0},                                                                         \
     gonio_i_take(context, #type, "set .size = sizeof(" #type ")", given, taken, sizeof *(taken)))

#endif
