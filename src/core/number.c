/* Numbers as text: see number.h. */
#include "number.h"

#include <stdio.h>
#include <stdlib.h>

bool gonio_i_plain_numbers_begin(gonio_i_plain_numbers *numbers)
{
    numbers->plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (numbers->plain == (locale_t)0) {
        return false;
    }
    numbers->before = uselocale(numbers->plain);
    return true;
}

void gonio_i_plain_numbers_end(gonio_i_plain_numbers *numbers)
{
    uselocale(numbers->before);
    freelocale(numbers->plain);
}

double gonio_i_number(const char *text, char **end)
{
    gonio_i_plain_numbers plain;
    if (!gonio_i_plain_numbers_begin(&plain)) {
        if (end != NULL) {
            *end = (char *)text;
        }
        return 0.0;
    }
    const double number = strtod(text, end);
    gonio_i_plain_numbers_end(&plain);
    return number;
}

int gonio_i_print_list(char *text, size_t size, const char *format, va_list arguments)
{
    gonio_i_plain_numbers plain;
    if (!gonio_i_plain_numbers_begin(&plain)) {
        if (size > 0) {
            text[0] = '\0';
        }
        return -1;
    }
    const int length = vsnprintf(text, size, format, arguments);
    gonio_i_plain_numbers_end(&plain);
    return length;
}

int gonio_i_print(char *text, size_t size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = gonio_i_print_list(text, size, format, arguments);
    va_end(arguments);
    return length;
}

char *gonio_i_format_list(const char *format, va_list arguments)
{
    gonio_i_plain_numbers plain;
    char *text = NULL;
    if (!gonio_i_plain_numbers_begin(&plain)) {
        return NULL;
    }
    const int length = vasprintf(&text, format, arguments);
    gonio_i_plain_numbers_end(&plain);
    return length < 0 ? NULL : text;
}
