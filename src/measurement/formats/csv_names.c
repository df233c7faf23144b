/* The meaning of a column's name: see csv_names.h. */
#include "csv_names.h"

#include <ctype.h>
#include <string.h>

#include "../rules.h"
#include "csv_factor_names.h"
#include "csv_time.h"

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
    if (gonio_i_take_angle_name(&words, &name)) {
        name.own = is_own_angle(text);
        return name;
    }
    if (gonio_i_take_beta_name(text, &words, &name)) {
        return name;
    }
    if (gonio_i_take_value_name(text, &words, &name)) {
        name.own = is_own_value(text);
        return name;
    }
    double seconds = 0.0;
    if (gonio_i_take_time_name(&words, &seconds)) {
        return (gonio_i_column_name){.kind = GONIO_I_TIME, .own = true, .seconds = seconds};
    }
    return (gonio_i_column_name){0};
}

static bool is_polarisation(const char *text)
{
    static const char *const names[] = {"pol",
                                        "pol_i",
                                        "polarisation",
                                        "polarization",
                                        "polarisation_i",
                                        "polarization_i",
                                        "incident polarisation",
                                        "incident polarization"};
    bool found = false;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        found = found || strcasecmp(text, names[k]) == 0;
    }
    return found;
}

/* A name with a factor in its unit, "BRDF [1e-3 1/sr]". */
static gonio_i_column_name name_of_scaled(const char *text)
{
    char rest[128];
    double factor = 0.0;
    gonio_i_column_name name = {0};
    if (gonio_i_take_factor(text, sizeof rest, rest, &factor)) {
        name = name_of(rest);
        name.factor = factor;
    }
    const bool values = name.kind == GONIO_I_VALUE || name.kind == GONIO_I_DEVIATION;
    return values && name.scale == 0 && !name.relative ? name : (gonio_i_column_name){0};
}

/* Reads the name in small letters, because capitals begin words. */
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
    if (strcasecmp(text, "mark") == 0 || strcasecmp(text, "target") == 0) {
        return (gonio_i_column_name){.kind = GONIO_I_MARK, .own = true};
    }
    if (strcasecmp(text, "geometry") == 0 || strcasecmp(text, "measurement geometry") == 0) {
        return (gonio_i_column_name){.kind = GONIO_I_ANGLE, .index = GONIO_I_NAMED_GEOMETRY};
    }
    if (is_polarisation(text)) {
        return (gonio_i_column_name){.kind = GONIO_I_POLARISATION};
    }
    const gonio_i_column_name name = name_of(text);
    const gonio_i_column_name small = name.kind != GONIO_I_OTHER ? name : name_of_small(text);
    return small.kind != GONIO_I_OTHER ? small : name_of_scaled(text);
}
