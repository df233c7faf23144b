/* Status codes and version: what every fallible gonio function returns.
 *
 * Conventions of all gonio headers
 *   - A fallible function returns a gonio_status and gives its results through out-pointers, which
 *     are written only on GONIO_OK. A one-line explanation of a failure, naming the file and the
 *     place, goes to the context's message callback (context.h).
 *   - Objects made by gonio_X_create, _open, _read, _learn ... are owned by the caller and released
 *     by gonio_X_free(&x), which accepts NULL and nulls the pointer.
 *   - A struct of options begins with its size. Call its gonio_X_options_default, then change
 *     fields. (That is an inline function, so that the library learns how large the struct was when
 *     the program was compiled; other languages call _default_of.) NULL in place of options means
 *     the defaults. A struct of input without such a call is zeros but for the fields that are set,
 *     .size = sizeof(gonio_X) among them. A size that was not set is GONIO_ERROR_ARGUMENT.
 *   - Threads: functions that take an object as const do not write to it, so several threads may
 *     call them with the same object at a time. A function that changes an object needs it alone.
 *     A context may always be shared (context.h). Functions without objects are pure.
 *   - What is passed to a function is the caller's. It is not needed after the call, unless the
 *     comment says that it must outlive the result.
 *   - A name or description from a list is static. Pointers that come out of an object belong to
 *     it: they last until it is freed or a function changes it.
 *   - Indices (cells, rows, components, channels, materials, places in lists) are checked. One that
 *     there is not is GONIO_ERROR_ARGUMENT, or what the comment says if there is no status.
 *   - The library prints nothing, never exits, and keeps no global state of its own.
 *   - Angles are radians, reflectances 1/sr; arrays are contiguous, the last index fastest. */
#ifndef GONIO_STATUS_H
#define GONIO_STATUS_H

#include <stdint.h>

#if defined(__GNUC__)
#define GONIO_API __attribute__((visibility("default")))
#else
#define GONIO_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define GONIO_VERSION_MAJOR 0
#define GONIO_VERSION_MINOR 1
#define GONIO_VERSION_PATCH 0

typedef int32_t gonio_status;

enum {
    GONIO_OK = 0,
    GONIO_ERROR_ARGUMENT = 1,     /* the caller asked for something that cannot be meant */
    GONIO_ERROR_MEMORY = 2,       /* out of memory */
    GONIO_ERROR_IO = 3,           /* a file could not be opened, read or written */
    GONIO_ERROR_FORMAT = 4,       /* a file is not what it claims to be, or is damaged */
    GONIO_ERROR_DATA = 5,         /* well-formed input whose values cannot be used */
    GONIO_ERROR_MISMATCH = 6,     /* two inputs that do not belong together */
    GONIO_ERROR_UNDETERMINED = 7, /* too few independent readings for what is asked */
    GONIO_ERROR_CANCELLED = 8,    /* the progress callback asked to stop */
    GONIO_ERROR_NUMERICAL = 9     /* a numerical routine did not converge */
};

/* A short English name for a status ("out of memory"); never NULL. */
GONIO_API const char *gonio_status_text(gonio_status status);

/* The library's version, "MAJOR.MINOR.PATCH". */
GONIO_API const char *gonio_version(void);

/* The same as a number that can be compared: 10000 MAJOR + 100 MINOR + PATCH. Of the library that
 * runs; GONIO_VERSION_MAJOR and the others are of the header (docs/stability.md). */
GONIO_API int gonio_version_number(void);

#ifdef __cplusplus
}
#endif
#endif
