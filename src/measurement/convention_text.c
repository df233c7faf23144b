/* Conventions from the text of a command line: see gonio_convention_parse in measurement.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "convention.h"

enum { WORD = 64 };

static gonio_status refuse_word(gonio_context *context, const gonio_i_convention_key *k,
                                const char *word)
{
    char words[256] = "";
    for (const gonio_i_choice *c = k->choices;
         c < k->choices + GONIO_I_MOST_CHOICES && c->word != NULL; c++) {
        const size_t used = strlen(words);
        snprintf(words + used, sizeof words - used, "%s%s", used > 0 ? ", " : "", c->word);
    }
    return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "%s=%s: the choices are %s", k->name, word,
                        words);
}

static gonio_status take_choice(gonio_context *context, const gonio_i_convention_key *k,
                                const char *word, gonio_convention *convention)
{
    for (const gonio_i_choice *c = k->choices;
         c < k->choices + GONIO_I_MOST_CHOICES && c->word != NULL; c++) {
        if (strcmp(c->word, word) == 0) {
            *gonio_i_convention_field(convention, k) = c->value;
            return GONIO_OK;
        }
    }
    return refuse_word(context, k, word);
}

static gonio_status take_format(gonio_context *context, const char *word,
                                gonio_convention *convention)
{
    char words[512] = "";
    for (int k = 0; gonio_readings_format_word(k) != NULL; k++) {
        const char *known = gonio_readings_format_word(k);
        if (strcmp(known, word) == 0) {
            convention->format = known;
            return GONIO_OK;
        }
        const size_t used = strlen(words);
        snprintf(words + used, sizeof words - used, "%s%s", used > 0 ? ", " : "", known);
    }
    return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "format=%s: the choices are %s", word,
                        words);
}

static gonio_status take_sample(gonio_context *context, const char *word,
                                gonio_convention *convention)
{
    char *end = NULL;
    const long number = strtol(word, &end, 10);
    if (end == word || *end != '\0' || number < 1 || number > 1000000) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "sample=%s: the number of a sample, from 1, is expected", word);
    }
    convention->sample = (int)number;
    return GONIO_OK;
}

static gonio_status take_item(gonio_context *context, const char *name, const char *word,
                              gonio_convention *convention)
{
    for (size_t k = 0; k < GONIO_I_CONVENTION_KEYS; k++) {
        if (strcmp(gonio_i_convention_keys[k].name, name) == 0) {
            return take_choice(context, &gonio_i_convention_keys[k], word, convention);
        }
    }
    if (strcmp(name, "format") == 0) {
        return take_format(context, word, convention);
    }
    if (strcmp(name, "sample") == 0) {
        return take_sample(context, word, convention);
    }
    return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                        "'%s': KEY=WORD is expected, with one of the keys angles, mirror, values, "
                        "scale, wavelengths, zeros, sample, format",
                        name);
}

gonio_status gonio_convention_parse(gonio_context *context, const char *text,
                                    gonio_convention *convention)
{
    gonio_convention made = *convention;
    gonio_status status = GONIO_OK;
    for (const char *at = text; *at != '\0' && status == GONIO_OK;) {
        const size_t length = strcspn(at, ",");
        const char *equals = memchr(at, '=', length);
        const size_t named = equals != NULL ? (size_t)(equals - at) : length;
        char name[WORD];
        char word[WORD];
        snprintf(name, sizeof name, "%.*s", (int)(named < WORD ? named : WORD - 1), at);
        const size_t rest = equals != NULL ? length - named - 1 : 0;
        snprintf(word, sizeof word, "%.*s", (int)(rest < WORD ? rest : WORD - 1),
                 equals != NULL ? equals + 1 : "");
        status = take_item(context, name, word, &made);
        at += length;
        at += *at == ',';
    }
    if (status == GONIO_OK) {
        *convention = made;
    }
    return status;
}
