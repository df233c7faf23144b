/* What the words of a name mean together: see csv_meaning.h. */
#include "csv_meaning.h"

#include <string.h>

void gonio_i_meaning_add(gonio_i_meaning *s, unsigned bits, int value)
{
    s->twice |= s->bits & bits;
    for (unsigned bit = 0; bit < 32; bit++) {
        if ((bits & ~s->bits & 1U << bit) != 0) {
            s->value[bit] = value;
        }
    }
    s->bits |= bits;
    s->words++;
}

const gonio_i_known_word *gonio_i_find_word(const gonio_i_known_word *known, size_t count,
                                            const char *text)
{
    for (size_t k = 0; k < count; k++) {
        if (strcmp(known[k].text, text) == 0) {
            return &known[k];
        }
    }
    return NULL;
}
