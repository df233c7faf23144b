/* Materials as files: the table of formats, chosen by name or by the file's extension. */
#include <gonio/material.h>

#include <string.h>
#include <strings.h>

#include "../core/core.h"
#include "formats/writers.h"

static const gonio_i_format_writer writers[] = {
    {"merl", ".binary", "MERL table 90 x 90 x 180 of R, G, B; isotropic, reciprocal",
     gonio_material_write_merl},
    {"rgl", ".bsdf", "RGL BSDF of RGB or spectra, for Mitsuba 3 and pbrt-v4 (measured); isotropic",
     gonio_material_write_rgl},
};

enum { WRITERS = sizeof writers / sizeof *writers };

const char *gonio_material_writer_name(int index)
{
    return index >= 0 && index < WRITERS ? writers[index].name : NULL;
}

const char *gonio_material_writer_summary(int index)
{
    return index >= 0 && index < WRITERS ? writers[index].summary : NULL;
}

static const gonio_i_format_writer *find_by_name(const char *name)
{
    for (int k = 0; k < WRITERS; k++) {
        if (strcmp(writers[k].name, name) == 0) {
            return &writers[k];
        }
    }
    return NULL;
}

static const gonio_i_format_writer *find_by_extension(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash != NULL ? slash : path, '.');
    for (int k = 0; dot != NULL && k < WRITERS; k++) {
        if (strcasecmp(writers[k].extension, dot) == 0) {
            return &writers[k];
        }
    }
    return &writers[0];
}

gonio_status gonio_material_write(gonio_context *context, const gonio_material *material,
                                  const char *path, const char *format)
{
    const gonio_i_format_writer *writer =
        format != NULL ? find_by_name(format) : find_by_extension(path);
    if (writer == NULL) {
        char known[256] = "";
        for (int k = 0; k < WRITERS; k++) {
            strncat(known, k > 0 ? ", " : "", sizeof known - strlen(known) - 1);
            strncat(known, writers[k].name, sizeof known - strlen(known) - 1);
        }
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "no format is called '%s'; materials are written as one of: %s", format,
                            known);
    }
    return writer->write(context, material, path);
}
