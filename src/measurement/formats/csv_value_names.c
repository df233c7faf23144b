/* Names of columns of values and deviations: see csv_names.h. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/measurement.h>

#include "csv_factor_names.h"
#include "csv_meaning.h"
#include "csv_names.h"
#include "csv_scale_names.h"

enum {
    COLOUR = 1 << 0,
    QUANTITY = 1 << 1,
    SURE = 1 << 2, /* a quantity without another meaning */
    SPREAD = 1 << 3,
    RELATIVE = 1 << 4,
    STERADIAN = 1 << 5,
    PERCENT = 1 << 6,
    FACTOR = 1 << 7,
    COSINE = 1 << 8,
    NANOMETRE = 1 << 9,
    MICROMETRE = 1 << 10,
    LAMBDA = 1 << 11,
    NUMBER = 1 << 12,
    FILL = 1 << 13,
    POLARISED = 1 << 14
};

enum { NO_QUANTITY, BRDF, FACTORS, VALUE, RHO, REFLECTANCE, F, COUNTS };

static const gonio_i_known_word value_words[] = {
    {"r", COLOUR, 0},
    {"g", COLOUR, 1},
    {"b", COLOUR, 2},
    {"red", COLOUR, 0},
    {"green", COLOUR, 1},
    {"blue", COLOUR, 2},
    {"brdf", QUANTITY | SURE, BRDF},
    {"bsdf", QUANTITY | SURE, BRDF},
    {"fr", QUANTITY | SURE, BRDF},
    {"ccbrdf", QUANTITY | SURE | COSINE, BRDF},
    {"ccbsdf", QUANTITY | SURE | COSINE, BRDF},
    {"cc", COSINE, 0},               /* cosine-corrected */
    {"frdb", QUANTITY | SURE, BRDF}, /* in French */
    {"brf", QUANTITY | SURE | FACTOR, FACTORS},
    {"value", QUANTITY, VALUE},
    {"values", QUANTITY, VALUE},
    {"val", QUANTITY, VALUE},
    {"counts", QUANTITY, COUNTS},
    {"rho", QUANTITY, RHO},
    {"f", QUANTITY, F},
    {"reflectance", QUANTITY, REFLECTANCE},
    {"factor", FACTOR, 0},
    {"factors", FACTOR, 0},
    {"cos", COSINE, 0},
    {"cosine", COSINE, 0},
    {"costheta", COSINE, 0},
    {"brdfcos", QUANTITY | SURE | COSINE, BRDF},
    {"bsdfcos", QUANTITY | SURE | COSINE, BRDF},
    {"s", POLARISED, 1},
    {"spol", POLARISED, 1},
    {"te", POLARISED, 1},
    {"perpendicular", POLARISED, 1},
    {"perp", POLARISED, 1},
    {"p", POLARISED, 2},
    {"ppol", POLARISED, 2},
    {"tm", POLARISED, 2},
    {"parallel", POLARISED, 2},
    {"par", POLARISED, 2},
    {"pol", FILL, 0},
    {"polarised", FILL, 0},
    {"polarized", FILL, 0},
    {"polarisation", FILL, 0},
    {"polarization", FILL, 0},
    {"unpolarised", FILL, 0},
    {"unpolarized", FILL, 0},
    {"deviation", SPREAD, 0},
    {"dev", SPREAD, 0},
    {"stddev", SPREAD, 0},
    {"stdev", SPREAD, 0},
    {"std", SPREAD, 0},
    {"sd", SPREAD, 0},
    {"sigma", SPREAD, 0},
    {"uncertainty", SPREAD, 0},
    {"unc", SPREAD, 0},
    {"u", SPREAD, 0},
    {"relative", RELATIVE, 0},
    {"rel", RELATIVE, 0},
    {"sr", STERADIAN, 0},
    {"steradian", STERADIAN, 0},
    {"percent", PERCENT, 0},
    {"cent", PERCENT, 0}, /* of "per cent" */
    {"nm", NANOMETRE, 0},
    {"nanometre", NANOMETRE, 0},
    {"nanometres", NANOMETRE, 0},
    {"nanometer", NANOMETRE, 0},
    {"nanometers", NANOMETRE, 0},
    {"um", MICROMETRE, 0},
    {"micron", MICROMETRE, 0},
    {"microns", MICROMETRE, 0},
    {"micrometre", MICROMETRE, 0},
    {"micrometres", MICROMETRE, 0},
    {"micrometer", MICROMETRE, 0},
    {"micrometers", MICROMETRE, 0},
    {"lambda", LAMBDA, 0},
    {"wavelength", LAMBDA, 0},
    {"wl", LAMBDA, 0},
    {"per", FILL, 0},
    {"of", FILL, 0},
    {"at", FILL, 0},
    {"the", FILL, 0},
    {"in", FILL, 0},
    {"with", FILL, 0},
    {"times", FILL, 0},
    {"x", FILL, 0},
    {"channel", FILL, 0},
    {"standard", FILL, 0},
    {"bidirectional", FILL, 0},
    {"radiance", FILL, 0},
    {"distribution", FILL, 0},
    {"function", FILL, 0},
    {"corrected", FILL, 0},
    {"linear", FILL, 0},
    {"measured", FILL, 0},
    {"mean", FILL, 0},
    {"average", FILL, 0},
    {"averaged", FILL, 0},
    {"avg", FILL, 0},
};

