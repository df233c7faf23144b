/* What the name of a column says: see csv_names.h. */
#include "csv_names.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/measurement.h>

#include "../rules.h"
#include "csv_words.h"

/* What a word can say; `value` is a detail of it. */
typedef struct known_word {
    const char *text;
    unsigned bits;
    int value;
} known_word;

/* What a name's words say together. */
typedef struct said {
    unsigned bits;
    unsigned twice; /* bits that were said more than once */
    int value[32];  /* [bit], of the first word that said it */
    size_t words;
} said;

static void say(said *s, unsigned bits, int value)
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

static const known_word *find_word(const known_word *known, size_t count, const char *text)
{
    for (size_t k = 0; k < count; k++) {
        if (strcmp(known[k].text, text) == 0) {
            return &known[k];
        }
    }
    return NULL;
}

/* ---- angles ---- */

enum {
    POLAR = 1 << 0,
    AZIMUTH = 1 << 1,
    INCIDENT = 1 << 2,
    OUTGOING = 1 << 3,
    DIFFERENCE = 1 << 4,
    ANY_ANGLE = 1 << 5, /* of the plane: polar where nothing says azimuth */
    DEGREES = 1 << 6,
    RADIANS = 1 << 7,
    FILLER = 1 << 8
};

static const known_word angle_words[] = {
    {"theta", POLAR, 0},
    {"zenith", POLAR, 0},
    {"polar", POLAR, 0},
    {"phi", AZIMUTH, 0},
    {"azimuth", AZIMUTH, 0},
    {"azimuthal", AZIMUTH, 0},
    {"azim", AZIMUTH, 0},
    {"az", AZIMUTH, 0},
    {"i", INCIDENT, 0},
    {"in", INCIDENT, 0},
    {"inc", INCIDENT, 0},
    {"incident", INCIDENT, 0},
    {"incoming", INCIDENT, 0},
    {"incidence", INCIDENT | ANY_ANGLE, 0},
    {"aoi", INCIDENT | ANY_ANGLE, 0},
    {"light", INCIDENT, 0},
    {"lamp", INCIDENT, 0},
    {"source", INCIDENT, 0},
    {"illumination", INCIDENT, 0},
    {"sun", INCIDENT, 0},
    {"solar", INCIDENT, 0},
    {"sza", INCIDENT | POLAR, 0},
    {"saa", INCIDENT | AZIMUTH, 0},
    {"o", OUTGOING, 0},
    {"out", OUTGOING, 0},
    {"outgoing", OUTGOING, 0},
    {"exitant", OUTGOING, 0},
    {"r", OUTGOING, 0},
    {"refl", OUTGOING, 0},
    {"reflected", OUTGOING, 0},
    {"reflection", OUTGOING, 0},
    {"s", OUTGOING, 0},
    {"sca", OUTGOING, 0},
    {"scat", OUTGOING, 0},
    {"scatter", OUTGOING, 0},
    {"scattered", OUTGOING, 0},
    {"scattering", OUTGOING, 0},
    {"v", OUTGOING, 0},
    {"view", OUTGOING, 0},
    {"viewing", OUTGOING, 0},
    {"viewer", OUTGOING, 0},
    {"observer", OUTGOING, 0},
    {"observation", OUTGOING, 0},
    {"obs", OUTGOING, 0},
    {"det", OUTGOING, 0},
    {"detector", OUTGOING, 0},
    {"detection", OUTGOING, 0},
    {"sensor", OUTGOING, 0},
    {"receiver", OUTGOING, 0},
    {"measure", OUTGOING, 0},
    {"measured", OUTGOING, 0},
    {"measurement", OUTGOING, 0},
    {"vza", OUTGOING | POLAR, 0},
    {"vaa", OUTGOING | AZIMUTH, 0},
    {"difference", DIFFERENCE, 0},
    {"diff", DIFFERENCE, 0},
    {"delta", DIFFERENCE, 0},
    {"relative", DIFFERENCE, 0},
    {"rel", DIFFERENCE, 0},
    {"raa", AZIMUTH | DIFFERENCE, 0},
    {"dphi", AZIMUTH | DIFFERENCE, 0},
    {"deltaphi", AZIMUTH | DIFFERENCE, 0},
    {"phidiff", AZIMUTH | DIFFERENCE, 0},
    {"angle", ANY_ANGLE, 0},
    {"angles", ANY_ANGLE, 0},
    {"direction", FILLER, 0},
    {"of", FILLER, 0},
    {"the", FILLER, 0},
    {"to", FILLER, 0},
    {"deg", DEGREES, 0},
    {"degs", DEGREES, 0},
    {"degree", DEGREES, 0},
    {"degrees", DEGREES, 0},
    {"rad", RADIANS, 0},
    {"rads", RADIANS, 0},
    {"radian", RADIANS, 0},
    {"radians", RADIANS, 0},
};

