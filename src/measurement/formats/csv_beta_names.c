/* Names of beta - beta0, the difference of the sines of both polar angles: see csv_names.h. */
#include <string.h>

#include "csv_names.h"

/* Whether words are "w w 0", "w w o": both betas and the index of the second. */
static bool are_two(const gonio_i_words *words, size_t at, const char *letter)
{
    const gonio_i_name_word *w = &words->word[at];
    if (words->count < at + 2 || strcmp(w[0].text, letter) != 0 ||
        strncmp(w[1].text, letter, strlen(letter)) != 0) {
        return false;
    }
    const char *index = w[1].text + strlen(letter);
    const bool attached = strcmp(index, "o") == 0 || strcmp(index, "i") == 0;
    if (attached) {
        return words->count == at + 2;
    }
    return *index == '\0' && words->count == at + 3 &&
           (strcmp(w[2].text, "o") == 0 || strcmp(w[2].text, "i") == 0 ||
            (w[2].text[0] == '\0' && w[2].number == 0.0));
}

/* Whether words are "sin theta o sin theta i". */
static bool are_sines(const gonio_i_words *words, size_t at)
{
    static const char *const sides[] = {"o", "r", "s"};
    const gonio_i_name_word *w = &words->word[at];
    bool out = false;
    for (size_t k = 0; k < 3 && words->count == at + 6; k++) {
        out = out || strcmp(w[2].text, sides[k]) == 0;
    }
    return out && strcmp(w[0].text, "sin") == 0 && strcmp(w[1].text, "theta") == 0 &&
           strcmp(w[3].text, "sin") == 0 && strcmp(w[4].text, "theta") == 0 &&
           strcmp(w[5].text, "i") == 0;
}

bool gonio_i_take_beta_name(const char *text, const gonio_i_words *words, gonio_i_column_name *name)
{
    const bool abs = words->count > 0 && strcmp(words->word[0].text, "abs") == 0;
    const size_t at = abs ? 1 : 0;
    const bool delta = words->count == 2 && strcmp(words->word[0].text, "delta") == 0 &&
                       strcmp(words->word[1].text, "beta") == 0;
    if (!words->whole ||
        !(delta || are_two(words, at, "beta") || are_two(words, at, "b") || are_sines(words, at))) {
        return false;
    }
    name->kind = GONIO_I_ANGLE;
    name->index = abs || strchr(text, '|') != NULL ? GONIO_I_BETA_SIZE : GONIO_I_BETA;
    return true;
}
