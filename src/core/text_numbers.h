/* The words and numbers of a text, one after another, with the line that each is in. */
#ifndef GONIO_TEXT_NUMBERS_H
#define GONIO_TEXT_NUMBERS_H

#include "core.h"

enum { GONIO_I_WORD = 64 };

typedef struct gonio_i_numbers {
    gonio_context *context;
    const char *path; /* for messages */
    const char *at;
    const char *end;
    size_t line;  /* from 1 */
    char comment; /* begins a comment, which goes to the end of its line; 0: none */
    bool commas;  /* commas separate words, as blanks do */
} gonio_i_numbers;

/* Starts at the beginning of a text, which must outlive the result. */
gonio_i_numbers gonio_i_numbers_of(gonio_context *context, const char *path, const char *text,
                                   size_t size, char comment);

/* Skips to a later place. */
void gonio_i_numbers_go_to(gonio_i_numbers *numbers, const char *place);

/* Skips blanks, line ends and comments. Returns whether there is more. */
bool gonio_i_numbers_skip(gonio_i_numbers *numbers);

/* The same within a line. Returns whether the line has more. */
bool gonio_i_numbers_skip_blanks(gonio_i_numbers *numbers);

/* Skips to the beginning of the next line. */
void gonio_i_numbers_next_line(gonio_i_numbers *numbers);

/* The next word, at most 63 characters of it; "" at the end. */
void gonio_i_numbers_word(gonio_i_numbers *numbers, char word[GONIO_I_WORD]);

/* The next number, on any line. Errors: _FORMAT at the end of the text and for a word that is no
 * finite number; the message names the line. */
gonio_status gonio_i_numbers_read(gonio_i_numbers *numbers, double *value);

/* Reads the numbers of the rest of the line, at most `most`, and its end. Returns their count, 0
 * for an empty line, or -1 if a word is no number. */
int gonio_i_numbers_row(gonio_i_numbers *numbers, double *value, int most);

/* Gives a number with the exponent of a Fortran double ("2.5D-03") the usual letter: "2.5E-03". */
void gonio_i_take_fortran_exponent(char *number);

#endif
