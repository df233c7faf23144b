/* Names of columns of angles: see csv_names.h. */
#include <string.h>

#include <gonio/measurement.h>

#include "csv_meaning.h"
#include "csv_names.h"

enum {
    POLAR = 1 << 0,
    AZIMUTH = 1 << 1,
    INCIDENT = 1 << 2,
    OUTGOING = 1 << 3,
    DIFFERENCE = 1 << 4,
    ANY_ANGLE = 1 << 5, /* an angle in the plane: polar unless a word says azimuth */
    DEGREES = 1 << 6,
    RADIANS = 1 << 7,
    FILLER = 1 << 8,
    SPECULAR = 1 << 9,
    FROM = 1 << 10,
    TOWARDS_NORMAL = 1 << 11,
    ROTATION = 1 << 12,
    SAMPLE = 1 << 13,
    WORD = 1 << 14, /* an azimuth of both sides, where none is named; phi alone may be any angle */
    PHASE = 1 << 15,
    HALF = 1 << 16,
    DIFFERENCE_VECTOR = 1 << 17, /* "d" behind another word */
    WRITTEN = 1 << 18,           /* a difference that is no delta */
    GRADIANS = 1 << 19,
    ELEVATION = 1 << 20 /* a polar angle from the surface */
};

static const gonio_i_known_word angle_words[] = {
    {"theta", POLAR, 0},
    {"th", POLAR, 0},
    {"zenith", POLAR, 0},
    {"zenit", POLAR, 0},
    {"zenitwinkel", POLAR, 0},
    {"polar", POLAR, 0},
    {"elevation", POLAR | ELEVATION, 0},
    {"elev", POLAR | ELEVATION, 0},
    {"phi", AZIMUTH, 0},
    {"ph", AZIMUTH, 0},
    {"azimuth", AZIMUTH | WORD, 0},
    {"azimut", AZIMUTH | WORD, 0},
    {"azimutwinkel", AZIMUTH | WORD, 0},
    {"azimuthal", AZIMUTH, 0},
    {"azim", AZIMUTH, 0},
    {"az", AZIMUTH, 0},
    {"i", INCIDENT, 0},
    {"in", INCIDENT, 0},
    {"inc", INCIDENT | ANY_ANGLE, 0},
    {"incident", INCIDENT, 0},
    {"incoming", INCIDENT, 0},
    {"incidence", INCIDENT | ANY_ANGLE, 0},
    {"einfall", INCIDENT, 0},
    {"einfallswinkel", INCIDENT | ANY_ANGLE, 0},
    {"aoi", INCIDENT | ANY_ANGLE, 0},
    {"l", INCIDENT, 0},
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
    {"scatter", OUTGOING | ANY_ANGLE, 0},
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
    {"detektor", OUTGOING, 0},
    {"detektorwinkel", OUTGOING | ANY_ANGLE, 0},
    {"ausfallswinkel", OUTGOING | ANY_ANGLE, 0},
    {"beobachtung", OUTGOING, 0},
    {"beobachtungswinkel", OUTGOING | ANY_ANGLE, 0},
    {"streuwinkel", OUTGOING | ANY_ANGLE, 0},
    {"aos", OUTGOING | ANY_ANGLE, 0},
    {"vza", OUTGOING | POLAR, 0},
    {"vaa", OUTGOING | AZIMUTH, 0},
    {"emission", OUTGOING | ANY_ANGLE, 0},
    {"emergence", OUTGOING | ANY_ANGLE, 0},
    {"\xe5\x85\xa5\xe5\xb0\x84\xe8\xa7\x92", INCIDENT | ANY_ANGLE, 0}, /* in Japanese: incidence, */
    {"\xe5\x8f\x8d\xe5\xb0\x84\xe8\xa7\x92", OUTGOING | ANY_ANGLE, 0}, /* reflection, */
    {"\xe5\x8f\x97\xe5\x85\x89\xe8\xa7\x92", OUTGOING | ANY_ANGLE, 0}, /* receiving angle */
    {"r\xc3\xa9"
     "flexion",
     OUTGOING, 0},
    {"reflexion", OUTGOING, 0},
    {"phase", PHASE, 0},
    {"h", HALF, 0},
    {"half", HALF, 0},
    {"difference", DIFFERENCE | WRITTEN, 0},
    {"diff", DIFFERENCE | WRITTEN, 0},
    {"delta", DIFFERENCE, 0},
    {"relative", DIFFERENCE, 0},
    {"rel", DIFFERENCE, 0},
    {"raa", AZIMUTH | DIFFERENCE, 0},
    {"dphi", AZIMUTH | DIFFERENCE, 0},
    {"deltaphi", AZIMUTH | DIFFERENCE, 0},
    {"phidiff", AZIMUTH | DIFFERENCE, 0},
    {"specular", SPECULAR, 0},
    {"mirror", SPECULAR, 0},
    {"aspecular", SPECULAR | FROM | TOWARDS_NORMAL, 0},
    {"from", FROM, 0},
    {"off", FROM, 0},
    {"offset", FROM, 0},
    {"rotation", ROTATION, 0},
    {"rot", ROTATION, 0},
    {"turntable", ROTATION, 0},
    {"sample", SAMPLE, 0},
    {"stage", SAMPLE, 0},
    {"angle", ANY_ANGLE, 0},
    {"angles", ANY_ANGLE, 0},
    {"winkel", ANY_ANGLE, 0},
    {"direction", FILLER, 0},
    {"of", FILLER, 0},
    {"de", FILLER, 0},
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
    {"gon", GRADIANS, 0},
    {"gons", GRADIANS, 0},
    {"gradian", GRADIANS, 0},
    {"gradians", GRADIANS, 0},
    {"grad", DEGREES | GRADIANS, 0},
};

