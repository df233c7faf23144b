/* What the words of a name mean together: bits, each with a number. */
#ifndef GONIO_CSV_MEANING_H
#define GONIO_CSV_MEANING_H

#include <stddef.h>

/* A word, the bits that it sets, and the number that goes with them. */
typedef struct gonio_i_known_word {
    const char *text;
    unsigned bits;
    int value;
} gonio_i_known_word;

/* What the words of a name mean together. */
typedef struct gonio_i_meaning {
    unsigned bits;
    unsigned twice; /* bits that were set more than once */
    int value[32];  /* [bit]: of the first word that set it */
    size_t words;
} gonio_i_meaning;

/* Adds a word. */
void gonio_i_meaning_add(gonio_i_meaning *s, unsigned bits, int value);

/* The row of a word in a list; NULL if it is not known. */
const gonio_i_known_word *gonio_i_find_word(const gonio_i_known_word *known, size_t count,
                                            const char *text);

#endif
