/* Reading basis files: every part is checked before it is believed. See basis_layout.h. */
#include "basis.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "basis_layout.h"

static const char remedy[] = "learn the basis again with gonio learn";

/* A file, the basis that is read from it, and its arrays; NULL for an array that it lacks. */
typedef struct reader {
    gonio_context *context;
    const char *path;
    gonio_i_safetensors *file;
    const gonio_i_array *arrays[GONIO_I_BASIS_ARRAYS];
    gonio_basis *basis;
} reader;

static gonio_status damaged(const reader *r, const char *what, const char *problem)
{
    return gonio_i_fail(r->context, GONIO_ERROR_FORMAT, "%s: '%s' %s; %s", r->path, what, problem,
                        remedy);
}

/* Checks that the file is a basis of a known version. */
static gonio_status check_kind(const reader *r)
{
    const char *format = gonio_i_safetensors_text(r->file, "format");
    const char *version = gonio_i_safetensors_text(r->file, "format_version");
    if (format == NULL || strcmp(format, gonio_i_basis_format) != 0) {
        return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                            "%s: a safetensors file, but not a gonio basis; gonio learn makes one",
                            r->path);
    }
    if (version == NULL || strcmp(version, gonio_i_basis_format_version) != 0) {
        return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                            "%s: a basis of format version %.20s; this gonio reads version %s",
                            r->path, version != NULL ? version : "(none)",
                            gonio_i_basis_format_version);
    }
    return GONIO_OK;
}

static gonio_status check_grid(const reader *r)
{
    for (size_t k = 0; k < GONIO_I_BASIS_GRID; k++) {
        const char *bins = gonio_i_safetensors_text(r->file, gonio_i_basis_grids[k].key);
        if (bins == NULL) {
            return damaged(r, gonio_i_basis_grids[k].key, "is missing");
        }
        if (strcmp(bins, gonio_i_basis_grids[k].bins) != 0) {
            return gonio_i_fail(r->context, GONIO_ERROR_MISMATCH,
                                "%s: a basis on a grid with %.20s %s; this gonio works on "
                                "90 x 90 x 180",
                                r->path, bins, gonio_i_basis_grids[k].key);
        }
    }
    return GONIO_OK;
}

static gonio_status read_word(const reader *r, const char *key, const char *const *words,
                              int *value)
{
    const char *text = gonio_i_safetensors_text(r->file, key);
    for (int k = 0; text != NULL && words[k] != NULL; k++) {
        if (strcmp(text, words[k]) == 0) {
            *value = k;
            return GONIO_OK;
        }
    }
    return damaged(r, key, "is missing or unknown");
}

static gonio_status read_words(const reader *r)
{
    int value[4] = {0};
    gonio_status status = read_word(r, "representation", gonio_i_basis_representations, &value[0]);
    if (status == GONIO_OK) {
        status = read_word(r, "channels", gonio_i_basis_channel_models, &value[1]);
    }
    if (status == GONIO_OK) {
        status = read_word(r, "mapping", gonio_i_basis_mappings, &value[2]);
    }
    if (status == GONIO_OK) {
        status = read_word(r, "centring", gonio_i_basis_centrings, &value[3]);
    }
    r->basis->representation = (gonio_representation)value[0];
    r->basis->channels = (gonio_channel_model)value[1];
    r->basis->mapping = (gonio_mapping)value[2];
    r->basis->without_mean = value[3] != 0;
    return status;
}

/* Finds the arrays by their names, and checks their types and ranks. */
static gonio_status find_arrays(reader *r)
{
    for (size_t k = 0; k < GONIO_I_BASIS_ARRAYS; k++) {
        const gonio_i_array *found =
            gonio_i_safetensors_array(r->file, gonio_i_basis_layout[k].name);
        if (found == NULL && gonio_i_basis_layout[k].needed) {
            return damaged(r, gonio_i_basis_layout[k].name, "is missing");
        }
        if (found != NULL && (found->type != gonio_i_basis_layout[k].type ||
                              found->rank != gonio_i_basis_layout[k].rank)) {
            return damaged(r, gonio_i_basis_layout[k].name, "has another type or rank");
        }
        r->arrays[k] = found;
    }
    return GONIO_OK;
}