/* Adds up what words say of angles. Returns whether every word does. */
static bool hear_angle(const gonio_i_words *words, gonio_i_meaning *s)
{
    bool all = words->whole && words->count > 0;
    *s = (gonio_i_meaning){0};
    for (size_t k = 0; k < words->count; k++) {
        const gonio_i_known_word *w = gonio_i_find_word(
            angle_words, sizeof angle_words / sizeof *angle_words, words->word[k].text);
        /* "d phi" is a difference of azimuths, phi_d is that of the difference vector */
        const bool d = strcmp(words->word[k].text, "d") == 0;
        if (d && k + 1 < words->count && strcmp(words->word[k + 1].text, "incidence") == 0) {
            continue; /* "angle d'incidence" */
        }
        all = all && (w != NULL || d);
        gonio_i_meaning_add(s,
                            w != NULL ? w->bits
                            : !d      ? 0
                            : k == 0  ? DIFFERENCE
                                      : DIFFERENCE_VECTOR,
                            0);
    }
    return all;
}

static int unit_of_angle(unsigned bits)
{
    const unsigned unit = bits & (DEGREES | RADIANS | GRADIANS);
    return unit == DEGREES                ? GONIO_DEGREES
           : unit == RADIANS              ? GONIO_RADIANS
           : unit == GRADIANS             ? GONIO_GRADIANS
           : unit == (DEGREES | GRADIANS) ? GONIO_I_DEGREES_OR_GRADIANS
                                          : 0;
}

/* An angle from the mirror direction in the plane; -1 for none. */
static int angle_from_specular(unsigned bits)
{
    if ((bits & (AZIMUTH | INCIDENT)) != 0 || (bits & (FROM | DIFFERENCE)) == 0) {
        return -1;
    }
    return (bits & TOWARDS_NORMAL) != 0 ? GONIO_I_ASPECULAR : GONIO_I_FROM_SPECULAR;
}

/* The rotation of the sample, and not the number of a sample; -1 for none. */
static int rotation_of(unsigned bits)
{
    const bool other = (bits & (INCIDENT | OUTGOING | POLAR | DIFFERENCE)) != 0;
    const bool turned = (bits & (ROTATION | AZIMUTH | ANY_ANGLE)) != 0;
    return turned && !other ? GONIO_I_SAMPLE_ROTATION : -1;
}

/* An angle of the half vector or of the difference; -1 for none. */
static int angle_of_half(unsigned bits)
{
    const bool other = (bits & (INCIDENT | OUTGOING | FROM)) != 0;
    const bool polar = (bits & POLAR) != 0;
    const bool half = (bits & HALF) != 0;
    const int angle = half && polar ? GONIO_I_THETA_H
                      : half        ? GONIO_I_PHI_H
                      : polar       ? GONIO_I_THETA_D
                                    : GONIO_I_PHI_D;
    return polar == ((bits & AZIMUTH) != 0) || other ? -1 : angle;
}

/* The number of an angle, 0 to 3, or one of those behind them; -1 for none. */
static int angle_of(unsigned bits)
{
    const bool in = (bits & INCIDENT) != 0;
    const bool out = (bits & OUTGOING) != 0;
    const bool azimuth = (bits & AZIMUTH) != 0;
    const bool polar = (bits & POLAR) != 0 || ((bits & ANY_ANGLE) != 0 && !azimuth);
    if ((bits & PHASE) != 0) {
        return in || out || azimuth || (bits & POLAR) != 0 ? -1 : GONIO_I_PHASE;
    }
    if ((bits & (HALF | DIFFERENCE_VECTOR)) != 0) {
        return angle_of_half(bits);
    }
    if ((bits & SPECULAR) != 0) {
        return angle_from_specular(bits);
    }
    if ((bits & (ROTATION | SAMPLE)) != 0) {
        return rotation_of(bits);
    }
    if (polar == azimuth || (bits & FROM) != 0) {
        return -1;
    }
    if (azimuth && in == out) {
        return in || (bits & (DIFFERENCE | WORD)) != 0 ? GONIO_I_AZIMUTH_DIFFERENCE : -1;
    }
    if (!in && !out && (bits & POLAR) != 0 && (bits & WRITTEN) != 0) {
        return GONIO_I_THETA_D;
    }
    if (in == out || (bits & DIFFERENCE) != 0) {
        return -1;
    }
    return (out ? 2 : 0) + (azimuth ? 1 : 0);
}

