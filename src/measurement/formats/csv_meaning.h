/* What the words of a name say together: bits, some with a number beside them. */
#ifndef GONIO_CSV_MEANING_H
#define GONIO_CSV_MEANING_H

#include <stddef.h>

/* A word and what it says; `value` is a detail of it. */
typedef struct gonio_i_known_word {
    const char *text;
    unsigned bits;
    int value;
} gonio_i_known_word;

/* What a name's words say together. */
typedef struct gonio_i_meaning {
    unsigned bits;
    unsigned twice; /* bits that were said more than once */
    int value[32];  /* [bit], of the first word that said it */
    size_t words;
} gonio_i_meaning;

/* Adds what a word says. */
void gonio_i_meaning_add(gonio_i_meaning *s, unsigned bits, int value);

/* The row of a word in a list; NULL if it is not known. */
const gonio_i_known_word *gonio_i_find_word(const gonio_i_known_word *known, size_t count,
                                            const char *text);

#endif
