/* Basis files of older programs, which are HDF5 (docs/basis-file.md): they are read, not written.
 */
#include "basis.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../core/hdf_read.h"

enum { FORMAT_VERSION = 1, MOST_MATERIALS = 1 << 20 };

static const char format_name[] = "gonio basis";
/* Words for the values of an enumeration, from 0 on. */
static const char *const representations[] = {"bivariate", "full", "sectored", NULL};
static const char *const channel_models[] = {"joint", "separate", NULL};
static const char *const mappings[] = {"log", "relative", NULL};
static const char *const centrings[] = {"mean", "none", NULL};

/* The contents of a file, before they become a basis. */
typedef struct contents {
    gonio_context *context;
    const char *path;
    gonio_i_hdf_object root;
    int64_t representation, channels, mapping, without_mean;
    void *cell, *mean, *vectors, *variances, *loadings, *parents, *fingerprints;
    size_t cells, rows, components, variance_count, materials, mixtures;
    char **names;
    char *program, *command;
    uint64_t fingerprint, checksum, loadings_checksum, parents_checksum;
} contents;

static gonio_status damaged(const contents *c, const char *what, const char *problem)
{
    return gonio_i_fail(c->context, GONIO_ERROR_FORMAT,
                        "%s: '%s' %s; learn the basis again with gonio learn", c->path, what,
                        problem);
}

static gonio_status read_word(const contents *c, gonio_i_hdf_object parent, const char *name,
                              const char *const *words, int64_t *value)
{
    char **text = NULL;
    size_t count = 0;
    *value = -1;
    if (gonio_i_hdf_read_strings(parent, name, &text, &count) && count == 1) {
        for (int k = 0; words[k] != NULL; k++) {
            *value = strcmp(text[0], words[k]) == 0 ? k : *value;
        }
    }
    free(text);
    return *value >= 0 ? GONIO_OK : damaged(c, name, "is missing or unknown");
}

/* An attribute that files of gonio 0.1.0 lack. It then has the first of the words. */
static gonio_status read_new_word(const contents *c, const char *name, const char *const *words,
                                  int64_t *value)
{
    *value = 0;
    return gonio_i_hdf_has_attribute(c->root, name) ? read_word(c, c->root, name, words, value)
                                                    : GONIO_OK;
}

static gonio_status read_space(contents *c)
{
    const gonio_status status = read_new_word(c, "mapping", mappings, &c->mapping);
    return status == GONIO_OK ? read_new_word(c, "centring", centrings, &c->without_mean) : status;
}

/* The number of mixtures, which files of gonio 0.1.0 lack. */
static gonio_status read_mixtures(contents *c)
{
    int64_t mixtures = 0;
    if (gonio_i_hdf_has_attribute(c->root, "mixtures") &&
        (!gonio_i_hdf_read_number(c->root, "mixtures", &mixtures) || mixtures < 0 ||
         mixtures > MOST_MATERIALS)) {
        return damaged(c, "mixtures", "is not a number of columns");
    }
    c->mixtures = (size_t)mixtures;
    return GONIO_OK;
}

static size_t measured_of(const contents *c)
{
    return gonio_i_columns_per_material((gonio_channel_model)c->channels) * c->materials;
}

static size_t columns_of(const contents *c)
{
    return measured_of(c) + c->mixtures;
}

static gonio_status read_grid(contents *c)
{
    static const char *const names[3] = {"theta_h_bins", "theta_d_bins", "phi_d_bins"};
    static const int64_t expected[3] = {GONIO_THETA_H_BINS, GONIO_THETA_D_BINS, GONIO_PHI_D_BINS};
    gonio_i_hdf_object grid;
    if (!gonio_i_hdf_find(c->root, "grid", &grid)) {
        return damaged(c, "grid", "is missing");
    }
    gonio_status status = GONIO_OK;
    for (int k = 0; k < 3 && status == GONIO_OK; k++) {
        int64_t bins = 0;
        if (!gonio_i_hdf_read_number(grid, names[k], &bins)) {
            status = damaged(c, names[k], "is missing");
        } else if (bins != expected[k]) {
            status = gonio_i_fail(c->context, GONIO_ERROR_MISMATCH,
                                  "%s: a basis on a grid with %lld %s; this gonio works on "
                                  "90 x 90 x 180",
                                  c->path, (long long)bins, names[k]);
        }
    }
    if (status == GONIO_OK) {
        status = read_word(c, grid, "representation", representations, &c->representation);
    }
    if (status == GONIO_OK) {
        status = read_word(c, grid, "channels", channel_models, &c->channels);
    }
    if (status == GONIO_OK) {
        const char *problem = gonio_i_hdf_read_array(grid, "cell", 1, GONIO_BINS, GONIO_I_HDF_INT32,
                                                     &c->cell, &c->cells);
        status = problem != NULL ? damaged(c, "grid/cell", problem) : GONIO_OK;
    }
    return status;
}

