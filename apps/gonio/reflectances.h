/* --albedo-at: the directional-hemispherical reflectance at given incidences. */
#ifndef GONIO_REFLECTANCES_H
#define GONIO_REFLECTANCES_H

#include <jansson.h>

#include "command_line.h"

enum { TOOL_MOST_REFLECTANCES = 16 };

typedef struct tool_reflectances {
    size_t incidences;
    double theta_i[TOOL_MOST_REFLECTANCES]; /* degrees */
} tool_reflectances;

#define TOOL_ALBEDO_AT(text)                                                                       \
    {                                                                                              \
        "albedo-at", '\0', POPT_ARG_STRING, text, 0,                                               \
            "Also say what share of the light from these theta_i is reflected: 0,30,60", "DEGREES" \
    }

/* Reads "0,30,60"; NULL is none. False after an error message. */
bool tool_check_albedo_at(const tool *t, const char *text, tool_reflectances *at);

/* Prints a line for each incidence, or adds them to a JSON object as "reflectance". */
gonio_status tool_reflectances_of_material(const tool *t, const tool_reflectances *at,
                                           const gonio_material *material, json_t *object);

/* The same of a reconstruction with deviations. */
gonio_status tool_reflectances_of_reconstruction(const tool *t, const tool_reflectances *at,
                                                 const gonio_basis *basis,
                                                 const gonio_reconstruction *reconstruction,
                                                 json_t *object);

#endif