/* What words say of angles; whether all of them do. */
static bool hear_angle(const gonio_i_words *words, said *s)
{
    bool all = words->whole && words->count > 0;
    *s = (said){0};
    for (size_t k = 0; k < words->count; k++) {
        const known_word *w =
            find_word(angle_words, sizeof angle_words / sizeof *angle_words, words->word[k].text);
        /* "d phi" is a difference of azimuths, phi_d is not */
        const bool leading = k == 0 && strcmp(words->word[k].text, "d") == 0;
        all = all && (w != NULL || leading);
        say(s, w != NULL ? w->bits : leading ? DIFFERENCE : 0, 0);
    }
    return all;
}

static int unit_of_angle(unsigned bits)
{
    const bool both = (bits & DEGREES) != 0 && (bits & RADIANS) != 0;
    return both                    ? 0
           : (bits & DEGREES) != 0 ? GONIO_DEGREES
           : (bits & RADIANS) != 0 ? GONIO_RADIANS
                                   : 0;
}

/* 0 to 3, or the difference; -1 for none. */
static int angle_of(unsigned bits)
{
    const bool in = (bits & INCIDENT) != 0;
    const bool out = (bits & OUTGOING) != 0;
    const bool azimuth = (bits & AZIMUTH) != 0;
    const bool polar = (bits & POLAR) != 0 || ((bits & ANY_ANGLE) != 0 && !azimuth);
    if (polar == azimuth) {
        return -1;
    }
    if (azimuth && in == out) {
        return in || (bits & DIFFERENCE) != 0 ? GONIO_I_AZIMUTH_DIFFERENCE : -1;
    }
    if (in == out || (bits & DIFFERENCE) != 0) {
        return -1;
    }
    return (out ? 2 : 0) + (azimuth ? 1 : 0);
}

static bool take_angle(const gonio_i_words *words, gonio_i_column_name *name)
{
    said s;
    const int angle = hear_angle(words, &s) ? angle_of(s.bits) : -1;
    if (angle < 0) {
        return false;
    }
    name->kind = GONIO_I_ANGLE;
    name->index = (size_t)angle;
    name->unit = unit_of_angle(s.bits);
    return true;
}

int gonio_i_angle_unit_in(const char *text)
{
    gonio_i_words words;
    said s;
    gonio_i_words_split(text, &words);
    hear_angle(&words, &s);
    return unit_of_angle(s.bits);
}

/* ---- values and deviations ---- */

enum {
    COLOUR = 1 << 0,
    QUANTITY = 1 << 1,
    SURE = 1 << 2, /* a quantity that can be nothing else */
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
    FILL = 1 << 13
};

enum { NO_QUANTITY, BRDF, FACTORS, VALUE, RHO, REFLECTANCE, F };

static const known_word value_words[] = {
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
    {"brf", QUANTITY | SURE | FACTOR, FACTORS},
    {"value", QUANTITY, VALUE},
    {"values", QUANTITY, VALUE},
    {"val", QUANTITY, VALUE},
    {"rho", QUANTITY, RHO},
    {"f", QUANTITY, F},
    {"reflectance", QUANTITY, REFLECTANCE},
    {"factor", FACTOR, 0},
    {"factors", FACTOR, 0},
    {"cos", COSINE, 0},
    {"cosine", COSINE, 0},
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
    {"cent", FILL, 0},
    {"channel", FILL, 0},
    {"standard", FILL, 0},
    {"bidirectional", FILL, 0},
    {"radiance", FILL, 0},
    {"distribution", FILL, 0},
    {"function", FILL, 0},
    {"corrected", FILL, 0},
    {"linear", FILL, 0},
    {"measured", FILL, 0},
};

/* What words say of values; whether all of them do. *number is the one that is no exponent. */
static bool hear_value(const gonio_i_words *words, said *s, double *number)
{
    bool all = words->whole && words->count > 0;
    *s = (said){0};
    *number = 0.0;
    for (size_t k = 0; k < words->count; k++) {
        const gonio_i_name_word *word = &words->word[k];
        const bool beside = (k + 1 < words->count && strcmp(word[1].text, "sr") == 0) ||
                            (k > 0 && strcmp(word[-1].text, "sr") == 0);
        if (word->text[0] == '\0' && beside && word->number == 1.0) {
            continue; /* of 1/sr or sr^-1 */
        }
        if (word->text[0] == '\0') {
            say(s, NUMBER, 0);
            *number = word->number;
            continue;
        }
        const known_word *w =
            find_word(value_words, sizeof value_words / sizeof *value_words, word->text);
        all = all && w != NULL;
        if (w != NULL) {
            say(s, w->bits, w->value);
        }
    }
    return all;
}

static int value_of(const said *s, unsigned bit)
{
    unsigned place = 0;
    while ((bit & 1U << place) == 0) {
        place++;
    }
    return (s->bits & bit) != 0 ? s->value[place] : 0;
}

static int unit_of_value(const said *s)
{
    const unsigned bits = s->bits;
    const bool factor = (bits & FACTOR) != 0;
    return (bits & COSINE) != 0            ? factor ? GONIO_VALUE_FACTOR_COSINE : GONIO_VALUE_COSINE
           : (bits & PERCENT) != 0         ? GONIO_VALUE_PERCENT
           : factor                        ? GONIO_VALUE_FACTOR
           : (bits & STERADIAN) != 0       ? GONIO_VALUE_BRDF
           : value_of(s, QUANTITY) == BRDF ? GONIO_VALUE_BRDF
                                           : 0;
}

