/* Writing basis files: see basis_layout.h. */
#include "basis.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "basis_layout.h"

/* Names, each with a 0 at its end; NULL when out of memory. */
static char *join_names(const gonio_basis *basis, size_t *size)
{
    *size = 0;
    for (size_t k = 0; k < basis->materials; k++) {
        *size += strlen(basis->names[k]) + 1;
    }
    char *joined = malloc(*size + 1);
    char *end = joined;
    for (size_t k = 0; joined != NULL && k < basis->materials; k++) {
        end = stpcpy(end, basis->names[k]) + 1;
    }
    return joined;
}

/* Lists data and shapes of all arrays. An array that the basis lacks has no data. */
static void list_arrays(const gonio_basis *basis, const double *scale, const char *names,
                        size_t names_size, gonio_i_array arrays[GONIO_I_BASIS_ARRAYS])
{
    const size_t k = basis->components;
    const struct {
        const void *data;
        size_t shape[2];
        size_t size; /* of one value */
    } contents[GONIO_I_BASIS_ARRAYS] = {
        [GONIO_I_LOG_SCALE] = {scale, {GONIO_CHANNELS}, sizeof *scale},
        [GONIO_I_MEAN] = {basis->mean, {basis->rows}, sizeof *basis->mean},
        [GONIO_I_VARIANCES] = {basis->variances, {basis->variance_count}, sizeof *basis->variances},
        [GONIO_I_MATERIAL_FINGERPRINTS] = {basis->fingerprints,
                                           {basis->materials},
                                           sizeof *basis->fingerprints},
        [GONIO_I_COMPONENTS] = {basis->vectors, {basis->rows, k}, sizeof *basis->vectors},
        [GONIO_I_CELL] = {basis->cell, {basis->cells}, sizeof *basis->cell},
        [GONIO_I_MATERIAL_NAMES] = {names, {names_size}, 1},
        [GONIO_I_LOADINGS] = {basis->loadings, {gonio_i_basis_columns(basis), k}, sizeof(double)},
        [GONIO_I_MIXTURE_PARENTS] = {basis->parents, {basis->mixtures, 2}, sizeof(int32_t)},
    };
    for (size_t j = 0; j < GONIO_I_BASIS_ARRAYS; j++) {
        arrays[j] = (gonio_i_array){.name = gonio_i_basis_layout[j].name,
                                    .type = gonio_i_basis_layout[j].type,
                                    .rank = gonio_i_basis_layout[j].rank,
                                    .data = contents[j].data,
                                    .size = contents[j].size * contents[j].shape[0]};
        memcpy(arrays[j].shape, contents[j].shape, sizeof contents[j].shape);
        arrays[j].size *= gonio_i_basis_layout[j].rank == 2 ? contents[j].shape[1] : 1;
    }
}

/* The computed texts of the metadata. */
typedef struct made_texts {
    char mixtures[24];
    char analytic[24];
    char fingerprint[GONIO_I_HASH_ROOM];
    char checksum[GONIO_I_BASIS_ARRAYS][GONIO_I_HASH_ROOM];
} made_texts;

static size_t list_metadata(const gonio_basis *basis, const char *command, const made_texts *made,
                            const gonio_i_array *arrays, gonio_i_metadata *metadata)
{
    const gonio_i_metadata first[] = {
        {"format", gonio_i_basis_format},
        {"format_version", gonio_i_basis_format_version},
        {"program", basis->program != NULL ? basis->program : ""},
        {"command", command != NULL ? command : ""},
        {"representation", gonio_i_basis_representations[basis->representation]},
        {"channels", gonio_i_basis_channel_models[basis->channels]},
        {"mapping", gonio_i_basis_mappings[basis->mapping]},
        {"centring", gonio_i_basis_centrings[basis->without_mean]},
        {"mixtures", made->mixtures},
        {"analytic", made->analytic},
        {"fingerprint", made->fingerprint},
    };
    size_t count = sizeof first / sizeof *first;
    memcpy(metadata, first, sizeof first);
    for (size_t k = 0; k < GONIO_I_BASIS_GRID; k++) {
        metadata[count++] =
            (gonio_i_metadata){gonio_i_basis_grids[k].key, gonio_i_basis_grids[k].bins};
    }
    for (size_t k = 0; k < GONIO_I_BASIS_ARRAYS; k++) {
        if (arrays[k].data != NULL) {
            metadata[count++] =
                (gonio_i_metadata){gonio_i_basis_layout[k].checksum, made->checksum[k]};
        }
    }
    return count;
}

static gonio_status make_texts(gonio_context *context, const gonio_basis *basis,
                               const gonio_i_array *arrays, made_texts *made)
{
    gonio_status status = GONIO_OK;
    snprintf(made->mixtures, sizeof made->mixtures, "%zu", basis->mixtures);
    snprintf(made->analytic, sizeof made->analytic, "%zu", basis->analytic);
    gonio_i_print_hash(basis->fingerprint, made->fingerprint);
    for (size_t k = 0; k < GONIO_I_BASIS_ARRAYS && status == GONIO_OK; k++) {
        uint64_t hash = basis->vectors_checksum;
        if (k != GONIO_I_COMPONENTS && arrays[k].data != NULL) {
            status = gonio_i_basis_hash(context, arrays[k].data, arrays[k].size, &hash);
        }
        gonio_i_print_hash(hash, made->checksum[k]);
    }
    return status;
}

static gonio_status write_arrays(gonio_context *context, const gonio_basis *basis,
                                 const char *command, const gonio_i_array *arrays, const char *path)
{
    enum { MOST_TEXTS = 32 };
    gonio_i_metadata metadata[MOST_TEXTS];
    gonio_i_array present[GONIO_I_BASIS_ARRAYS];
    made_texts made;
    size_t count = 0;
    for (size_t k = 0; k < GONIO_I_BASIS_ARRAYS; k++) {
        if (arrays[k].data != NULL) {
            present[count++] = arrays[k];
        }
    }
    const gonio_status status = make_texts(context, basis, arrays, &made);
    if (status != GONIO_OK) {
        return status;
    }
    const size_t texts = list_metadata(basis, command, &made, arrays, metadata);
    return gonio_i_safetensors_write(context, metadata, texts, present, count, path);
}

gonio_status gonio_basis_write(gonio_context *context, const gonio_basis *basis,
                               const char *command, const char *path)
{
    const double scale[GONIO_CHANNELS] = {gonio_log_scale(0), gonio_log_scale(1),
                                          gonio_log_scale(2)};
    gonio_i_array arrays[GONIO_I_BASIS_ARRAYS];
    size_t size = 0;
    char *names = join_names(basis, &size);
    if (names == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    }
    list_arrays(basis, scale, names, size, arrays);
    const gonio_status status = write_arrays(context, basis, command, arrays, path);
    free(names);
    return status;
}