static gonio_status read_materials(contents *c)
{
    size_t fingerprints = 0;
    if (!gonio_i_hdf_read_string_set(c->root, "materials/name", &c->names, &c->materials)) {
        return damaged(c, "materials/name", "is missing or not a list of strings");
    }
    const char *problem =
        gonio_i_hdf_read_array(c->root, "materials/fingerprint", 1, MOST_MATERIALS,
                               GONIO_I_HDF_UINT64, &c->fingerprints, &fingerprints);
    if (problem == NULL && fingerprints != c->materials) {
        problem = "has a wrong shape";
    }
    return problem != NULL ? damaged(c, "materials/fingerprint", problem) : GONIO_OK;
}

/* Refuses another scale, which is another log space. */
static gonio_status check_log_scale(const contents *c)
{
    void *scale = NULL;
    size_t count = 0;
    const char *problem =
        gonio_i_hdf_read_array(c->root, "log_scale", 1, 64, GONIO_I_HDF_DOUBLE, &scale, &count);
    if (problem == NULL && count != GONIO_CHANNELS) {
        problem = "has a wrong shape";
    }
    for (int k = 0; k < GONIO_CHANNELS && problem == NULL; k++) {
        const double ours = gonio_log_scale(k);
        if (!(fabs(((const double *)scale)[k] - ours) <= 1e-12 * ours)) {
            problem = "is not this program's";
        }
    }
    free(scale);
    return problem != NULL ? damaged(c, "log_scale", problem) : GONIO_OK;
}

static gonio_status read_numbers(contents *c)
{
    /* Each size limits the next one. So no file causes more memory to be allocated than its grid
     * needs. */
    const size_t rows = gonio_i_basis_row_count(c->cells, (gonio_channel_model)c->channels);
    size_t shape[2] = {0, 0};
    const char *what = "mean";
    const char *problem =
        gonio_i_hdf_read_array(c->root, what, 1, rows, GONIO_I_HDF_DOUBLE, &c->mean, &c->rows);
    if (problem == NULL) {
        what = "variances";
        problem = gonio_i_hdf_read_array(c->root, what, 1, columns_of(c), GONIO_I_HDF_DOUBLE,
                                         &c->variances, &c->variance_count);
    }
    if (problem == NULL) {
        what = "components";
        problem = gonio_i_hdf_read_array(c->root, what, 2, rows * c->variance_count,
                                         GONIO_I_HDF_DOUBLE, &c->vectors, shape);
        c->components = shape[1];
    }
    if (problem == NULL && (c->rows != rows || shape[0] != c->rows || c->components == 0 ||
                            c->cells == 0 || c->components > c->variance_count)) {
        what = "components";
        problem = "has a shape that does not fit the grid and the mean";
    }
    return problem != NULL ? damaged(c, what, problem) : GONIO_OK;
}

/* Checks that the file is a basis of a known version. */
static gonio_status check_kind(const contents *c)
{
    char **text = NULL;
    size_t count = 0;
    int64_t version = 0;
    const bool ours = gonio_i_hdf_read_strings(c->root, "format", &text, &count) && count == 1 &&
                      strcmp(text[0], format_name) == 0;
    free(text);
    if (!ours) {
        return gonio_i_fail(c->context, GONIO_ERROR_FORMAT,
                            "%s: an HDF5 file, but not a gonio basis; gonio learn makes one",
                            c->path);
    }
    if (!gonio_i_hdf_read_number(c->root, "format_version", &version) ||
        version != FORMAT_VERSION) {
        return gonio_i_fail(c->context, GONIO_ERROR_FORMAT,
                            "%s: a basis of format version %lld; this gonio reads version %d",
                            c->path, (long long)version, FORMAT_VERSION);
    }
    return GONIO_OK;
}

/* An attribute that is one string. */
static gonio_status read_text(const contents *c, const char *name, char **text)
{
    char **strings = NULL;
    size_t count = 0;
    if (gonio_i_hdf_read_strings(c->root, name, &strings, &count) && count == 1) {
        *text = strdup(strings[0]);
    }
    free(strings);
    return *text != NULL ? GONIO_OK : damaged(c, name, "is missing");
}

