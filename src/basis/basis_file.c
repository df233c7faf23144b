/* The basis file: a safetensors file, layout in docs/basis-file.md. */
#include "basis.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char format_name[] = "gonio basis";
static const char format_version[] = "2";
static const char remedy[] = "learn the basis again with gonio learn";

enum { HASH_SIZE = 17 }; /* 16 hexadecimal digits */

/* Words for the values of an enumeration, from 0 on. */
static const char *const representations[] = {"bivariate", "full", "sectored", NULL};
static const char *const channel_models[] = {"joint", "separate", NULL};
static const char *const mappings[] = {"log", "relative", NULL};
static const char *const centrings[] = {"mean", "none", NULL};

/* The grid that this program works on. */
static const struct {
    const char *key;
    const char *bins;
} grid[] = {{"theta_h_bins", "90"}, {"theta_d_bins", "90"}, {"phi_d_bins", "180"}};

enum { GRID = sizeof grid / sizeof *grid };

/* The arrays of a file. */
enum {
    LOG_SCALE,
    MEAN,
    VARIANCES,
    MATERIAL_FINGERPRINTS,
    COMPONENTS,
    CELL,
    MATERIAL_NAMES,
    LOADINGS,
    MIXTURE_PARENTS,
    ARRAYS
};

static const struct {
    const char *name;
    const char *checksum; /* the key of its hash */
    gonio_i_array_type type;
    int rank;
    bool needed;
} layout[ARRAYS] = {
    [LOG_SCALE] = {"log_scale", "xxh3.log_scale", GONIO_I_F64, 1, true},
    [MEAN] = {"mean", "xxh3.mean", GONIO_I_F64, 1, true},
    [VARIANCES] = {"variances", "xxh3.variances", GONIO_I_F64, 1, true},
    [MATERIAL_FINGERPRINTS] = {"material_fingerprints", "xxh3.material_fingerprints", GONIO_I_U64,
                               1, true},
    [COMPONENTS] = {"components", "xxh3.components", GONIO_I_F32, 2, true},
    [CELL] = {"cell", "xxh3.cell", GONIO_I_I32, 1, true},
    [MATERIAL_NAMES] = {"material_names", "xxh3.material_names", GONIO_I_U8, 1, true},
    [LOADINGS] = {"loadings", "xxh3.loadings", GONIO_I_F64, 2, false},
    [MIXTURE_PARENTS] = {"mixture_parents", "xxh3.mixture_parents", GONIO_I_I32, 2, false},
};

static void print_hash(uint64_t value, char text[HASH_SIZE])
{
    snprintf(text, HASH_SIZE, "%016" PRIx64, value);
}

/* ---- writing ---- */

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
                        size_t names_size, gonio_i_array arrays[ARRAYS])
{
    const size_t k = basis->components;
    const struct {
        const void *data;
        size_t shape[2];
        size_t size; /* of one value */
    } contents[ARRAYS] = {
        [LOG_SCALE] = {scale, {GONIO_CHANNELS}, sizeof *scale},
        [MEAN] = {basis->mean, {basis->rows}, sizeof *basis->mean},
        [VARIANCES] = {basis->variances, {basis->variance_count}, sizeof *basis->variances},
        [MATERIAL_FINGERPRINTS] = {basis->fingerprints,
                                   {basis->materials},
                                   sizeof *basis->fingerprints},
        [COMPONENTS] = {basis->vectors, {basis->rows, k}, sizeof *basis->vectors},
        [CELL] = {basis->cell, {basis->cells}, sizeof *basis->cell},
        [MATERIAL_NAMES] = {names, {names_size}, 1},
        [LOADINGS] = {basis->loadings, {gonio_i_basis_columns(basis), k}, sizeof(double)},
        [MIXTURE_PARENTS] = {basis->parents, {basis->mixtures, 2}, sizeof(int32_t)},
    };
    for (size_t j = 0; j < ARRAYS; j++) {
        arrays[j] = (gonio_i_array){.name = layout[j].name,
                                    .type = layout[j].type,
                                    .rank = layout[j].rank,
                                    .data = contents[j].data,
                                    .size = contents[j].size * contents[j].shape[0]};
        memcpy(arrays[j].shape, contents[j].shape, sizeof contents[j].shape);
        arrays[j].size *= layout[j].rank == 2 ? contents[j].shape[1] : 1;
    }
}

