/* Readings from text, for the tests. */
#ifndef MADE_READINGS_H
#define MADE_READINGS_H

#include <stdio.h>

#include <gonio/gonio.h>

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

#endif