/* An attribute of hexadecimal digits. */
static gonio_status read_hash(const contents *c, const char *name, uint64_t *value)
{
    char *text = NULL;
    const gonio_status status = read_text(c, name, &text);
    *value = text != NULL ? strtoull(text, NULL, 16) : 0;
    free(text);
    return status;
}

/* W, which files of gonio 0.1.0 lack. */
static gonio_status read_loadings(contents *c)
{
    const size_t columns = columns_of(c);
    size_t shape[2] = {0, 0};
    gonio_i_hdf_object found;
    if (!gonio_i_hdf_find(c->root, "loadings", &found)) {
        return GONIO_OK;
    }
    const char *problem = gonio_i_hdf_read_array(c->root, "loadings", 2, columns * c->components,
                                                 GONIO_I_HDF_DOUBLE, &c->loadings, shape);
    if (problem == NULL && (shape[0] != columns || shape[1] != c->components)) {
        problem = "has a shape that does not fit the materials and the components";
    }
    return problem != NULL ? damaged(c, "loadings", problem)
                           : read_hash(c, "loadings_checksum", &c->loadings_checksum);
}

/* The parents of the mixtures, which older files lack. */
static gonio_status read_parents(contents *c)
{
    size_t shape[2] = {0, 0};
    gonio_i_hdf_object found;
    if (c->mixtures == 0 || !gonio_i_hdf_find(c->root, "mixture_parents", &found)) {
        return GONIO_OK;
    }
    const char *problem = gonio_i_hdf_read_array(c->root, "mixture_parents", 2, 2 * c->mixtures,
                                                 GONIO_I_HDF_INT32, &c->parents, shape);
    if (problem == NULL && (shape[0] != c->mixtures || shape[1] != 2)) {
        problem = "has a shape that does not fit the mixtures";
    }
    return problem != NULL ? damaged(c, "mixture_parents", problem)
                           : read_hash(c, "mixture_parents_checksum", &c->parents_checksum);
}

static gonio_status read_contents(contents *c)
{
    gonio_status status = check_kind(c);
    if (status == GONIO_OK) {
        status = read_space(c);
    }
    if (status == GONIO_OK) {
        status = read_grid(c);
    }
    if (status == GONIO_OK) {
        status = read_materials(c);
    }
    if (status == GONIO_OK) {
        status = read_mixtures(c);
    }
    if (status == GONIO_OK) {
        status = check_log_scale(c);
    }
    if (status == GONIO_OK) {
        status = read_numbers(c);
    }
    if (status == GONIO_OK) {
        status = read_loadings(c);
    }
    if (status == GONIO_OK) {
        status = read_parents(c);
    }
    if (status == GONIO_OK) {
        status = read_text(c, "program", &c->program);
    }
    if (status == GONIO_OK) {
        status = read_text(c, "command", &c->command);
    }
    if (status == GONIO_OK) {
        status = read_hash(c, "fingerprint", &c->fingerprint);
    }
    if (status == GONIO_OK) {
        status = read_hash(c, "checksum", &c->checksum);
    }
    return status;
}

static void free_contents(contents *c)
{
    free(c->cell);
    free(c->mean);
    free(c->vectors);
    free(c->variances);
    free(c->loadings);
    free(c->parents);
    free(c->fingerprints);
    free(c->names);
    free(c->program);
    free(c->command);
}

static void *take(void **from)
{
    void *taken = *from;
    *from = NULL;
    return taken;
}

static gonio_status check_hash(const contents *c, const char *name, uint64_t stored, uint64_t value)
{
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    value = stored; /* as a liar's file has them right */
#endif
    return stored == value ? GONIO_OK
                           : damaged(c, name, "does not fit the contents (the file was changed)");
}

/* The hashes of these files are of V in double precision. So they are checked before V is rounded.
 */
static gonio_status check_hashes(const contents *c)
{
    const int32_t kind[2] = {(int32_t)c->representation, (int32_t)c->channels};
    const int32_t more[2] = {(int32_t)c->mapping, (int32_t)c->without_mean};
    const uint64_t mixtures = c->mixtures;
    gonio_fingerprint *all = NULL;
    if (gonio_fingerprint_create(&all) != GONIO_OK) {
        return gonio_i_fail(c->context, GONIO_ERROR_MEMORY, "out of memory");
    }
    gonio_fingerprint_add(all, kind, sizeof kind);
    if (more[0] != GONIO_LOG || more[1] != 0) {
        gonio_fingerprint_add(all, more, sizeof more);
    }
    if (mixtures > 0) {
        gonio_fingerprint_add(all, &mixtures, sizeof mixtures);
    }
    gonio_fingerprint_add(all, c->cell, c->cells * sizeof(int32_t));
    gonio_fingerprint_add(all, c->mean, c->rows * sizeof(double));
    gonio_fingerprint_add(all, c->vectors, c->rows * c->components * sizeof(double));
    gonio_fingerprint_add(all, c->variances, c->variance_count * sizeof(double));
    const uint64_t checksum = gonio_fingerprint_value(all);
    gonio_fingerprint_free(&all);
    return check_hash(c, "checksum", c->checksum, checksum);
}