/* ---- x, y and z of directions ---- */

enum { EITHER_SIDE = -1 };

static const gonio_i_known_word side_words[] = {
    {"wi", 0, 0},
    {"i", 0, 0},
    {"in", 0, 0},
    {"incident", 0, 0},
    {"incoming", 0, 0},
    {"l", 0, 0},
    {"light", 0, 0},
    {"source", 0, 0},
    {"lamp", 0, 0},
    {"sun", 0, 0},
    {"wo", 0, 1},
    {"o", 0, 1},
    {"out", 0, 1},
    {"outgoing", 0, 1},
    {"wr", 0, 1},
    {"v", 0, 1},
    {"view", 0, 1},
    {"viewer", 0, 1},
    {"observer", 0, 1},
    {"detector", 0, 1},
    {"det", 0, 1},
    {"camera", 0, 1},
    {"omega", 0, EITHER_SIDE},
    {"w", 0, EITHER_SIDE},
    {"dir", 0, EITHER_SIDE},
    {"direction", 0, EITHER_SIDE},
    {"vector", 0, EITHER_SIDE},
    {"vec", 0, EITHER_SIDE},
};

/* The direction that words before x, y or z are of: 0 incident, 1 outgoing; -1 for none. */
static int side_of(const gonio_i_name_word *word, size_t count)
{
    int side = EITHER_SIDE;
    for (size_t k = 0; k < count; k++) {
        const gonio_i_known_word *w =
            gonio_i_find_word(side_words, sizeof side_words / sizeof *side_words, word[k].text);
        if (w == NULL || (w->value != EITHER_SIDE && side != EITHER_SIDE)) {
            return -1;
        }
        side = w->value != EITHER_SIDE ? w->value : side;
    }
    return side;
}

/* "wi_x", "lightY", "woz": the index of a component; -1 for none. */
static int component_of(const gonio_i_words *words)
{
    gonio_i_words rest = *words;
    char *last = words->whole && words->count > 0 ? rest.word[rest.count - 1].text : NULL;
    const size_t length = last != NULL ? strlen(last) : 0;
    if (length == 0 || last[length - 1] < 'x' || last[length - 1] > 'z') {
        return -1;
    }
    const int component = last[length - 1] - 'x';
    last[length - 1] = '\0';
    const int side = side_of(rest.word, length > 1 ? rest.count : rest.count - 1);
    return side >= 0 ? GONIO_I_VECTORS + 3 * side + component : -1;
}

/* "ux_i", "kz o": the index of a component whose side is behind it; -1 for none. */
static int component_before(const gonio_i_words *words)
{
    const char *first = words->whole && words->count == 2 ? words->word[0].text : "";
    const size_t length = strlen(first);
    const char last = length > 0 ? first[length - 1] : '\0';
    if (length == 0 || length > 2 || last < 'x' || last > 'z' ||
        (length == 2 && strchr("ukndv", first[0]) == NULL)) {
        return -1;
    }
    const int side = side_of(&words->word[1], 1);
    return side >= 0 ? GONIO_I_VECTORS + 3 * side + (last - 'x') : -1;
}

/* ---- all ---- */

bool gonio_i_take_angle_name(const gonio_i_words *words, gonio_i_column_name *name)
{
    gonio_i_meaning s;
    int angle = hear_angle(words, &s) ? angle_of(s.bits) : component_of(words);
    angle = angle < 0 ? component_before(words) : angle;
    if (angle < 0) {
        return false;
    }
    name->kind = GONIO_I_ANGLE;
    name->index = (size_t)angle;
    name->unit = unit_of_angle(s.bits);
    name->complement = (s.bits & ELEVATION) != 0;
    return !name->complement || angle == 0 || angle == 2;
}

bool gonio_i_names_azimuth(const char *text)
{
    gonio_i_words words;
    gonio_i_meaning s;
    gonio_i_words_split(text, &words);
    hear_angle(&words, &s);
    return (s.bits & AZIMUTH) != 0;
}

int gonio_i_angle_unit_in(const char *text)
{
    gonio_i_words words;
    gonio_i_meaning s;
    gonio_i_words_split(text, &words);
    hear_angle(&words, &s);
    return unit_of_angle(s.bits);
}
