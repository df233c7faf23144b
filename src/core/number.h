/* Numbers as text, with decimal points whatever the program's locale. The library calls strtod and
 * the printf family on numbers by these, or between begin and end. A locale is a thread's own, so
 * none is set for whole calls of the library: their threads would not have it. */
#ifndef GONIO_NUMBER_H
#define GONIO_NUMBER_H

#include <locale.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

/* Between begin and end, this thread works in the locale "C". */
typedef struct gonio_i_plain_numbers {
    locale_t plain;
    locale_t before;
} gonio_i_plain_numbers;

/* False when out of memory; there is nothing to end then. */
bool gonio_i_plain_numbers_begin(gonio_i_plain_numbers *numbers);
void gonio_i_plain_numbers_end(gonio_i_plain_numbers *numbers);

/* strtod. Out of memory: as for a text that is no number. */
double gonio_i_number(const char *text, char **end);

/* snprintf, vsnprintf and vasprintf; text is empty, or NULL, when out of memory. */
int gonio_i_print(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
int gonio_i_print_list(char *text, size_t size, const char *format, va_list arguments);
char *gonio_i_format_list(const char *format, va_list arguments);

#endif