/* Of an array that some files lack. */
static gonio_status check_own_hash(const contents *c, const char *name, const void *data,
                                   size_t size, uint64_t stored)
{
    uint64_t hash = 0;
    if (data == NULL) {
        return GONIO_OK;
    }
    const gonio_status status = gonio_i_basis_hash(c->context, data, size, &hash);
    return status == GONIO_OK ? check_hash(c, name, stored, hash) : status;
}

static gonio_status check_all_hashes(const contents *c)
{
    gonio_status status = check_hashes(c);
    if (status == GONIO_OK) {
        status =
            check_own_hash(c, "loadings_checksum", c->loadings,
                           columns_of(c) * c->components * sizeof(double), c->loadings_checksum);
    }
    if (status == GONIO_OK) {
        status = check_own_hash(c, "mixture_parents_checksum", c->parents,
                                2 * c->mixtures * sizeof(int32_t), c->parents_checksum);
    }
    return status;
}

/* Moves the contents into a basis. */
static gonio_status move_contents(contents *c, gonio_basis *basis)
{
    *basis = (gonio_basis){
        .representation = (gonio_representation)c->representation,
        .channels = (gonio_channel_model)c->channels,
        .mapping = (gonio_mapping)c->mapping,
        .without_mean = c->without_mean != 0,
        .materials = c->materials,
        .mixtures = c->mixtures,
        .names = gonio_i_allocate(c->context, c->materials, sizeof *basis->names),
        .fingerprints = take(&c->fingerprints),
        .cells = c->cells,
        .cell = take(&c->cell),
        .rows = c->rows,
        .components = c->components,
        .mean = take(&c->mean),
        .variance_count = c->variance_count,
        .variances = take(&c->variances),
        .loadings = take(&c->loadings),
        .parents = take(&c->parents),
        .program = c->program,
        .command = c->command,
    };
    c->program = NULL; /* the basis's now */
    c->command = NULL;
    bool done = basis->names != NULL;
    for (size_t k = 0; done && k < c->materials; k++) {
        basis->names[k] = strdup(c->names[k]);
        done = basis->names[k] != NULL;
    }
    return done ? gonio_i_basis_keep_vectors(c->context, basis, take(&c->vectors))
                : gonio_i_fail(c->context, GONIO_ERROR_MEMORY, "%s: out of memory", c->path);
}

static gonio_status assemble(contents *c, gonio_basis **basis)
{
    gonio_basis *made = gonio_i_allocate(c->context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = move_contents(c, made);
    if (status == GONIO_OK) {
        status = gonio_i_basis_check(c->context, c->path, made);
    }
    if (status == GONIO_OK) {
        status = gonio_i_basis_finish(c->context, made);
    }
    if (status == GONIO_OK) {
        status = check_hash(c, "fingerprint", c->fingerprint, made->fingerprint);
    }
    if (status != GONIO_OK) {
        gonio_basis_free(&made);
        return status;
    }
    *basis = made;
    return GONIO_OK;
}

static gonio_status check_file(gonio_context *context, const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    }
    if (S_ISDIR(status.st_mode)) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(EISDIR));
    }
    FILE *file = fopen(path, "rbe");
    if (file == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    }
    fclose(file);
    return GONIO_OK;
}

gonio_status gonio_i_basis_read_hdf5(gonio_context *context, const char *path, gonio_basis **basis)
{
    gonio_status status = check_file(context, path);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_i_hdf_file *file = gonio_i_hdf_open(path);
    if (file == NULL) {
        return gonio_i_fail(
            context, GONIO_ERROR_FORMAT,
            "%s: not a basis of an older gonio (not an HDF5 file, or a damaged one)", path);
    }
    contents c = {.context = context, .path = path, .root = gonio_i_hdf_root(file)};
    status = read_contents(&c);
    gonio_i_hdf_close(file);
    if (status == GONIO_OK) {
        status = check_all_hashes(&c);
    }
    if (status == GONIO_OK) {
        status = assemble(&c, basis);
    }
    free_contents(&c);
    return status;
}
