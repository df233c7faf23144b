/* Cells that are no plain numbers: see csv_numbers.h. */
#include "csv_numbers.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/csv_reader.h"

/* ---- angles ---- */

/* Signs behind a number, and the part of a degree that it counts. Longer ones come first. */
static const struct {
    const char *text;
    int parts;
} signs[] = {
    {"\xc2\xb0", 1},        {"\xb0", 1},  {"degrees", 1}, {"deg", 1},   {"\xe2\x80\xb2", 60},
    {"\xe2\x80\xb3", 3600}, {"''", 3600}, {"'", 60},      {"\"", 3600},
};

/* Takes a number and its sign. Returns where they end; NULL if they are not there. */
static const char *take_part(const char *at, char delimiter, double *number, int *parts)
{
    char text[32];
    const size_t length = strspn(at, delimiter == ',' ? "+-0123456789." : "+-0123456789.,");
    if (length == 0 || length >= sizeof text) {
        return NULL;
    }
    memcpy(text, at, length);
    text[length] = '\0';
    at += length;
    at += strspn(at, " ");
    for (size_t k = 0; k < sizeof signs / sizeof *signs; k++) {
        const size_t sign = strlen(signs[k].text);
        if (strncasecmp(at, signs[k].text, sign) == 0) {
            *parts = signs[k].parts;
            at += sign;
            at += strspn(at, " .");
            return gonio_i_csv_is_number(text, delimiter, number) ? at : NULL;
        }
    }
    return NULL;
}

bool gonio_i_csv_is_angle(const char *cell, char delimiter, double *degrees)
{
    const bool negative = *cell == '-';
    int before = 0;
    double sum = 0.0;
    for (const char *at = cell; at == cell || *at != '\0';) {
        double number = 0.0;
        int parts = 0;
        at = take_part(at, delimiter, &number, &parts);
        const bool first = before == 0;
        if (at == NULL || parts <= before || (first && parts != 1) || (!first && number < 0.0)) {
            return false;
        }
        sum += fabs(number) / parts;
        before = parts;
    }
    *degrees = negative ? -sum : sum;
    return true;
}

const char *gonio_i_skip_blanks(const char *at)
{
    return at + strspn(at, " \t");
}

bool gonio_i_csv_is_one_of(const char *cell, const char *const *words)
{
    bool found = false;
    for (; *words != NULL && !found; words++) {
        found = strcasecmp(cell, *words) == 0;
    }
    return found;
}

/* ---- missing values ---- */

bool gonio_i_csv_is_empty(const char *cell)
{
    static const char *const words[] = {"", "na", "nan", NULL};
    return !isdigit((unsigned char)*cell) && gonio_i_csv_is_one_of(cell, words);
}

bool gonio_i_csv_is_mark(const char *cell)
{
    static const char *const words[] = {
        "-999",         "-999.0",    "-9999",     "-9999.0", "-99999", "n/a",     "n.a.",
        "null",         "none",      "missing",   "#n/a",    "#na",    "#div/0!", "#value!",
        "#num!",        "#ref!",     "#null!",    "lod",     "bdl",    "<lod>",   "<lod",
        "< lod",        "ovrflw",    "overflow",  "ovfl",    "ovrng",  "sat",     "sat.",
        "over",         "saturated", "overrange", "undef",   "*",      "?",       "\xe2\x80\x93",
        "\xe2\x80\x94", NULL};
    const bool number = isdigit((unsigned char)(*cell == '-' ? cell[1] : *cell));
    if (number && strncmp(cell, "-999", 4) != 0) {
        return false;
    }
    const size_t dashes = strspn(cell, "-");
    return (dashes > 0 && cell[dashes] == '\0') || gonio_i_csv_is_one_of(cell, words);
}
