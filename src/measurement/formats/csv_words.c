/* Splitting a name into words: see csv_words.h. */
#include "csv_words.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Signs beyond ASCII in UTF-8, and in Latin-1 where a single byte is unambiguous. */
static const struct {
    const char *sign;
    const char *text;
} signs[] = {
    {"\xc2\xb0", " deg "},       {"\xb0", " deg "},        {"\xc2\xb5m", " um "},
    {"\xce\xbcm", " um "},       {"\xb5m", " um "},        {"\xc2\xb9", " 1 "},
    {"\xe2\x81\xbb", " "},       {"\xce\xb8", " theta "},  {"\xcf\x91", " theta "},
    {"\xcf\x86", " phi "},       {"\xcf\x95", " phi "},    {"\xce\x94", " delta "},
    {"\xe2\x88\x86", " delta "}, {"\xce\xbb", " lambda "}, {"\xce\xb2", " beta "},
    {"\xe2\x82\x80", " 0 "},     {"\xcf\x81", " rho "},    {"\xcf\x83", " sigma "},
    {"%", " percent "},          {"\xc3\x97", " x "},      {"\xc2\xb7", " "},
    {"\xe2\x8b\x85", " "},
};

enum { NAME_ROOM = 256 };

static const char *sign_at(const char *at, size_t *length)
{
    for (size_t k = 0; k < sizeof signs / sizeof *signs; k++) {
        *length = strlen(signs[k].sign);
        if (strncmp(at, signs[k].sign, *length) == 0) {
            return signs[k].text;
        }
    }
    return NULL;
}

/* The bytes of a character beyond ASCII in UTF-8; 1 for any other. */
static size_t character_at(const char *at)
{
    const unsigned char first = (unsigned char)*at;
    const size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc2 ? 2 : 1;
    size_t found = 1;
    while (found < length && ((unsigned char)at[found] & 0xc0) == 0x80) {
        found++;
    }
    return found == length ? length : 1;
}

/* Turns a text into lower case ASCII, with a blank where a capital follows a small letter. False if
 * it does not fit. */
static bool simplify(const char *text, char simple[NAME_ROOM])
{
    size_t used = 0;
    char before = ' ';
    while (*text != '\0' && used + 16 < NAME_ROOM) {
        size_t length = 1;
        const char *sign = sign_at(text, &length);
        if (sign != NULL) {
            memcpy(simple + used, sign, strlen(sign));
            used += strlen(sign);
            before = ' ';
            text += length;
            continue;
        }
        if (isupper((unsigned char)*text) && islower((unsigned char)before)) {
            simple[used++] = ' ';
        }
        before = *text;
        for (size_t more = character_at(text); more > 0; more--) {
            simple[used++] = (char)tolower((unsigned char)*text++);
        }
    }
    simple[used] = '\0';
    return *text == '\0';
}

static gonio_i_name_word *add_word(gonio_i_words *words)
{
    if (words->count == GONIO_I_MOST_WORDS) {
        words->whole = false;
        return NULL;
    }
    gonio_i_name_word *word = &words->word[words->count++];
    *word = (gonio_i_name_word){.number = 0.0};
    return word;
}

static void add_text(gonio_i_words *words, const char *text, size_t length)
{
    gonio_i_name_word *word = length < GONIO_I_WORD_ROOM ? add_word(words) : NULL;
    words->whole = words->whole && word != NULL;
    if (word != NULL) {
        memcpy(word->text, text, length);
    }
}

/* Adds a number, digits with at most one point. Returns its end. */
static const char *add_number(gonio_i_words *words, const char *at)
{
    char digits[GONIO_I_WORD_ROOM] = "";
    size_t length = strspn(at, "0123456789");
    if (at[length] == '.') {
        length += 1 + strspn(at + length + 1, "0123456789");
    }
    gonio_i_name_word *word = length < sizeof digits ? add_word(words) : NULL;
    words->whole = words->whole && word != NULL;
    if (word != NULL) {
        memcpy(digits, at, length);
        word->number = strtod(digits, NULL);
    }
    return at + length;
}

/* Adds letters. "thetai" is two words: the angle, and a side of up to three letters. */
static void add_letters(gonio_i_words *words, const char *text, size_t length)
{
    static const char *const angles[] = {"theta", "phi"};
    for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
        const size_t first = strlen(angles[k]);
        if (length > first && length <= first + 3 && strncmp(text, angles[k], first) == 0) {
            add_text(words, text, first);
            text += first;
            length -= first;
        }
    }
    add_text(words, text, length);
}

static bool is_letter(char c)
{
    return islower((unsigned char)c) || (unsigned char)c >= 0x80;
}

/* Whether a text begins with a negative number, which is no wavelength. */
static bool is_negative(const char *text)
{
    text += strspn(text, " ");
    return *text == '-' && isdigit((unsigned char)text[1]);
}

void gonio_i_words_split(const char *text, gonio_i_words *words)
{
    char simple[NAME_ROOM] = "";
    words->count = 0;
    words->whole = simplify(text, simple) && !is_negative(text);
    for (const char *at = simple; *at != '\0';) {
        size_t length = 0;
        while (is_letter(at[length])) {
            length++;
        }
        const char *digit = at + (*at == '.');
        if (length > 0) {
            add_letters(words, at, length);
            at += length;
        } else if (isdigit((unsigned char)*digit)) {
            at = add_number(words, at);
        } else {
            at++;
        }
    }
}
