/* Libraries that few commands need, loaded when they are used: loading all of them takes longer
 * than all else that a short command does.
 *
 * The header of such a library, NAME_library.h, lists its symbols and calls them by pointers. If
 * the library is linked, the pointers are filled in from there. Otherwise it is loaded by its name.
 * So whoever links decides: the program does not link these libraries, the shared library does. */
#ifndef GONIO_ON_DEMAND_H
#define GONIO_ON_DEMAND_H

#include <pthread.h>

#include "core.h"

typedef struct gonio_i_symbol {
    const char *name;
    const void *linked; /* NULL if it has to be loaded */
} gonio_i_symbol;

typedef struct gonio_i_on_demand {
    const char *library; /* as the dynamic linker knows it; NULL: it is always linked */
    bool global;         /* plugins of the library look for its symbols */
    const gonio_i_symbol *symbol;
    size_t symbols;
    void *pointers; /* a struct of as many pointers, in the same order */
    pthread_mutex_t lock;
    bool ready;
} gonio_i_on_demand;

/* Fills in the pointers, once. Fails if the library or one of its symbols is not there. */
gonio_status gonio_i_load(gonio_context *context, gonio_i_on_demand *library);

#define GONIO_I_SYMBOL_POINTER(symbol) __typeof__(symbol) *symbol;
#define GONIO_I_SYMBOL_ROW(symbol) {#symbol, __extension__(const void *) & (symbol)},

/* The build defines the library's name for the source that defines it, unless it is always linked.
 */
#ifdef GONIO_ON_DEMAND
#define GONIO_I_SYMBOL_WEAK(symbol) extern __typeof__(symbol) symbol __attribute__((weak));
#else
#define GONIO_ON_DEMAND NULL
#define GONIO_I_SYMBOL_WEAK(symbol)
#endif

/* Defines what the header of a library declares: the struct of pointers `name`, and the function
 * that fills it in. is_global: as above. */
#define GONIO_I_DEFINE_LIBRARY(name, load, SYMBOLS, is_global)                                     \
    SYMBOLS(GONIO_I_SYMBOL_WEAK)                                                                   \
    struct name name;                                                                              \
    gonio_status load(gonio_context *context)                                                      \
    {                                                                                              \
        static const gonio_i_symbol symbols[] = {SYMBOLS(GONIO_I_SYMBOL_ROW)};                     \
        static gonio_i_on_demand library = {.library = GONIO_ON_DEMAND,                            \
                                            .global = (is_global),                                 \
                                            .symbol = symbols,                                     \
                                            .symbols = sizeof symbols / sizeof *symbols,           \
                                            .pointers = &(name),                                   \
                                            .lock = PTHREAD_MUTEX_INITIALIZER};                    \
        return gonio_i_load(context, &library);                                                    \
    }

#endif
