/* Conventions as words and sentences: see convention.h. */
#include "convention.h"

#include <stddef.h>

const gonio_i_convention_key gonio_i_convention_keys[GONIO_I_CONVENTION_KEYS] = {
    {"angles",
     offsetof(gonio_convention, angles),
     {{"degrees", GONIO_DEGREES, "angles in degrees"},
      {"radians", GONIO_RADIANS, "angles in radians"},
      {"gon", GONIO_GRADIANS, "angles in gon"}}},
    {"mirror",
     offsetof(gonio_convention, mirror),
     {{"180", GONIO_MIRROR_180, NULL},
      {"0", GONIO_MIRROR_0, "phi_o = phi_i on the mirror's side"}}},
    {"values",
     offsetof(gonio_convention, values),
     {{"brdf", GONIO_VALUE_BRDF, "values in 1/sr"},
      {"factor", GONIO_VALUE_FACTOR, "reflectance factors (divided by pi)"},
      {"percent", GONIO_VALUE_PERCENT, "reflectance factors in per cent (divided by 100 pi)"},
      {"cosine", GONIO_VALUE_COSINE, "values with cos theta_o (divided by it)"},
      {"factor-cosine", GONIO_VALUE_FACTOR_COSINE,
       "reflectance factors with cos theta_o (divided by pi cos theta_o)"},
      {"relative", GONIO_VALUE_RELATIVE, "values relative to a reference (divided by pi)"},
      {"counts", GONIO_VALUE_COUNTS, "counts (divided by those of 1/sr and cos theta_o)"}}},
    {"scale",
     offsetof(gonio_convention, scale),
     {{"linear", GONIO_SCALE_LINEAR, NULL},
      {"log10", GONIO_SCALE_LOG10, "as logarithms (base 10)"},
      {"ln", GONIO_SCALE_LN, "as natural logarithms"},
      {"db", GONIO_SCALE_DECIBEL, "in decibels (10 log10)"}}},
    {"wavelengths",
     offsetof(gonio_convention, wavelengths),
     {{"nm", GONIO_NANOMETRES, NULL},
      {"um", GONIO_MICROMETRES, "wavelengths in micrometres"},
      {"m", GONIO_METRES, "wavelengths in metres"}}},
    {"zeros",
     offsetof(gonio_convention, zeros),
     {{"missing", GONIO_ZEROS_MISSING, "0 means not measured"}, {"dark", GONIO_ZEROS_DARK, NULL}}},
};

int *gonio_i_convention_field(gonio_convention *convention, const gonio_i_convention_key *key)
{
    return (int *)(void *)((char *)convention + key->offset);
}

static int value_of(const gonio_convention *convention, const gonio_i_convention_key *key)
{
    return *(const int *)(const void *)((const char *)convention + key->offset);
}

gonio_convention gonio_i_convention_of(const gonio_convention *stated,
                                       const gonio_convention *given)
{
    gonio_convention taken = *stated;
    for (size_t k = 0; k < GONIO_I_CONVENTION_KEYS; k++) {
        if (value_of(given, &gonio_i_convention_keys[k]) != GONIO_AS_STATED) {
            *gonio_i_convention_field(&taken, &gonio_i_convention_keys[k]) =
                value_of(given, &gonio_i_convention_keys[k]);
        }
    }
    taken.format = given->format;
    taken.sample = given->sample;
    return taken;
}

void gonio_i_convention_print(const gonio_convention *convention, FILE *stream)
{
    const char *between = "";
    for (size_t k = 0; k < GONIO_I_CONVENTION_KEYS; k++) {
        for (const gonio_i_choice *c = gonio_i_convention_keys[k].choices;
             c < gonio_i_convention_keys[k].choices + GONIO_I_MOST_CHOICES; c++) {
            if (c->sentence != NULL &&
                c->value == value_of(convention, &gonio_i_convention_keys[k])) {
                fprintf(stream, "%s%s", between, c->sentence);
                between = ", ";
            }
        }
    }
}