/* Adds up what words say of values. Returns whether every word does. *number: the number in the
 * name, exponents of units aside. */
static bool hear_value(const gonio_i_words *words, gonio_i_meaning *s, double *number)
{
    bool all = words->whole && words->count > 0;
    *s = (gonio_i_meaning){0};
    *number = 0.0;
    for (size_t k = 0; k < words->count; k++) {
        const gonio_i_name_word *word = &words->word[k];
        const bool beside = (k + 1 < words->count && strcmp(word[1].text, "sr") == 0) ||
                            (k > 0 && strcmp(word[-1].text, "sr") == 0);
        if (word->text[0] == '\0' && beside && word->number == 1.0) {
            continue; /* of 1/sr or sr^-1 */
        }
        if (word->text[0] == '\0') {
            gonio_i_meaning_add(s, NUMBER, 0);
            *number = word->number;
            continue;
        }
        const gonio_i_known_word *w =
            gonio_i_find_word(value_words, sizeof value_words / sizeof *value_words, word->text);
        all = all && w != NULL;
        if (w != NULL) {
            gonio_i_meaning_add(s, w->bits, w->value);
        }
    }
    return all;
}

static int value_of(const gonio_i_meaning *s, unsigned bit)
{
    unsigned place = 0;
    while ((bit & 1U << place) == 0) {
        place++;
    }
    return (s->bits & bit) != 0 ? s->value[place] : 0;
}

static int unit_of_value(const gonio_i_meaning *s)
{
    const unsigned bits = s->bits;
    const bool factor = (bits & FACTOR) != 0;
    return (bits & COSINE) != 0            ? factor ? GONIO_VALUE_FACTOR_COSINE : GONIO_VALUE_COSINE
           : (bits & PERCENT) != 0         ? GONIO_VALUE_PERCENT
           : factor                        ? GONIO_VALUE_FACTOR
           : (bits & STERADIAN) != 0       ? GONIO_VALUE_BRDF
           : value_of(s, QUANTITY) == BRDF ? GONIO_VALUE_BRDF
           : value_of(s, QUANTITY) == COUNTS ? GONIO_VALUE_COUNTS
                                             : 0;
}

/* Takes the angle behind "cos" out of the name: "theta_o", "theta_r", "(theta)". That of the light
 * stays, and so the name is not understood. */