/* A number of columns in the metadata. */
static gonio_status read_columns(const reader *r, const char *key, size_t *columns)
{
    const char *text = gonio_i_safetensors_text(r->file, key);
    char *end = NULL;
    const bool digits = text != NULL && *text >= '0' && *text <= '9';
    errno = 0;
    const unsigned long long number = digits ? strtoull(text, &end, 10) : 0;
    if (!digits || *end != '\0' || errno != 0 || number > INT32_MAX) {
        return damaged(r, key, "is not a number of columns");
    }
    *columns = (size_t)number;
    return GONIO_OK;
}

/* The columns beside those of the materials. Files of older versions have no analytic ones. */
static gonio_status read_computed(const reader *r)
{
    const gonio_i_array *parents = r->arrays[GONIO_I_MIXTURE_PARENTS];
    const bool analytic = gonio_i_safetensors_text(r->file, "analytic") != NULL;
    size_t mixtures = 0;
    gonio_status status = read_columns(r, "mixtures", &mixtures);
    if (status == GONIO_OK && analytic) {
        status = read_columns(r, "analytic", &r->basis->analytic);
    }
    if (status != GONIO_OK) {
        return status;
    }
    if (parents != NULL &&
        (mixtures == 0 || parents->shape[0] != mixtures || parents->shape[1] != 2)) {
        return damaged(r, "mixture_parents", "has a shape that does not fit the mixtures");
    }
    r->basis->mixtures = mixtures;
    return GONIO_OK;
}

/* Sets the sizes of a basis from the shapes, and checks that these fit each other. */
static gonio_status read_shapes(const reader *r)
{
    gonio_basis *basis = r->basis;
    const gonio_i_array *const *a = r->arrays;
    basis->cells = a[GONIO_I_CELL]->shape[0];
    basis->rows = gonio_i_basis_row_count(basis->cells, basis->channels);
    basis->components = a[GONIO_I_COMPONENTS]->shape[1];
    basis->variance_count = a[GONIO_I_VARIANCES]->shape[0];
    basis->materials = a[GONIO_I_MATERIAL_FINGERPRINTS]->shape[0];
    if (basis->cells > GONIO_BINS || a[GONIO_I_MEAN]->shape[0] != basis->rows) {
        return damaged(r, "mean", "has a shape that does not fit the cells");
    }
    const gonio_status status = read_computed(r);
    if (status != GONIO_OK) {
        return status;
    }
    const size_t columns = gonio_i_basis_columns(basis);
    if (basis->materials == 0) {
        return damaged(r, "material_fingerprints", "has none");
    }
    if (columns < 2 || basis->variance_count > columns) {
        return damaged(r, "variances", "are more than there are columns");
    }
    if (a[GONIO_I_COMPONENTS]->shape[0] != basis->rows || basis->components == 0 ||
        basis->components > basis->variance_count) {
        return damaged(r, "components", "has a shape that does not fit the cells and variances");
    }
    if (a[GONIO_I_LOADINGS] != NULL && (a[GONIO_I_LOADINGS]->shape[0] != columns ||
                                        a[GONIO_I_LOADINGS]->shape[1] != basis->components)) {
        return damaged(r, "loadings", "has a shape that does not fit the columns and components");
    }
    return a[GONIO_I_LOG_SCALE]->shape[0] == GONIO_CHANNELS
               ? GONIO_OK
               : damaged(r, "log_scale", "has a wrong shape");
}

/* Refuses another scale, which is another log space. */
static gonio_status check_log_scale(const reader *r)
{
    const double *scale = r->arrays[GONIO_I_LOG_SCALE]->data;
    for (int k = 0; k < GONIO_CHANNELS; k++) {
        const double ours = gonio_log_scale(k);
        if (!(fabs(scale[k] - ours) <= 1e-12 * ours)) {
            return damaged(r, "log_scale", "is not this program's");
        }
    }
    return GONIO_OK;
}