/* The computed texts of the metadata. */
typedef struct made_texts {
    char mixtures[24];
    char fingerprint[HASH_SIZE];
    char checksum[ARRAYS][HASH_SIZE];
} made_texts;

static size_t list_metadata(const gonio_basis *basis, const char *command, const made_texts *made,
                            const gonio_i_array *arrays, gonio_i_metadata *metadata)
{
    const gonio_i_metadata first[] = {
        {"format", format_name},
        {"format_version", format_version},
        {"program", basis->program != NULL ? basis->program : ""},
        {"command", command != NULL ? command : ""},
        {"representation", representations[basis->representation]},
        {"channels", channel_models[basis->channels]},
        {"mapping", mappings[basis->mapping]},
        {"centring", centrings[basis->without_mean]},
        {"mixtures", made->mixtures},
        {"fingerprint", made->fingerprint},
    };
    size_t count = sizeof first / sizeof *first;
    memcpy(metadata, first, sizeof first);
    for (size_t k = 0; k < GRID; k++) {
        metadata[count++] = (gonio_i_metadata){grid[k].key, grid[k].bins};
    }
    for (size_t k = 0; k < ARRAYS; k++) {
        if (arrays[k].data != NULL) {
            metadata[count++] = (gonio_i_metadata){layout[k].checksum, made->checksum[k]};
        }
    }
    return count;
}

static gonio_status make_texts(gonio_context *context, const gonio_basis *basis,
                               const gonio_i_array *arrays, made_texts *made)
{
    gonio_status status = GONIO_OK;
    snprintf(made->mixtures, sizeof made->mixtures, "%zu", basis->mixtures);
    print_hash(basis->fingerprint, made->fingerprint);
    for (size_t k = 0; k < ARRAYS && status == GONIO_OK; k++) {
        uint64_t hash = basis->vectors_checksum;
        if (k != COMPONENTS && arrays[k].data != NULL) {
            status = gonio_i_basis_hash(context, arrays[k].data, arrays[k].size, &hash);
        }
        print_hash(hash, made->checksum[k]);
    }
    return status;
}

static gonio_status write_arrays(gonio_context *context, const gonio_basis *basis,
                                 const char *command, const gonio_i_array *arrays, const char *path)
{
    enum { MOST_TEXTS = 32 };
    gonio_i_metadata metadata[MOST_TEXTS];
    gonio_i_array present[ARRAYS];
    made_texts made;
    size_t count = 0;
    for (size_t k = 0; k < ARRAYS; k++) {
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
    gonio_i_array arrays[ARRAYS];
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

/* ---- reading ---- */

/* A file, the basis that is read from it, and its arrays; NULL for an array that it lacks. */
typedef struct reader {
    gonio_context *context;
    const char *path;
    gonio_i_safetensors *file;
    const gonio_i_array *arrays[ARRAYS];
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
    if (format == NULL || strcmp(format, format_name) != 0) {
        return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                            "%s: a safetensors file, but not a gonio basis; gonio learn makes one",
                            r->path);
    }
    if (version == NULL || strcmp(version, format_version) != 0) {
        return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                            "%s: a basis of format version %.20s; this gonio reads version %s",
                            r->path, version != NULL ? version : "(none)", format_version);
    }
    return GONIO_OK;
}

