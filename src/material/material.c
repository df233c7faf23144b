/* Materials: opening by content, built-in ones, and reading slab by slab. */
#include <gonio/atlas.h>
#include <gonio/material.h>

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <xxhash.h>

#include "../core/core.h"
#include "formats/format.h"

struct gonio_material {
    char *name;
    char *format;
    gonio_material_source source;
};

struct gonio_fingerprint {
    XXH3_state_t *state;
};

static const gonio_i_format_reader *const readers[] = {
    &gonio_i_merl_reader,
    &gonio_i_neural_reader,
};

enum { READERS = sizeof readers / sizeof *readers };

gonio_status gonio_material_create(gonio_context *context, const char *name, const char *format,
                                   gonio_material_source source, gonio_material **material)
{
    gonio_material *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->name = strdup(name);
    made->format = strdup(format);
    if (made->name == NULL || made->format == NULL) {
        gonio_material_free(&made);
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    made->source = source;
    *material = made;
    return GONIO_OK;
}

void gonio_material_free(gonio_material **material)
{
    if (material == NULL || *material == NULL) {
        return;
    }
    if ((*material)->source.release != NULL) {
        (*material)->source.release((*material)->source.self);
    }
    free((*material)->name);
    free((*material)->format);
    free(*material);
    *material = NULL;
}

const char *gonio_material_name(const gonio_material *material)
{
    return material->name;
}

const char *gonio_material_format(const gonio_material *material)
{
    return material->format;
}

gonio_status gonio_material_read_slab(const gonio_material *material, gonio_context *context,
                                      int theta_h, double *rho)
{
    if (theta_h < 0 || theta_h >= GONIO_THETA_H_BINS) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "theta_h index %d outside 0 .. 89",
                            theta_h);
    }
    return material->source.read_slab(material->source.self, context, theta_h, rho);
}

static gonio_status read_atlas_slab(void *self, gonio_context *context, int theta_h, double *rho)
{
    (void)context;
    gonio_atlas_slab(*(const int *)self, theta_h, rho);
    return GONIO_OK;
}

static gonio_status open_atlas(gonio_context *context, const char *name, gonio_material **material)
{
    const int index = gonio_atlas_find(name);
    if (index < 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "atlas:%s: no such built-in material; 'gonio info atlas:' lists them",
                            name);
    }
    int *self = gonio_i_allocate(context, 1, sizeof *self);
    if (self == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *self = index;
    const gonio_material_source source = {read_atlas_slab, free, self};
    char *format = gonio_i_format("built-in %s", gonio_atlas_class(index));
    const gonio_status status =
        format == NULL ? GONIO_ERROR_MEMORY
                       : gonio_material_create(context, name, format, source, material);
    free(format);
    if (status != GONIO_OK) {
        free(self);
    }
    return status;
}

static gonio_status look_at(gonio_context *context, const char *path, gonio_i_file *file)
{
    struct stat status;
    if (stat(path, &status) != 0) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) { /* a pipe cannot be read in any order */
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path,
                            S_ISDIR(status.st_mode) ? strerror(EISDIR) : "not a regular file");
    }
    FILE *stream = fopen(path, "rbe");
    if (stream == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    }
    file->path = path;
    file->size = (uint64_t)status.st_size;
    file->head_size = fread(file->head, 1, sizeof file->head, stream);
    fclose(stream);
    return GONIO_OK;
}

static gonio_status not_recognised(gonio_context *context, const gonio_i_file *file)
{
    if (file->size == 0) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: the file is empty", file->path);
    }
    char known[256] = "";
    for (int k = 0; k < READERS; k++) {
        const size_t length = strlen(known);
        snprintf(known + length, sizeof known - length, "%s%s", k > 0 ? ", " : "",
                 readers[k]->name);
    }
    return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                        "%s: not a material that gonio reads (%s), judged by its content",
                        file->path, known);
}

static gonio_status open_file(gonio_context *context, const gonio_i_file *file,
                              gonio_material **material)
{
    int k = 0;
    while (k < READERS && !readers[k]->probe(file)) {
        k++;
    }
    if (k == READERS) {
        return not_recognised(context, file);
    }
    gonio_material_source source = {0};
    char *description = NULL;
    gonio_status status = readers[k]->open(context, file, &source, &description);
    if (status != GONIO_OK) {
        return status;
    }
    char *name = gonio_i_base_name(file->path, false);
    status = name == NULL ? GONIO_ERROR_MEMORY
                          : gonio_material_create(context, name, description, source, material);
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
        return open_atlas(context, path + sizeof atlas - 1, material);
    }
    gonio_i_file file = {0};
    const gonio_status status = look_at(context, path, &file);
    return status != GONIO_OK ? status : open_file(context, &file, material);
}

gonio_status gonio_fingerprint_create(gonio_fingerprint **fingerprint)
{
    gonio_fingerprint *made = calloc(1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->state = XXH3_createState();
    if (made->state == NULL) {
        free(made);
        return GONIO_ERROR_MEMORY;
    }
    XXH3_64bits_reset(made->state);
    *fingerprint = made;
    return GONIO_OK;
}

/* The same for the widest vectors of the processor at hand, four times as fast. Only the shared
 * xxhash of some systems has it, so it may be missing; only x86 needs it. */
#if defined(__x86_64__) && defined(__ELF__)
extern XXH_errorcode XXH3_64bits_update_dispatch(XXH3_state_t *state, const void *data, size_t size)
    __attribute__((weak));
#else
static XXH_errorcode (*const XXH3_64bits_update_dispatch)(XXH3_state_t *, const void *,
                                                          size_t) = NULL;
#endif

void gonio_fingerprint_add(gonio_fingerprint *fingerprint, const void *data, size_t size)
{
    if (XXH3_64bits_update_dispatch != NULL) {
        XXH3_64bits_update_dispatch(fingerprint->state, data, size);
    } else {
        XXH3_64bits_update(fingerprint->state, data, size);
    }
}

uint64_t gonio_fingerprint_value(const gonio_fingerprint *fingerprint)
{
    return XXH3_64bits_digest(fingerprint->state);
}

void gonio_fingerprint_free(gonio_fingerprint **fingerprint)
{
    if (fingerprint == NULL || *fingerprint == NULL) {
        return;
    }
    XXH3_freeState((*fingerprint)->state);
    free(*fingerprint);
    *fingerprint = NULL;
}
