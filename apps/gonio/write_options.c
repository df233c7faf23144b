/* The options of writing materials: see write_options.h. */
#include "write_options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { ILLUMINANTS = 3 };

/* Reads three positive numbers separated by commas. */
static bool read_steps(const char *text, double step[3])
{
    for (int k = 0; k < 3; k++) {
        char *end = NULL;
        step[k] = strtod(text, &end);
        if (end == text || !(step[k] >= 0.1 && step[k] <= 90.0) || *end != (k < 2 ? ',' : '\0')) {
            return false;
        }
        text = end + 1;
    }
    return true;
}

/* The index of an illuminant's name; the number of illuminants if there is none. */
static size_t find_illuminant(const char *name)
{
    static const char *const names[] = {
        [GONIO_ILLUMINANT_E] = "E", [GONIO_ILLUMINANT_D65] = "D65", [GONIO_ILLUMINANT_A] = "A"};
    size_t k = 0;
    while (k < ILLUMINANTS && strcasecmp(names[k], name) != 0) {
        k++;
    }
    return k;
}

enum { MOST_WRITERS = 32 };

/* Checks that gonio writes a format. */
static bool check_format(const tool *t, const char *format)
{
    const char *names[MOST_WRITERS + 1] = {NULL};
    int choice = 0;
    for (int k = 0; k < MOST_WRITERS && gonio_material_writer_name(k) != NULL; k++) {
        names[k] = gonio_material_writer_name(k);
    }
    return format == NULL || tool_check_word(t, "--format", format, names, &choice);
}

bool write_options_check(const tool *t, const write_options *options, gonio_write_options *how)
{
    double step[3] = {0.0};
    gonio_write_options_default(how);
    how->format = options->format;
    how->average_azimuths = options->average_azimuths != 0;
    if (!check_format(t, options->format)) {
        return false;
    }
    if (options->illuminant != NULL && find_illuminant(options->illuminant) == ILLUMINANTS) {
        return tool_refuse(t, "--illuminant: '%s' is none of E, D65, A", options->illuminant);
    }
    if (options->steps != NULL && !read_steps(options->steps, step)) {
        return tool_refuse(
            t, "--steps: '%s' is not three steps of 0.1 to 90 degrees, for example 10,5,10",
            options->steps);
    }
    how->theta_i_step = step[0] * M_PI / 180.0;
    how->theta_o_step = step[1] * M_PI / 180.0;
    how->phi_step = step[2] * M_PI / 180.0;
    return true;
}

gonio_status write_options_apply(const tool *t, const write_options *options,
                                 gonio_material *material)
{
    return options->illuminant == NULL
               ? GONIO_OK
               : gonio_material_set_illuminant(
                     t->context, material, (gonio_illuminant)find_illuminant(options->illuminant));
}
