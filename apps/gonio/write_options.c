/* The options of writing materials: see write_options.h. */
#include "write_options.h"

#include <math.h>
#include <stdio.h>
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

/* ---- the mean over azimuths ---- */

static gonio_status read_mean(void *self, gonio_context *context, int theta_h, double *rho)
{
    return gonio_material_read_slab(context, self, theta_h, rho);
}

/* Says what the mean over azimuths lacks of an anisotropic material. */
static gonio_status state_loss(tool *t, gonio_material *material)
{
    const gonio_material_source source = {
        .size = sizeof source, .self = material, .read_slab = read_mean};
    gonio_material *mean = NULL;
    gonio_comparison comparison;
    gonio_status status = gonio_material_create(t->context, gonio_material_name(material),
                                                "mean over azimuths", &source, &mean);
    if (status == GONIO_OK) {
        status = gonio_compare(t->context, material, mean, &comparison);
    }
    if (status == GONIO_OK) {
        char text[256];
        snprintf(text, sizeof text,
                 "the mean over azimuths differs from the anisotropic material by %.1f %% (E6)",
                 comparison.all.value[GONIO_E6]);
        tool_say(&t->messages, GONIO_MESSAGE_NOTE, text);
    }
    gonio_material_free(&mean);
    return status;
}

/* Whether the mean over azimuths was asked for, of a material that has azimuths, in a format that
 * takes it. */
static bool is_averaged(const gonio_material *material, const gonio_write_options *how,
                        const char *output)
{
    return how->average_azimuths && gonio_material_describe(material)->anisotropic &&
           gonio_material_writer_averages(gonio_material_writer_find(output, how->format));
}

gonio_status write_options_state_loss(tool *t, const gonio_write_options *how,
                                      gonio_material *material, const char *output)
{
    return is_averaged(material, how, output) ? state_loss(t, material) : GONIO_OK;
}
