/* Numbers as text, with decimal points whatever the program's locale. */
#ifndef GONIO_NUMBER_H
#define GONIO_NUMBER_H

#include <locale.h>
#include <stdbool.h>

/* Between begin and end, printf and strtod of this thread use decimal points. */
typedef struct gonio_i_plain_numbers {
    locale_t plain;
    locale_t before;
} gonio_i_plain_numbers;

/* False when out of memory; there is nothing to end then. */
bool gonio_i_plain_numbers_begin(gonio_i_plain_numbers *numbers);
void gonio_i_plain_numbers_end(gonio_i_plain_numbers *numbers);

#endif
