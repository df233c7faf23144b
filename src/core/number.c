/* Numbers as text: see number.h. */
#include "number.h"

bool gonio_i_plain_numbers_begin(gonio_i_plain_numbers *numbers)
{
    numbers->plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
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
