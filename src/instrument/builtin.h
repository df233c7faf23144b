/* The instruments that come with the library. */
#ifndef GONIO_BUILTIN_INSTRUMENTS_H
#define GONIO_BUILTIN_INSTRUMENTS_H

#include <stddef.h>

/* The file of a built-in instrument by its word; NULL if there is none. */
const char *gonio_i_builtin_instrument(const char *word, size_t *size);

#endif