static gonio_status read_names(const reader *r)
{
    const gonio_i_array *array = r->arrays[GONIO_I_MATERIAL_NAMES];
    const char *names = array->data;
    const char *end = names + array->size;
    r->basis->names = gonio_i_allocate(r->context, r->basis->materials, sizeof *r->basis->names);
    if (r->basis->names == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < r->basis->materials; k++) {
        const size_t length = strnlen(names, (size_t)(end - names));
        if (names + length == end) {
            return damaged(r, "material_names", "has fewer names than there are materials");
        }
        r->basis->names[k] = strndup(names, length);
        if (r->basis->names[k] == NULL) {
            return gonio_i_fail(r->context, GONIO_ERROR_MEMORY, "%s: out of memory", r->path);
        }
        names += length + 1;
    }
    return names == end ? GONIO_OK
                        : damaged(r, "material_names", "has more names than there are materials");
}

/* Copies an array, so that it cannot change after it is checked; NULL if the file lacks it. */
static gonio_status copy_array(const reader *r, int which, void *copy)
{
    const gonio_i_array *array = r->arrays[which];
    void *made = NULL;
    if (array != NULL) {
        made = gonio_i_allocate(r->context, array->size, 1);
        if (made == NULL) {
            return GONIO_ERROR_MEMORY;
        }
        memcpy(made, array->data, array->size);
    }
    memcpy(copy, &made, sizeof made);
    return GONIO_OK;
}

/* Copies all arrays except V, which stays in the file. */
static gonio_status copy_arrays(const reader *r)
{
    gonio_basis *basis = r->basis;
    const struct {
        int which;
        void *copy;
    } copies[] = {
        {GONIO_I_MEAN, &basis->mean},         {GONIO_I_VARIANCES, &basis->variances},
        {GONIO_I_CELL, &basis->cell},         {GONIO_I_MATERIAL_FINGERPRINTS, &basis->fingerprints},
        {GONIO_I_LOADINGS, &basis->loadings}, {GONIO_I_MIXTURE_PARENTS, &basis->parents}};
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < sizeof copies / sizeof *copies && status == GONIO_OK; k++) {
        status = copy_array(r, copies[k].which, copies[k].copy);
    }
    basis->vectors = r->arrays[GONIO_I_COMPONENTS]->data;
    return status;
}

static gonio_status read_texts(const reader *r)
{
    const char *program = gonio_i_safetensors_text(r->file, "program");
    const char *command = gonio_i_safetensors_text(r->file, "command");
    const char *vectors =
        gonio_i_safetensors_text(r->file, gonio_i_basis_layout[GONIO_I_COMPONENTS].checksum);
    if (program == NULL || command == NULL) {
        return damaged(r, program == NULL ? "program" : "command", "is missing");
    }
    r->basis->vectors_checksum = vectors != NULL ? strtoull(vectors, NULL, 16) : 0;
    r->basis->program = strdup(program);
    r->basis->command = strdup(command);
    return r->basis->program != NULL && r->basis->command != NULL
               ? GONIO_OK
               : gonio_i_fail(r->context, GONIO_ERROR_MEMORY, "%s: out of memory", r->path);
}

static gonio_status compare_hash(const reader *r, const char *key, uint64_t value)
{
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    (void)r; /* fuzzing has to reach the code after the hashes */
    (void)key;
    (void)value;
    return GONIO_OK;
#else
    char text[GONIO_I_HASH_ROOM];
    const char *stored = gonio_i_safetensors_text(r->file, key);
    gonio_i_print_hash(value, text);
    return stored != NULL && strcmp(stored, text) == 0
               ? GONIO_OK
               : damaged(r, key, "does not fit the contents (the file was changed)");
#endif
}

