/* The input files of a command: see inputs.h. */
#include "inputs.h"

#include <stdio.h>
#include <stdlib.h>

gonio_status tool_open_material(const tool *t, const char *path, gonio_material **material)
{
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    const gonio_status status = gonio_file_expect(t->context, path, GONIO_KIND_MATERIAL, &kind);
    return status == GONIO_OK ? gonio_material_open(t->context, path, material) : status;
}

const gonio_readings_options tool_any_values = {.size = sizeof tool_any_values,
                                                .values_needed = true,
                                                .average_repeats = true,
                                                .negative_to_zero = true};

bool tool_names_format(const tool *t, const char *path)
{
    gonio_readings_options how = tool_any_values;
    return tool_convention_of(t, path, &how.as) == GONIO_OK && how.as.format != NULL;
}

gonio_status tool_read_readings(const tool *t, const char *path,
                                const gonio_readings_options *options, gonio_readings **readings)
{
    gonio_readings_options how = *options;
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    gonio_status status = tool_convention_of(t, path, &how.as);
    if (status == GONIO_OK && how.as.format == NULL) {
        status = gonio_file_expect(t->context, path, GONIO_KIND_READINGS, &kind);
    }
    return status == GONIO_OK ? gonio_readings_read(t->context, path, &how, readings) : status;
}

gonio_status tool_keep_read_channels(const tool *t, const gonio_basis *basis,
                                     gonio_readings *readings)
{
    return gonio_basis_describe(basis)->channels == GONIO_SEPARATE
               ? gonio_readings_drop_empty_channels(t->context, readings)
               : GONIO_OK;
}

/* Finds what a file is. If the user names a format of readings, it is readings unless it is a
 * material. */
static gonio_status find_kind(const tool *t, const char *path, gonio_kind *kind)
{
    gonio_readings_options how = tool_any_values;
    gonio_status status = tool_convention_of(t, path, &how.as);
    if (status == GONIO_OK && how.as.format != NULL) {
        status = gonio_file_kind(t->context, path, kind, NULL);
        *kind = *kind == GONIO_KIND_MATERIAL ? *kind : GONIO_KIND_READINGS;
        return status;
    }
    return status == GONIO_OK ? gonio_file_expect(t->context, path,
                                                  GONIO_KIND_MATERIAL | GONIO_KIND_READINGS, kind)
                              : status;
}

gonio_status tool_open_input(const tool *t, const char *path, tool_input *input)
{
    gonio_readings_options how = tool_any_values;
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    *input = (tool_input){.path = path};
    how.instrument = t->instrument;
    const gonio_status status = find_kind(t, path, &kind);
    if (status != GONIO_OK) {
        return status;
    }
    return kind == GONIO_KIND_READINGS ? tool_read_readings(t, path, &how, &input->readings)
                                       : gonio_material_open(t->context, path, &input->material);
}

void tool_close_input(tool_input *input)
{
    gonio_material_free(&input->material);
    gonio_readings_free(&input->readings);
}

/* ---- values at the directions of readings ---- */

/* Counts the directions without a reading of their own. */
static gonio_status count_unread(const tool *t, const gonio_readings *known,
                                 const gonio_readings *at, size_t *unread)
{
    const size_t count = gonio_readings_describe(at)->count;
    bool *read = calloc(count, sizeof *read);
    const gonio_status status =
        read != NULL ? gonio_readings_find(t->context, at, known, read) : GONIO_ERROR_MEMORY;
    *unread = 0;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        *unread += !read[k];
    }
    free(read);
    return status;
}

static bool is_grid(const char *path)
{
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    return gonio_file_expect(NULL, path, GONIO_KIND_MATERIAL, &kind) == GONIO_OK;
}

static gonio_status interpolate(tool *t, const char *path, size_t unread, gonio_readings *at)
{
    gonio_material *material = NULL;
    char text[512];
    gonio_status status = gonio_material_open(t->context, path, &material);
    if (status == GONIO_OK) {
        status = gonio_measure_material(t->context, at, material, NULL);
    }
    if (status == GONIO_OK) {
        snprintf(text, sizeof text,
                 "%s: %zu of %zu directions are none of its own: values are interpolated", path,
                 unread, gonio_readings_describe(at)->count);
        tool_say(&t->messages, GONIO_MESSAGE_NOTE, text);
    }
    gonio_material_free(&material);
    return status;
}

gonio_status tool_take_values(tool *t, const tool_input *from,
                              const gonio_instrument_options *instrument, gonio_readings *at)
{
    size_t unread = 0;
    if (from->material != NULL) {
        return gonio_measure_material(t->context, at, from->material, instrument);
    }
    const gonio_status status = count_unread(t, from->readings, at, &unread);
    if (status == GONIO_OK && unread > 0 && is_grid(from->path)) {
        return interpolate(t, from->path, unread, at);
    }
    return status == GONIO_OK ? gonio_readings_look_up(t->context, at, from->readings) : status;
}

gonio_status tool_read_mesh(const tool *t, const char *path, gonio_mesh **mesh)
{
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    const gonio_status status = gonio_file_expect(t->context, path, GONIO_KIND_MESH, &kind);
    return status == GONIO_OK ? gonio_mesh_read(t->context, path, mesh) : status;
}