int gonio_i_value_kind_in(const char *text)
{
    gonio_i_words words;
    said s;
    double number = 0.0;
    gonio_i_words_split(text, &words);
    hear_value(&words, &s, &number);
    return unit_of_value(&s);
}

/* "f_r" is the usual sign of a BRDF, and not the red of f. */
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

static bool has_certain_unit(const said *s)
{
    return (s->bits & STERADIAN) != 0;
}

static int wavelength_unit(const said *s)
{
    return (s->bits & NANOMETRE) != 0    ? GONIO_NANOMETRES
           : (s->bits & MICROMETRE) != 0 ? GONIO_MICROMETRES
                                         : 0;
}

/* A channel by colour, by wavelength or by number; false if a name says more than one. */
static bool take_channel(const said *s, double number, gonio_i_column_name *name)
{
    enum { LEAST_BARE_WAVELENGTH = 100 };
    const bool metres = (s->bits & (NANOMETRE | MICROMETRE)) != 0;
    const bool numbered = (s->bits & NUMBER) != 0;
    const int quantity = value_of(s, QUANTITY);
    const bool alone = quantity == NO_QUANTITY;
    name->quantity = quantity;
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

static gonio_i_strength strength_of(const said *s, const gonio_i_column_name *name)
{
    const bool unit = name->unit != 0 || (s->bits & SURE) != 0;
    const bool likely = name->family == GONIO_I_WAVELENGTH
                            ? name->wavelength_unit != 0 || name->quantity != 0 || unit
                        : name->family == GONIO_I_COLOUR ? name->quantity != 0 || unit
                                                         : unit;
    return has_certain_unit(s) ? GONIO_I_CERTAIN : likely ? GONIO_I_LIKELY : GONIO_I_BARE;
}

/* "wavelength (nm)", without a number. */
static bool take_row_wavelength(const said *s, gonio_i_column_name *name)
{
    const unsigned allowed = LAMBDA | NANOMETRE | MICROMETRE | FILL;
    if ((s->bits & LAMBDA) == 0 || (s->bits & ~allowed) != 0) {
        return false;
    }
    name->kind = GONIO_I_ROW_WAVELENGTH;
    name->wavelength_unit = wavelength_unit(s);
    return true;
}

static bool take_value(const char *text, gonio_i_words *words, gonio_i_column_name *name)
{
    said s;
    double number = 0.0;
    join_f_r(text, words);
    if (!hear_value(words, &s, &number) || (s.twice & (COLOUR | NUMBER | SPREAD)) != 0) {
        return false;
    }
    if (take_row_wavelength(&s, name)) {
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
    name->strength = strength_of(&s, name);
    return true;
}

/* ---- gonio's own names ---- */

static bool ends_own(const char *ending)
{
    return strcasecmp(ending, "_per_sr") == 0 || strcasecmp(ending, "_deviation_per_sr") == 0;
}

static bool is_own_value(const char *text)
{
    const size_t digits = strspn(text, "0123456789.");
    if (strncasecmp(text, "value", 5) == 0) {
        return ends_own(text + 5 + strspn(text + 5, "0123456789"));
    }
    if (digits > 0) {
        return strncasecmp(text + digits, "nm", 2) == 0 && ends_own(text + digits + 2);
    }
    return *text != '\0' && strchr("RGBrgb", *text) != NULL && ends_own(text + 1);
}

static bool is_own_angle(const char *text)
{
    size_t k = 0;
    while (k < 4 && strcasecmp(text, gonio_i_angle_names[k]) != 0) {
        k++;
    }
    return k < 4;
}

static gonio_i_column_name name_of(const char *text)
{
    gonio_i_column_name name = {0};
    gonio_i_words words;
    gonio_i_words_split(text, &words);
    if (take_angle(&words, &name)) {
        name.own = is_own_angle(text);
        return name;
    }
    if (take_value(text, &words, &name)) {
        name.own = is_own_value(text);
        return name;
    }
    return (gonio_i_column_name){0};
}

/* Without capitals, which begin words elsewhere. */
static gonio_i_column_name name_of_small(const char *text)
{
    char small[128];
    size_t k = 0;
    while (k + 1 < sizeof small && text[k] != '\0') {
        small[k] = (char)tolower((unsigned char)text[k]);
        k++;
    }
    small[k] = '\0';
    return text[k] == '\0' ? name_of(small) : (gonio_i_column_name){0};
}

gonio_i_column_name gonio_i_column_name_of(const char *text)
{
    if (strcasecmp(text, "channel") == 0) {
        return (gonio_i_column_name){.kind = GONIO_I_PLANNED, .own = true};
    }
    const gonio_i_column_name name = name_of(text);
    return name.kind != GONIO_I_OTHER ? name : name_of_small(text);
}
