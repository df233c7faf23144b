/* The words of a column's name. */
#ifndef GONIO_CSV_WORDS_H
#define GONIO_CSV_WORDS_H

#include <stdbool.h>
#include <stddef.h>

enum { GONIO_I_MOST_WORDS = 16, GONIO_I_WORD_ROOM = 24 };

typedef struct gonio_i_name_word {
    char text[GONIO_I_WORD_ROOM]; /* lower case; "" for a number */
    double number;
} gonio_i_name_word;

typedef struct gonio_i_words {
    size_t count;
    gonio_i_name_word word[GONIO_I_MOST_WORDS];
    bool whole; /* no word is missing or cut */
} gonio_i_words;

/* Splits a text into words. A word is a run of letters. Numbers, Greek letters and signs of units
 * are words of their own, and so are the parts of "thetaIn" and "thetai". Signs between words are
 * skipped. */
void gonio_i_words_split(const char *text, gonio_i_words *words);

#endif
