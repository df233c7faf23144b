/* Opening materials: built-in ones by name, files by content. */
#include <gonio/material.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "built_in.h"
#include "formats/format.h"

#define ROW(name) &gonio_i_##name##_reader,
static const gonio_i_format_reader *const readers[] = {GONIO_I_MATERIAL_READERS(ROW)};

enum { READERS = sizeof readers / sizeof *readers };

static const gonio_i_format_reader *find_reader(const gonio_i_file *file)
{
    for (int k = 0; k < READERS; k++) {
        if (readers[k]->recognises(file)) {
            return readers[k];
        }
    }
    return NULL;
}

const char *gonio_i_material_format_of(const gonio_i_file *file)
{
    const gonio_i_format_reader *reader = find_reader(file);
    return reader != NULL && !reader->readings ? reader->name : NULL;
}

const char *gonio_i_material_format_of_readings(const gonio_i_file *file)
{
    const gonio_i_format_reader *reader = find_reader(file);
    return reader != NULL && reader->readings ? reader->name : NULL;
}

const char *gonio_i_material_format_name(int index)
{
    const gonio_i_format_reader *reader = index >= 0 && index < READERS ? readers[index] : NULL;
    return reader != NULL ? reader->name : NULL;
}

static gonio_status not_recognised(gonio_context *context, const gonio_i_file *file)
{
    if (file->size == 0) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: the file is empty", file->path);
    }
    char known[256] = "";
    const char *name = NULL;
    for (int k = 0; (name = gonio_i_material_format_name(k)) != NULL; k++) {
        const size_t length = strlen(known);
        snprintf(known + length, sizeof known - length, "%s%s", k > 0 ? ", " : "", name);
    }
    return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                        "%s: not a material that gonio reads (%s), judged by its content",
                        file->path, known);
}

static gonio_status open_file(gonio_context *context, const gonio_i_file *file,
                              gonio_material **material)
{
    const gonio_i_format_reader *reader = find_reader(file);
    if (reader == NULL) {
        return not_recognised(context, file);
    }
    gonio_material_source source = {0};
    char *description = NULL;
    gonio_status status = reader->open(context, file, &source, &description);
    if (status != GONIO_OK) {
        return status;
    }
    source.size = sizeof source;
    char *name = gonio_i_base_name(file->path, false);
    status = name == NULL || description == NULL
                 ? gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory")
                 : gonio_material_create(context, name, description, &source, material);
    if (status != GONIO_OK) {
        source.release(source.self);
    }
    free(name);
    free(description);
    return status;
}

gonio_status gonio_material_open(gonio_context *context, const char *path,
                                 gonio_material **material)
{
    static const char atlas[] = "atlas:";
    if (strncmp(path, atlas, sizeof atlas - 1) == 0) {
        return gonio_i_built_in_open(context, path + sizeof atlas - 1, material);
    }
    gonio_i_file file = {0};
    const gonio_status status = gonio_i_file_look(context, path, &file);
    return status != GONIO_OK ? status : open_file(context, &file, material);
}