static gonio_status check_grid(const reader *r)
{
    for (size_t k = 0; k < GRID; k++) {
        const char *bins = gonio_i_safetensors_text(r->file, grid[k].key);
        if (bins == NULL) {
            return damaged(r, grid[k].key, "is missing");
        }
        if (strcmp(bins, grid[k].bins) != 0) {
            return gonio_i_fail(r->context, GONIO_ERROR_MISMATCH,
                                "%s: a basis on a grid with %.20s %s; this gonio works on "
                                "90 x 90 x 180",
                                r->path, bins, grid[k].key);
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
    gonio_status status = read_word(r, "representation", representations, &value[0]);
    if (status == GONIO_OK) {
        status = read_word(r, "channels", channel_models, &value[1]);
    }
    if (status == GONIO_OK) {
        status = read_word(r, "mapping", mappings, &value[2]);
    }
    if (status == GONIO_OK) {
        status = read_word(r, "centring", centrings, &value[3]);
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
    for (size_t k = 0; k < ARRAYS; k++) {
        const gonio_i_array *found = gonio_i_safetensors_array(r->file, layout[k].name);
        if (found == NULL && layout[k].needed) {
            return damaged(r, layout[k].name, "is missing");
        }
        if (found != NULL && (found->type != layout[k].type || found->rank != layout[k].rank)) {
            return damaged(r, layout[k].name, "has another type or rank");
        }
        r->arrays[k] = found;
    }
    return GONIO_OK;
}

static gonio_status read_mixtures(const reader *r)
{
    const gonio_i_array *parents = r->arrays[MIXTURE_PARENTS];
    const char *text = gonio_i_safetensors_text(r->file, "mixtures");
    char *end = NULL;
    const bool digits = text != NULL && *text >= '0' && *text <= '9';
    errno = 0;
    const unsigned long long mixtures = digits ? strtoull(text, &end, 10) : 0;
    if (!digits || *end != '\0' || errno != 0 || mixtures > INT32_MAX) {
        return damaged(r, "mixtures", "is not a number of columns");
    }
    if (parents != NULL &&
        (mixtures == 0 || parents->shape[0] != mixtures || parents->shape[1] != 2)) {
        return damaged(r, "mixture_parents", "has a shape that does not fit the mixtures");
    }
    r->basis->mixtures = (size_t)mixtures;
    return GONIO_OK;
}

/* Sets the sizes of a basis from the shapes, and checks that these fit each other. */
static gonio_status read_shapes(const reader *r)
{
    gonio_basis *basis = r->basis;
    const gonio_i_array *const *a = r->arrays;
    basis->cells = a[CELL]->shape[0];
    basis->rows = gonio_i_basis_row_count(basis->cells, basis->channels);
    basis->components = a[COMPONENTS]->shape[1];
    basis->variance_count = a[VARIANCES]->shape[0];
    basis->materials = a[MATERIAL_FINGERPRINTS]->shape[0];
    if (basis->cells > GONIO_BINS || a[MEAN]->shape[0] != basis->rows) {
        return damaged(r, "mean", "has a shape that does not fit the cells");
    }
    const gonio_status status = read_mixtures(r);
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
    if (a[COMPONENTS]->shape[0] != basis->rows || basis->components == 0 ||
        basis->components > basis->variance_count) {
        return damaged(r, "components", "has a shape that does not fit the cells and variances");
    }
    if (a[LOADINGS] != NULL &&
        (a[LOADINGS]->shape[0] != columns || a[LOADINGS]->shape[1] != basis->components)) {
        return damaged(r, "loadings", "has a shape that does not fit the columns and components");
    }
    return a[LOG_SCALE]->shape[0] == GONIO_CHANNELS ? GONIO_OK
                                                    : damaged(r, "log_scale", "has a wrong shape");
}

/* Refuses another scale, which is another log space. */
static gonio_status check_log_scale(const reader *r)
{
    const double *scale = r->arrays[LOG_SCALE]->data;
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
    const gonio_i_array *array = r->arrays[MATERIAL_NAMES];
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
    } copies[] = {{MEAN, &basis->mean},         {VARIANCES, &basis->variances},
                  {CELL, &basis->cell},         {MATERIAL_FINGERPRINTS, &basis->fingerprints},
                  {LOADINGS, &basis->loadings}, {MIXTURE_PARENTS, &basis->parents}};
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < sizeof copies / sizeof *copies && status == GONIO_OK; k++) {
        status = copy_array(r, copies[k].which, copies[k].copy);
    }
    basis->vectors = r->arrays[COMPONENTS]->data;
    return status;
}

static gonio_status read_texts(const reader *r)
{
    const char *program = gonio_i_safetensors_text(r->file, "program");
    const char *command = gonio_i_safetensors_text(r->file, "command");
    const char *vectors = gonio_i_safetensors_text(r->file, layout[COMPONENTS].checksum);
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
    char text[HASH_SIZE];
    const char *stored = gonio_i_safetensors_text(r->file, key);
    print_hash(value, text);
    return stored != NULL && strcmp(stored, text) == 0
               ? GONIO_OK
               : damaged(r, key, "does not fit the contents (the file was changed)");
#endif
}

/* Checks the hashes of the arrays except V, of the copies if there are copies. */
static gonio_status compare_hashes(const reader *r)
{
    const gonio_basis *basis = r->basis;
    const void *const used[ARRAYS] = {
        [LOG_SCALE] = r->arrays[LOG_SCALE]->data,
        [MEAN] = basis->mean,
        [VARIANCES] = basis->variances,
        [MATERIAL_FINGERPRINTS] = basis->fingerprints,
        [CELL] = basis->cell,
        [MATERIAL_NAMES] = r->arrays[MATERIAL_NAMES]->data,
        [LOADINGS] = basis->loadings,
        [MIXTURE_PARENTS] = basis->parents,
    };
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < ARRAYS && status == GONIO_OK; k++) {
        uint64_t hash = 0;
        if (used[k] != NULL) {
            status = gonio_i_basis_hash(r->context, used[k], r->arrays[k]->size, &hash);
            status = status == GONIO_OK ? compare_hash(r, layout[k].checksum, hash) : status;
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

/* ---- which file is one ---- */

static bool is_hdf5(const gonio_i_file *file)
{
    return gonio_i_file_begins(file, "\x89HDF\r\n\x1a\n", 8);
}

static bool is_marked(const gonio_i_file *file)
{
    return memmem(file->head, file->head_size, format_name, sizeof format_name - 1) != NULL;
}

bool gonio_i_basis_may_be(const gonio_i_file *file)
{
    return is_hdf5(file) || gonio_i_safetensors_begin(file->head, file->head_size);
}

const char *gonio_i_basis_format_of(const gonio_i_file *file)
{
    const bool basis = gonio_i_basis_may_be(file) && is_marked(file);
    return !basis ? NULL : is_hdf5(file) ? "gonio basis of an older gonio, HDF5" : format_name;
}

const char *gonio_i_basis_format_name(int index)
{
    return index == 0 ? format_name : NULL; /* older ones are converted, not read */
}

/* Refuses files that are not safetensors: older bases, and files that are no bases. */
static gonio_status check_beginning(gonio_context *context, const gonio_i_file *file)
{
    if (is_hdf5(file) && is_marked(file)) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: a basis of an older gonio (HDF5); 'gonio convert %s NEW.gonio' "
                            "makes one of today",
                            file->path, file->path);
    }
    if (!gonio_i_safetensors_begin(file->head, file->head_size)) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: %snot a gonio basis; gonio learn "
                            "makes one",
                            file->path, is_hdf5(file) ? "an HDF5 file, but " : "");
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

gonio_status gonio_basis_convert(gonio_context *context, const char *input, const char *output)
{
    gonio_basis *basis = NULL;
    gonio_i_file head;
    gonio_status status = gonio_i_file_look(context, input, &head);
    if (status == GONIO_OK && !is_hdf5(&head)) {
        status = gonio_i_fail(context, GONIO_ERROR_FORMAT,
                              "%s: a basis (%s), not a material; only bases of older gonios (HDF5) "
                              "are converted",
                              input, format_name);
    }
    if (status == GONIO_OK) {
        status = gonio_i_basis_read_hdf5(context, input, &basis);
    }
    if (status == GONIO_OK) {
        status = gonio_basis_write(context, basis, basis->command, output);
    }
    gonio_basis_free(&basis);
    return status;
}
