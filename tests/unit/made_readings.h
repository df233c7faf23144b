/* Readings for the tests: from numbers, and, where files are tested, from text. */
#ifndef MADE_READINGS_H
#define MADE_READINGS_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

/* theta_i, phi_i, theta_o, phi_o in degrees. */
static inline gonio_pair made_pair(const double degrees[4])
{
    const double radians = M_PI / 180.0;
    return (gonio_pair){{degrees[0] * radians, degrees[1] * radians},
                        {degrees[2] * radians, degrees[3] * radians}};
}

/* Readings of channels with the given wavelengths, or NULL. row[count][4 + channels]: four angles
 * in degrees, then the values; values may be missing altogether (has_values false: row[count][4]).
 */
static inline gonio_readings *made_spectra(const double *row, size_t count, size_t channels,
                                           const double *wavelength, bool has_values)
{
    const gonio_readings_options any = {
        .size = sizeof any, .average_repeats = true, .negative_to_zero = true};
    const size_t width = 4 + (has_values ? channels : 0);
    gonio_pair *pair = calloc(count, sizeof *pair);
    double *value = calloc(count * channels, sizeof *value);
    assert_true(pair != NULL && value != NULL);
    for (size_t k = 0; k < count; k++) {
        pair[k] = made_pair(row + k * width);
        for (size_t c = 0; c < channels && has_values; c++) {
            value[k * channels + c] = row[k * width + 4 + c];
        }
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = count,
                                          .channels = channels,
                                          .pair = pair,
                                          .wavelength = wavelength,
                                          .value = has_values ? value : NULL};
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_create(NULL, &arrays, &any, &readings), GONIO_OK);
    free(value);
    free(pair);
    return readings;
}

/* Readings of R, G, B. row[count][7] */
static inline gonio_readings *made_colours(const double (*row)[7], size_t count)
{
    return made_spectra(&row[0][0], count, GONIO_CHANNELS, NULL, true);
}

/* Directions without values. row[count][4] */
static inline gonio_readings *made_directions(const double (*row)[4], size_t count)
{
    return made_spectra(&row[0][0], count, GONIO_CHANNELS, NULL, false);
}

/* Writes the text to a file of the folder and reads it; *readings is NULL after an error. */
static inline gonio_status made_readings(gonio_context *context, const char *folder,
                                         const char *name, const char *text,
                                         const gonio_readings_options *options,
                                         gonio_readings **readings)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    *readings = NULL;
    return gonio_readings_read(context, path, options, readings);
}

/* A text that is refused: with which status, and what the message holds. */
typedef struct made_bad_file {
    const char *text;
    gonio_status status;
    const char *message;
} made_bad_file;

/* Each file is refused as it should be, and leaves no readings. */
static inline void assert_bad_files(const char *name, const made_bad_file *file, size_t count)
{
    char *folder = support_folder();
    gonio_context *context = support_context();
    for (size_t k = 0; k < count; k++) {
        gonio_readings *readings = NULL;
        const gonio_status status =
            made_readings(context, folder, name, file[k].text, NULL, &readings);
        if (status != file[k].status || strstr(support_message(), file[k].message) == NULL) {
            fail_msg("case %zu: status %d, '%s'; expected %d, '%s'", k, (int)status,
                     support_message(), (int)file[k].status, file[k].message);
        }
        assert_null(readings);
    }
    gonio_context_free(&context);
    support_remove(folder);
}

#endif
