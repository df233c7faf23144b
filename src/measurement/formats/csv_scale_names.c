/* Words of logarithms: see csv_scale_names.h. */
#include "csv_scale_names.h"

#include <string.h>

#include <gonio/measurement.h>

/* A logarithm without a base is to base 10. */
static const struct {
    const char *text;
    int scale;
} known[] = {{"log", GONIO_SCALE_LOG10},       {"lg", GONIO_SCALE_LOG10},
             {"logarithm", GONIO_SCALE_LOG10}, {"ln", GONIO_SCALE_LN},
             {"db", GONIO_SCALE_DECIBEL},      {"decibel", GONIO_SCALE_DECIBEL},
             {"decibels", GONIO_SCALE_DECIBEL}};

static int scale_of(const char *text)
{
    int scale = 0;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        scale = strcmp(known[k].text, text) == 0 ? known[k].scale : scale;
    }
    return scale;
}

static void drop(gonio_i_words *words, size_t k)
{
    words->count--;
    memmove(&words->word[k], &words->word[k + 1], (words->count - k) * sizeof *words->word);
}

static bool is_ten(const gonio_i_words *words, size_t k)
{
    return k < words->count && words->word[k].text[0] == '\0' && words->word[k].number == 10.0;
}

/* Whether a number is another base, as in "log2": no wavelength is so short. */
static bool is_other_base(const gonio_i_words *words, size_t k)
{
    return k < words->count && words->word[k].text[0] == '\0' && words->word[k].number < 10.0;
}

/* The 10 of "log10" is its base, and that of "10 log" makes decibels. */
int gonio_i_take_scale(gonio_i_words *words)
{
    int scale = 0;
    for (size_t k = 0; k < words->count;) {
        int found = scale_of(words->word[k].text);
        if (found == 0 || is_other_base(words, k + 1)) {
            k++;
            continue;
        }
        drop(words, k);
        if (found == GONIO_SCALE_LOG10 && is_ten(words, k)) {
            drop(words, k);
        }
        if (found == GONIO_SCALE_LOG10 && k > 0 && is_ten(words, k - 1)) {
            drop(words, --k);
            found = GONIO_SCALE_DECIBEL;
        }
        scale = found > scale ? found : scale;
    }
    return scale;
}
