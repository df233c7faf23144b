/* Writing materials: the table of formats, chosen by name or by the file's extension. */
#include <gonio/material.h>

#include <string.h>
#include <strings.h>

#include "../core/core.h"
#include "../core/options.h"
#include "formats/writers.h"

#define ROW(name) &gonio_i_##name##_writer,
static const gonio_i_format_writer *const writers[] = {GONIO_I_MATERIAL_WRITERS(ROW)};

enum { WRITERS = sizeof writers / sizeof *writers };

void gonio_write_options_default_of(gonio_write_options *options, size_t size)
{
    const gonio_write_options usual = {0};
    gonio_i_give(&usual, sizeof usual, options, size);
}

const char *gonio_material_writer_name(int index)
{
    return index >= 0 && index < WRITERS ? writers[index]->name : NULL;
}

const char *gonio_material_writer_extension(int index)
{
    return index >= 0 && index < WRITERS ? writers[index]->extension : NULL;
}

const char *gonio_material_writer_summary(int index)
{
    return index >= 0 && index < WRITERS ? writers[index]->summary : NULL;
}

bool gonio_material_writer_averages(int index)
{
    return index >= 0 && index < WRITERS && writers[index]->averages;
}

static int find_by_name(const char *name)
{
    for (int k = 0; k < WRITERS; k++) {
        if (strcmp(writers[k]->name, name) == 0) {
            return k;
        }
    }
    return -1;
}

static int find_by_extension(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash != NULL ? slash : path, '.');
    for (int k = 0; dot != NULL && k < WRITERS; k++) {
        if (strcasecmp(writers[k]->extension, dot) == 0) {
            return k;
        }
    }
    return 0;
}

int gonio_material_writer_find(const char *path, const char *format)
{
    return format != NULL ? find_by_name(format) : find_by_extension(path);
}

gonio_status gonio_material_write(gonio_context *context, const gonio_material *material,
                                  const char *path, const gonio_write_options *options)
{
    gonio_write_options how;
    const gonio_status status = GONIO_I_TAKE(context, gonio_write_options, options, &how);
    if (status != GONIO_OK) {
        return status;
    }
    const int writer = gonio_material_writer_find(path, how.format);
    if (writer < 0) {
        char known[256] = "";
        for (int k = 0; k < WRITERS; k++) {
            strncat(known, k > 0 ? ", " : "", sizeof known - strlen(known) - 1);
            strncat(known, writers[k]->name, sizeof known - strlen(known) - 1);
        }
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "no format is called '%s'; materials are written as one of: %s",
                            how.format, known);
    }
    const gonio_material_view *view = gonio_material_describe(material);
    if (writers[writer]->isotropic && view->anisotropic && !how.average_azimuths) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%s: anisotropic, which files of '%s' cannot hold; .bsdf, .h5, .xml "
                            "and .csv can, and --average-azimuths writes the mean",
                            view->name, writers[writer]->name);
    }
    return writers[writer]->write(context, material, path, &how);
}
