/* Powers of ten in the names of values: see csv_factor_names.h. */
#include "csv_factor_names.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "csv_numbers.h"

static const char times[] = "\xc3\x97"; /* the sign */
static const char dot[] = "\xc2\xb7";

/* Raised digits and signs, and the characters that they stand for. */
static const struct {
    const char *sign;
    char plain;
} raised[] = {{"\xe2\x81\xbb", '-'}, {"\xe2\x81\xba", '+'}, {"\xe2\x81\xb0", '0'},
              {"\xc2\xb9", '1'},     {"\xc2\xb2", '2'},     {"\xc2\xb3", '3'},
              {"\xe2\x81\xb4", '4'}, {"\xe2\x81\xb5", '5'}, {"\xe2\x81\xb6", '6'},
              {"\xe2\x81\xb7", '7'}, {"\xe2\x81\xb8", '8'}, {"\xe2\x81\xb9", '9'}};

/* Takes a raised number; NULL if there is none. */
static const char *take_raised(const char *at, double *power)
{
    char plain[8] = "";
    size_t count = 0;
    for (size_t k = 0; k < sizeof raised / sizeof *raised && count + 1 < sizeof plain;) {
        const size_t length = strlen(raised[k].sign);
        const bool here = strncmp(at, raised[k].sign, length) == 0;
        at += here ? length : 0;
        if (here) {
            plain[count++] = raised[k].plain;
        }
        k = here ? 0 : k + 1;
    }
    char *end = plain;
    *power = strtod(plain, &end);
    return count > 0 && *end == '\0' ? at : NULL;
}

/* Takes a whole number with or without its sign and brackets; NULL if there is none. */
static const char *take_whole(const char *at, double *number)
{
    const bool open = *at == '(' || *at == '{';
    const char *digits = at + open;
    digits += *digits == '-' || *digits == '+';
    const size_t length = strspn(digits, "0123456789");
    *number = strtod(at + open, NULL);
    const char *end = digits + length;
    return length == 0 || length > 3    ? NULL
           : !open                      ? end
           : *end == ')' || *end == '}' ? end + 1
                                        : NULL;
}

/* Takes a power of ten: 10^-3, 10**-3, 10⁻³, 1e-3, e-3. NULL if there is none. */
static const char *take_power(const char *at, double *factor)
{
    double power = 0.0;
    double mantissa = 1.0;
    const char *end = NULL;
    if (strncmp(at, "10", 2) == 0) {
        const char *behind = at + 2;
        end = *behind == '^'                  ? take_whole(behind + 1, &power)
              : strncmp(behind, "**", 2) == 0 ? take_whole(behind + 2, &power)
                                              : take_raised(behind, &power);
    }
    if (end == NULL) {
        const size_t digits = strspn(at, "0123456789.");
        const bool exponent = digits < 8 && (at[digits] == 'e' || at[digits] == 'E');
        char plain[8] = "1";
        if (digits > 0 && digits < 8) {
            memcpy(plain, at, digits);
            plain[digits] = '\0';
        }
        mantissa = strtod(plain, NULL);
        end = exponent ? take_whole(at + digits + 1, &power) : NULL;
    }
    *factor = mantissa * pow(10.0, power);
    return end != NULL && fabs(power) <= 30.0 && *factor > 0.0 ? end : NULL;
}

/* Skips blanks and a sign of multiplication. */
static const char *skip_times(const char *at)
{
    at = gonio_i_skip_blanks(at);
    at += strncmp(at, times, 2) == 0 || strncmp(at, dot, 2) == 0 ? 2 : *at == '*' ? 1 : 0;
    return gonio_i_skip_blanks(at);
}

static bool is_unit(const char *at)
{
    static const char *const units[] = {"sr", "1/sr", "/sr", "/ sr", "1/steradian", "per sr"};
    bool found = false;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
        found = found || strncasecmp(at, units[k], strlen(units[k])) == 0;
    }
    return found;
}

/* Where the sign of multiplication before a place begins; the place itself if there is none. */
static const char *times_before(const char *text, const char *at)
{
    const char *before = at;
    while (before > text && before[-1] == ' ') {
        before--;
    }
    if (before - text >= 2 && memcmp(before - 2, times, 2) == 0) {
        return before - 2;
    }
    const bool star = before > text && before[-1] == '*';
    const bool sign = star || (before > text && strchr("xX", before[-1]) != NULL &&
                               (before - 1 == text || !isalnum((unsigned char)before[-2])));
    return sign ? before - 1 : at;
}

bool gonio_i_take_factor(const char *text, size_t room, char *rest, double *factor)
{
    for (const char *at = text; *at != '\0'; at++) {
        const char *end = NULL;
        const bool begins = at == text || !(isalnum((unsigned char)at[-1]) || at[-1] == '.');
        if (!begins || (end = take_power(at, factor)) == NULL || !is_unit(skip_times(end))) {
            continue;
        }
        const char *from = times_before(text, at);
        const bool inside = from > text && (from[-1] == '(' || from[-1] == '[');
        const size_t before = (size_t)(from - text);
        end = skip_times(end);
        if ((from != at && !inside) || before + 1 + strlen(end) >= room) {
            return false;
        }
        memcpy(rest, text, before);
        rest[before] = ' ';
        memcpy(rest + before + 1, end, strlen(end) + 1);
        return true;
    }
    return false;
}

/* Whether a digit has a sign of multiplication or division at its side. */
static bool is_in_product(const char *text, const char *digit)
{
    const char *before = digit;
    while (before > text && before[-1] == ' ') {
        before--;
    }
    const char *behind = gonio_i_skip_blanks(digit + 1);
    return times_before(text, digit) != digit || (before > text && before[-1] == '/') ||
           (*behind != '\0' && strchr("*\xc3", *behind) != NULL);
}

bool gonio_i_names_product(const char *text)
{
    bool product = false;
    for (const char *at = text; *at != '\0' && !product; at++) {
        product = isdigit((unsigned char)*at) && is_in_product(text, at);
    }
    return product;
}