static void take_cosine_angle(gonio_i_words *words)
{
    static const char *const sides[] = {"o", "out", "r", "s", "v"};
    for (size_t k = 1; k < words->count; k++) {
        gonio_i_name_word *word = &words->word[k];
        const bool cosine =
            strncmp(word[-1].text, "cos", 3) == 0 || strncmp(word[-1].text, "brdfcos", 7) == 0;
        if (!cosine || strcmp(word->text, "theta") != 0) {
            continue;
        }
        size_t taken = 1;
        for (size_t j = 0; j < sizeof sides / sizeof *sides && k + 1 < words->count; j++) {
            taken = strcmp(word[1].text, sides[j]) == 0 ? 2 : taken;
        }
        words->count -= taken;
        memmove(word, word + taken, (words->count - k) * sizeof *word);
    }
}

int gonio_i_value_kind_in(const char *text)
{
    gonio_i_words words;
    gonio_i_meaning s;
    double number = 0.0;
    gonio_i_words_split(text, &words);
    take_cosine_angle(&words);
    hear_value(&words, &s, &number);
    return unit_of_value(&s);
}

static int scale_in(const char *text)
{
    gonio_i_words words;
    gonio_i_meaning s;
    double number = 0.0;
    gonio_i_words_split(text, &words);
    const int scale = gonio_i_take_scale(&words);
    return words.count == 0 || hear_value(&words, &s, &number) ? scale : 0;
}

/* "dB" is one word, though a capital begins another. */
int gonio_i_value_scale_in(const char *text)
{
    const char *decibel = strstr(text, "dB");
    char small[128];
    const int length = snprintf(small, sizeof small, "%s", text);
    const bool alone = decibel != NULL && !isalpha((unsigned char)decibel[2]);
    if (alone && length > 0 && (size_t)length < sizeof small) {
        small[decibel + 1 - text] = 'b';
        return scale_in(small);
    }
    return scale_in(text);
}

/* Joins "f_r", the usual symbol of a BRDF, which is not the red channel of f. */
static void join_f_r(const char *text, gonio_i_words *words)
{
    for (size_t k = 1; k < words->count; k++) {
        if (strcmp(words->word[k - 1].text, "f") == 0 && strcmp(words->word[k].text, "r") == 0 &&
            strchr(text, 'R') == NULL) {
            strcpy(words->word[k - 1].text, "fr");
            memmove(&words->word[k], &words->word[k + 1],
                    (words->count - k - 1) * sizeof *words->word);
            words->count--;
        }
    }
}

static bool has_certain_unit(const gonio_i_meaning *s)
{
    return (s->bits & STERADIAN) != 0;
}

static int wavelength_unit(const gonio_i_meaning *s)
{
    return (s->bits & NANOMETRE) != 0    ? GONIO_NANOMETRES
           : (s->bits & MICROMETRE) != 0 ? GONIO_MICROMETRES
                                         : 0;
}

/* Takes the channel: a colour, a wavelength or a number. False if the name has more than one. */
static bool take_channel(const gonio_i_meaning *s, double number, gonio_i_column_name *name)
{
    enum { LEAST_BARE_WAVELENGTH = 100 };
    const bool metres = (s->bits & (NANOMETRE | MICROMETRE)) != 0;
    const bool numbered = (s->bits & NUMBER) != 0;
    const int quantity = value_of(s, QUANTITY);
    const bool alone = quantity == NO_QUANTITY;
    name->quantity = quantity;
    const bool reflectance =
        numbered && number >= LEAST_BARE_WAVELENGTH && s->words == 2 && (s->bits & COLOUR) != 0;
    if (reflectance) { /* R550: the reflectance at 550 nm; Blue_450 */
        name->family = GONIO_I_WAVELENGTH;
        name->wavelength = number;
        return true;
    }
    if ((s->bits & COLOUR) != 0) {
        name->family = GONIO_I_COLOUR;
        name->index = (size_t)value_of(s, COLOUR);
        return !numbered && !metres;
    }
    if (metres || (s->bits & LAMBDA) != 0 ||
        (numbered && (alone || (quantity != VALUE && number >= LEAST_BARE_WAVELENGTH)))) {
        name->family = GONIO_I_WAVELENGTH;
        name->wavelength = number;
        name->wavelength_unit = wavelength_unit(s);
        return numbered && number > 0.0;
    }
    name->family = GONIO_I_UNNAMED;
    name->index = numbered && number < 1e6 ? (size_t)number : 0;
    return !numbered || number == (double)name->index;
}