/* Checks the hashes of the arrays except V, of the copies if there are copies. */
static gonio_status compare_hashes(const reader *r)
{
    const gonio_basis *basis = r->basis;
    const void *const used[GONIO_I_BASIS_ARRAYS] = {
        [GONIO_I_LOG_SCALE] = r->arrays[GONIO_I_LOG_SCALE]->data,
        [GONIO_I_MEAN] = basis->mean,
        [GONIO_I_VARIANCES] = basis->variances,
        [GONIO_I_MATERIAL_FINGERPRINTS] = basis->fingerprints,
        [GONIO_I_CELL] = basis->cell,
        [GONIO_I_MATERIAL_NAMES] = r->arrays[GONIO_I_MATERIAL_NAMES]->data,
        [GONIO_I_LOADINGS] = basis->loadings,
        [GONIO_I_MIXTURE_PARENTS] = basis->parents,
    };
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < GONIO_I_BASIS_ARRAYS && status == GONIO_OK; k++) {
        uint64_t hash = 0;
        if (used[k] != NULL) {
            status = gonio_i_basis_hash(r->context, used[k], r->arrays[k]->size, &hash);
            status = status == GONIO_OK ? compare_hash(r, gonio_i_basis_layout[k].checksum, hash)
                                        : status;
        }
    }
    return status;
}

/* Reads a file into a basis whose arrays have the right sizes. Values are not checked yet. */
static gonio_status read_header(reader *r)
{
    static gonio_status (*const steps[])(const reader *) = {read_shapes, check_log_scale,
                                                            read_names, copy_arrays, read_texts};
    gonio_status status = check_kind(r);
    if (status == GONIO_OK) {
        status = check_grid(r);
    }
    if (status == GONIO_OK) {
        status = read_words(r);
    }
    if (status == GONIO_OK) {
        status = find_arrays(r);
    }
    for (size_t k = 0; k < sizeof steps / sizeof *steps && status == GONIO_OK; k++) {
        status = steps[k](r);
    }
    return status;
}

static gonio_status read_basis(reader *r)
{
    gonio_status status = read_header(r);
    if (status == GONIO_OK) {
        status = compare_hashes(r);
    }
    if (status == GONIO_OK) {
        status = gonio_i_basis_check(r->context, r->path, r->basis);
    }
    if (status == GONIO_OK) {
        status = gonio_i_basis_finish(r->context, r->basis);
    }
    return status == GONIO_OK ? compare_hash(r, "fingerprint", r->basis->fingerprint) : status;
}

/* ---- the whole file ---- */

/* Refuses files that are not safetensors: older bases, and files that are no bases. */
static gonio_status check_beginning(gonio_context *context, const gonio_i_file *file)
{
    if (gonio_i_basis_is_hdf5(file) && gonio_i_basis_is_marked(file)) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: a basis of an older gonio (HDF5); 'gonio convert %s NEW.gonio' "
                            "makes one of today",
                            file->path, file->path);
    }
    if (!gonio_i_safetensors_begin(file->head, file->head_size)) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: %snot a gonio basis; gonio learn "
                            "makes one",
                            file->path, gonio_i_basis_is_hdf5(file) ? "an HDF5 file, but " : "");
    }
    return GONIO_OK;
}

gonio_status gonio_basis_read(gonio_context *context, const char *path, gonio_basis **basis)
{
    reader r = {.context = context, .path = path};
    gonio_i_file head;
    gonio_status status = gonio_i_file_look(context, path, &head);
    if (status == GONIO_OK) {
        status = check_beginning(context, &head);
    }
    if (status == GONIO_OK) {
        status = gonio_i_safetensors_open(context, path, remedy, &r.file);
    }
    if (status != GONIO_OK) {
        return status;
    }
    r.basis = gonio_i_allocate(context, 1, sizeof *r.basis);
    if (r.basis == NULL) {
        gonio_i_safetensors_close(&r.file);
        return GONIO_ERROR_MEMORY;
    }
    r.basis->file = r.file; /* closed with it */
    status = read_basis(&r);
    if (status != GONIO_OK) {
        gonio_basis_free(&r.basis);
        return status;
    }
    *basis = r.basis;
    return GONIO_OK;
}
