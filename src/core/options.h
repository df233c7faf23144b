/* Structs that callers fill in and that begin with their size, so that fields can be added at their
 * end: a caller of an older build gives fewer, and the others keep their defaults. */
#ifndef GONIO_OPTIONS_H
#define GONIO_OPTIONS_H

#include <string.h>

#include "core.h"

/* A size outside of these was not set, in bytes. */
enum { GONIO_I_SMALLEST_STRUCT = sizeof(size_t), GONIO_I_LARGEST_STRUCT = 4096 };

/* Copies the fields of *given that both builds know of over *taken, which is of `size` bytes and
 * holds the defaults; both begin with their size. given may be NULL. False, and nothing is copied,
 * if the size of *given was not set. */
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

/* The other way: as much of the defaults as the caller's build knows of, *given being of `size`
 * bytes, and its size. */
static inline void gonio_i_give(const void *usual, size_t known, void *given, size_t size)
{
    memset(given, 0, size);
    memcpy(given, usual, known < size ? known : size);
    memcpy(given, &size, sizeof size);
}

/* Takes a caller's struct, with a message. `type` is the struct's name, `remedy` what the caller
 * should do. Errors: _ARGUMENT if the size of *given was not set. */
gonio_status gonio_i_take(gonio_context *context, const char *type, const char *remedy,
                          const void *given, void *taken, size_t size);

/* A struct with a function of defaults: GONIO_I_TAKE(context, gonio_plan_options, given, &options).
 */
#define GONIO_I_TAKE(context, type, given, taken)                                                  \
    (type##_default(taken),                                                                        \
     gonio_i_take(context, #type, "call " #type "_default first", given, taken, sizeof *(taken)))

/* A struct without one, whose defaults are zeros. */
#define GONIO_I_TAKE_PLAIN(context, type, given, taken)                                            \
    (*(taken) = (type){0},                                                                         \
     gonio_i_take(context, #type, "set .size = sizeof(" #type ")", given, taken, sizeof *(taken)))

#endif