static gonio_i_strength strength_of(const gonio_i_meaning *s, const gonio_i_column_name *name)
{
    const bool unit =
        (name->unit != 0 && name->unit != GONIO_VALUE_COUNTS) || (s->bits & SURE) != 0;
    const bool likely = name->family == GONIO_I_WAVELENGTH
                            ? name->wavelength_unit != 0 || name->quantity != 0 || unit
                        : name->family == GONIO_I_COLOUR ? name->quantity != 0 || unit
                                                         : unit;
    return has_certain_unit(s) ? GONIO_I_CERTAIN : likely ? GONIO_I_LIKELY : GONIO_I_BARE;
}

/* Takes "wavelength (nm)", without a number. */
static bool take_row_wavelength(const gonio_i_meaning *s, gonio_i_column_name *name)
{
    const unsigned allowed = LAMBDA | NANOMETRE | MICROMETRE | FILL;
    if ((s->bits & LAMBDA) == 0 || (s->bits & ~allowed) != 0) {
        return false;
    }
    name->kind = GONIO_I_ROW_WAVELENGTH;
    name->wavelength_unit = wavelength_unit(s);
    return true;
}

/* L*, a*, b* of CIELAB are no BRDF, and b* is not the blue channel. */
static bool is_cielab(const char *text)
{
    const size_t length = strlen(text);
    return length > 1 && text[length - 1] == '*';
}

/* Whether "s" or "p" can be a polarisation: that of a BRDF, and not the second of "counts/s". */
static bool may_be_polarised(const gonio_i_meaning *s)
{
    const int quantity = value_of(s, QUANTITY);
    const bool channel = (s->bits & (COLOUR | NANOMETRE | MICROMETRE | LAMBDA)) != 0;
    return (s->bits & (POLARISED | SPREAD)) == POLARISED && quantity != COUNTS && quantity != F &&
           (quantity != NO_QUANTITY || channel);
}

bool gonio_i_take_value_name(const char *text, const gonio_i_words *words,
                             gonio_i_column_name *name)
{
    gonio_i_meaning s;
    double number = 0.0;
    gonio_i_words own = *words;
    const int scale = gonio_i_take_scale(&own);
    join_f_r(text, &own);
    take_cosine_angle(&own);
    if (is_cielab(text) || (scale == 0 && gonio_i_names_product(text)) ||
        !hear_value(&own, &s, &number) || (s.twice & (COLOUR | NUMBER | SPREAD | POLARISED)) != 0 ||
        ((s.bits & POLARISED) != 0 && !may_be_polarised(&s))) {
        return false;
    }
    if (scale == 0 && take_row_wavelength(&s, name)) {
        return true;
    }
    const bool spread = (s.bits & SPREAD) != 0;
    const bool named = (s.bits & (COLOUR | NUMBER | QUANTITY)) != 0;
    if (!(spread || named || (s.bits & FACTOR && s.words > 1)) || !take_channel(&s, number, name)) {
        return false;
    }
    if (!spread && (s.bits & RELATIVE) != 0) {
        return false;
    }
    name->kind = spread ? GONIO_I_DEVIATION : GONIO_I_VALUE;
    name->relative = (s.bits & RELATIVE) != 0;
    name->unit = unit_of_value(&s);
    name->scale = scale;
    name->polarisation = value_of(&s, POLARISED);
    name->strength = strength_of(&s, name);
    return true;
}
