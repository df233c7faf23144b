/* The basis file: HDF5, layout in docs/basis-file.md. */
#include "basis.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../core/hdf.h"
#include "../core/output.h"
#include "../linalg/linalg.h"

enum { FORMAT_VERSION = 1, MOST_MATERIALS = 1 << 20 };

static const char format_name[] = "gonio basis";
/* Words for the values of an enumeration, from 0 on. */
static const char *const representations[] = {"bivariate", "full", "sectored", NULL};
static const char *const channel_models[] = {"joint", "separate", NULL};
static const char *const mappings[] = {"log", "relative", NULL};
static const char *const centrings[] = {"mean", "none", NULL};

/* ---- writing ---- */

static bool write_grid(hid_t file, const gonio_basis *basis)
{
    const hid_t grid = H5Gcreate2(file, "grid", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const bool done =
        grid >= 0 && gonio_i_hdf_write_number(grid, "theta_h_bins", GONIO_THETA_H_BINS) &&
        gonio_i_hdf_write_number(grid, "theta_d_bins", GONIO_THETA_D_BINS) &&
        gonio_i_hdf_write_number(grid, "phi_d_bins", GONIO_PHI_D_BINS) &&
        gonio_i_hdf_write_string(grid, "representation", representations[basis->representation]) &&
        gonio_i_hdf_write_string(grid, "channels", channel_models[basis->channels]) &&
        gonio_i_hdf_write_array(grid, "cell", 1, &basis->cells, H5T_NATIVE_INT32, H5T_STD_I32LE,
                                basis->cell);
    if (grid >= 0) {
        H5Gclose(grid);
    }
    return done;
}

static bool write_materials(hid_t file, const gonio_basis *basis)
{
    const hid_t group = H5Gcreate2(file, "materials", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const bool done =
        group >= 0 &&
        gonio_i_hdf_write_strings(group, "name", basis->materials,
                                  (const char *const *)basis->names) &&
        gonio_i_hdf_write_array(group, "fingerprint", 1, &basis->materials, H5T_NATIVE_UINT64,
                                H5T_STD_U64LE, basis->fingerprints);
    if (group >= 0) {
        H5Gclose(group);
    }
    return done;
}

static bool write_hash(hid_t file, const char *name, uint64_t value)
{
    char text[32];
    snprintf(text, sizeof text, "%016" PRIx64, value);
    return gonio_i_hdf_write_string(file, name, text);
}

static bool write_loadings(hid_t file, const gonio_basis *basis)
{
    const size_t shape[2] = {gonio_i_basis_columns(basis), basis->components};
    return basis->loadings == NULL ||
           (write_hash(file, "loadings_checksum", basis->loadings_checksum) &&
            gonio_i_hdf_write_array(file, "loadings", 2, shape, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE,
                                    basis->loadings));
}

static bool write_parents(hid_t file, const gonio_basis *basis)
{
    const size_t shape[2] = {basis->mixtures, 2};
    return basis->parents == NULL ||
           (write_hash(file, "mixture_parents_checksum", basis->parents_checksum) &&
            gonio_i_hdf_write_array(file, "mixture_parents", 2, shape, H5T_NATIVE_INT32,
                                    H5T_STD_I32LE, basis->parents));
}

static bool write_contents(hid_t file, const gonio_basis *basis, const char *command)
{
    const size_t scales = GONIO_CHANNELS;
    const double scale[GONIO_CHANNELS] = {gonio_log_scale(0), gonio_log_scale(1),
                                          gonio_log_scale(2)};
    const size_t shape[2] = {basis->rows, basis->components};
    return gonio_i_hdf_write_string(file, "format", format_name) &&
           gonio_i_hdf_write_number(file, "format_version", FORMAT_VERSION) &&
           gonio_i_hdf_write_string(file, "program", basis->program) &&
           gonio_i_hdf_write_string(file, "command", command != NULL ? command : "") &&
           gonio_i_hdf_write_string(file, "mapping", mappings[basis->mapping]) &&
           gonio_i_hdf_write_string(file, "centring", centrings[basis->without_mean]) &&
           gonio_i_hdf_write_number(file, "mixtures", (int64_t)basis->mixtures) &&
           write_hash(file, "fingerprint", basis->fingerprint) &&
           write_hash(file, "checksum", basis->checksum) && write_grid(file, basis) &&
           write_materials(file, basis) && write_loadings(file, basis) &&
           write_parents(file, basis) &&
           gonio_i_hdf_write_array(file, "log_scale", 1, &scales, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE,
                                   scale) &&
           gonio_i_hdf_write_array(file, "mean", 1, &basis->rows, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE,
                                   basis->mean) &&
           gonio_i_hdf_write_array(file, "components", 2, shape, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE,
                                   basis->vectors) &&
           gonio_i_hdf_write_array(file, "variances", 1, &basis->variance_count, H5T_NATIVE_DOUBLE,
                                   H5T_IEEE_F64LE, basis->variances);
}

/* The file is made in memory and then written like any other output: HDF5 does not survive a disk
 * that fills up while it writes. */
static gonio_status write_image(gonio_context *context, const gonio_basis *basis,
                                const char *command, gonio_i_output *output)
{
    const hid_t file = gonio_i_hdf_create_image();
    const void *image = NULL;
    size_t size = 0;
    gonio_status status = GONIO_OK;
    if (file >= 0 && write_contents(file, basis, command) &&
        gonio_i_hdf_read_image(file, &image, &size)) {
        status = gonio_i_output_write(context, output, image, size);
    } else {
        status = gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", output->path);
    }
    if (file >= 0) {
        H5Fclose(file);
    }
    return status;
}

gonio_status gonio_basis_write(gonio_context *context, const gonio_basis *basis,
                               const char *command, const char *path)
{
    gonio_i_output output;
    gonio_status status = gonio_i_output_open(context, path, &output);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_i_hdf_session session;
    gonio_i_hdf_enter(&session);
    status = write_image(context, basis, command, &output);
    gonio_i_hdf_leave(&session);
    return gonio_i_output_close(context, &output, status);
}

/* ---- reading ---- */

/* What a file holds, before it becomes a basis. */
typedef struct contents {
    gonio_context *context;
    const char *path;
    hid_t file;
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

static gonio_status read_word(const contents *c, hid_t parent, const char *name,
                              const char *const *words, int64_t *value)
{
    char **text = NULL;
    size_t count = 0;
    *value = -1;
    if (gonio_i_hdf_read_strings(parent, name, false, &text, &count) && count == 1) {
        for (int k = 0; words[k] != NULL; k++) {
            *value = strcmp(text[0], words[k]) == 0 ? k : *value;
        }
    }
    free(text);
    return *value >= 0 ? GONIO_OK : damaged(c, name, "is missing or unknown");
}

/* What a file of gonio 0.1.0 does not say: then it is the first of the words. */
static gonio_status read_new_word(const contents *c, const char *name, const char *const *words,
                                  int64_t *value)
{
    *value = 0;
    return H5Aexists(c->file, name) > 0 ? read_word(c, c->file, name, words, value) : GONIO_OK;
}

static gonio_status read_space(contents *c)
{
    const gonio_status status = read_new_word(c, "mapping", mappings, &c->mapping);
    return status == GONIO_OK ? read_new_word(c, "centring", centrings, &c->without_mean) : status;
}

/* Columns that are no materials', which files of gonio 0.1.0 do not have. */
static gonio_status read_mixtures(contents *c)
{
    int64_t mixtures = 0;
    if (H5Aexists(c->file, "mixtures") > 0 &&
        (!gonio_i_hdf_read_number(c->file, "mixtures", &mixtures) || mixtures < 0 ||
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
    const hid_t grid = H5Gopen2(c->file, "grid", H5P_DEFAULT);
    if (grid < 0) {
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
        const char *problem = gonio_i_hdf_read_array(grid, "cell", 1, GONIO_BINS, H5T_NATIVE_INT32,
                                                     &c->cell, &c->cells);
        status = problem != NULL ? damaged(c, "grid/cell", problem) : GONIO_OK;
    }
    H5Gclose(grid);
    return status;
}

static gonio_status read_materials(contents *c)
{
    size_t fingerprints = 0;
    if (!gonio_i_hdf_read_strings(c->file, "materials/name", true, &c->names, &c->materials)) {
        return damaged(c, "materials/name", "is missing or not a list of strings");
    }
    const char *problem =
        gonio_i_hdf_read_array(c->file, "materials/fingerprint", 1, MOST_MATERIALS,
                               H5T_NATIVE_UINT64, &c->fingerprints, &fingerprints);
    if (problem == NULL && fingerprints != c->materials) {
        problem = "has a wrong shape";
    }
    return problem != NULL ? damaged(c, "materials/fingerprint", problem) : GONIO_OK;
}

/* Another scale would be another log space. */
static gonio_status check_log_scale(const contents *c)
{
    void *scale = NULL;
    size_t count = 0;
    const char *problem =
        gonio_i_hdf_read_array(c->file, "log_scale", 1, 64, H5T_NATIVE_DOUBLE, &scale, &count);
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
    /* Each size limits the next, so that no file asks for more memory than its grid needs. */
    const size_t rows = gonio_i_basis_row_count(c->cells, (gonio_channel_model)c->channels);
    size_t shape[2] = {0, 0};
    const char *what = "mean";
    const char *problem =
        gonio_i_hdf_read_array(c->file, what, 1, rows, H5T_NATIVE_DOUBLE, &c->mean, &c->rows);
    if (problem == NULL) {
        what = "variances";
        problem = gonio_i_hdf_read_array(c->file, what, 1, columns_of(c), H5T_NATIVE_DOUBLE,
                                         &c->variances, &c->variance_count);
    }
    if (problem == NULL) {
        what = "components";
        problem = gonio_i_hdf_read_array(c->file, what, 2, rows * c->variance_count,
                                         H5T_NATIVE_DOUBLE, &c->vectors, shape);
        c->components = shape[1];
    }
    if (problem == NULL && (c->rows != rows || shape[0] != c->rows || c->components == 0 ||
                            c->cells == 0 || c->components > c->variance_count)) {
        what = "components";
        problem = "has a shape that does not fit the grid and the mean";
    }
    return problem != NULL ? damaged(c, what, problem) : GONIO_OK;
}

/* It is one of ours, and of a version that this program knows. */
static gonio_status check_kind(const contents *c)
{
    char **text = NULL;
    size_t count = 0;
    int64_t version = 0;
    const bool ours = gonio_i_hdf_read_strings(c->file, "format", false, &text, &count) &&
                      count == 1 && strcmp(text[0], format_name) == 0;
    free(text);
    if (!ours) {
        return gonio_i_fail(c->context, GONIO_ERROR_FORMAT,
                            "%s: an HDF5 file, but not a gonio basis; gonio learn makes one",
                            c->path);
    }
    if (!gonio_i_hdf_read_number(c->file, "format_version", &version) ||
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
    if (gonio_i_hdf_read_strings(c->file, name, false, &strings, &count) && count == 1) {
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
    if (H5Lexists(c->file, "loadings", H5P_DEFAULT) <= 0) {
        return GONIO_OK;
    }
    const char *problem = gonio_i_hdf_read_array(c->file, "loadings", 2, columns * c->components,
                                                 H5T_NATIVE_DOUBLE, &c->loadings, shape);
    if (problem == NULL && (shape[0] != columns || shape[1] != c->components)) {
        problem = "has a shape that does not fit the materials and the components";
    }
    return problem != NULL ? damaged(c, "loadings", problem)
                           : read_hash(c, "loadings_checksum", &c->loadings_checksum);
}

/* What mixtures are made of, which older files lack. */
static gonio_status read_parents(contents *c)
{
    size_t shape[2] = {0, 0};
    if (c->mixtures == 0 || H5Lexists(c->file, "mixture_parents", H5P_DEFAULT) <= 0) {
        return GONIO_OK;
    }
    const char *problem = gonio_i_hdf_read_array(c->file, "mixture_parents", 2, 2 * c->mixtures,
                                                 H5T_NATIVE_INT32, &c->parents, shape);
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

static bool all_finite(const double *values, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        if (!isfinite(values[k])) {
            return false;
        }
    }
    return true;
}

static bool cells_in_order(const contents *c)
{
    const int32_t *cell = c->cell;
    const int32_t end = gonio_grid_cells((gonio_representation)c->representation);
    int32_t last = -1;
    for (size_t k = 0; k < c->cells; k++) {
        if (cell[k] <= last || cell[k] >= end) {
            return false;
        }
        last = cell[k];
    }
    return true;
}

static bool parents_are_measured(const contents *c)
{
    const int32_t *parent = c->parents;
    for (size_t k = 0; parent != NULL && k < 2 * c->mixtures; k++) {
        if (parent[k] < 0 || (size_t)parent[k] >= measured_of(c)) {
            return false;
        }
    }
    return true;
}

/* max |V'V - I| */
static gonio_status check_orthonormal(const contents *c)
{
    const size_t k = c->components;
    double *gram = gonio_i_allocate(c->context, k * k, sizeof *gram);
    if (gram == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = gonio_i_gram_rows(c->context, c->vectors, c->rows, k, k, gram);
    for (size_t j = 0; j < k * k && status == GONIO_OK; j++) {
        if (!(fabs(gram[j] - (j % (k + 1) == 0 ? 1.0 : 0.0)) < 1e-8)) {
            status = damaged(c, "components", "are not orthonormal");
        }
    }
    free(gram);
    return status;
}

static gonio_status check_values(const contents *c)
{
    if (!cells_in_order(c)) {
        return damaged(c, "grid/cell", "is not a rising list of cells of the grid");
    }
    if (!all_finite(c->mean, c->rows) || !all_finite(c->vectors, c->rows * c->components) ||
        !all_finite(c->variances, c->variance_count)) {
        return damaged(c, "mean, components or variances", "holds a number that is not finite");
    }
    const size_t columns = columns_of(c);
    if (c->loadings != NULL && !all_finite(c->loadings, columns * c->components)) {
        return damaged(c, "loadings", "holds a number that is not finite");
    }
    if (!parents_are_measured(c)) {
        return damaged(c, "mixture_parents", "names a column that no material has");
    }
    return check_orthonormal(c);
}

static void *take(void **from)
{
    void *taken = *from;
    *from = NULL;
    return taken;
}

static gonio_status check_hash(const contents *c, const char *name, uint64_t stored, uint64_t value)
{
    return stored == value ? GONIO_OK
                           : damaged(c, name, "does not fit the contents (the file was changed)");
}

/* Moves what was read into a basis. */
static gonio_status assemble(contents *c, gonio_basis **basis)
{
    gonio_basis *made = gonio_i_allocate(c->context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *made = (gonio_basis){
        .representation = (gonio_representation)c->representation,
        .channels = (gonio_channel_model)c->channels,
        .mapping = (gonio_mapping)c->mapping,
        .without_mean = c->without_mean != 0,
        .materials = c->materials,
        .mixtures = c->mixtures,
        .names = gonio_i_allocate(c->context, c->materials, sizeof *made->names),
        .fingerprints = take(&c->fingerprints),
        .cells = c->cells,
        .cell = take(&c->cell),
        .rows = c->rows,
        .components = c->components,
        .mean = take(&c->mean),
        .vectors = take(&c->vectors),
        .variance_count = c->variance_count,
        .variances = take(&c->variances),
        .loadings = take(&c->loadings),
        .parents = take(&c->parents),
        .program = c->program,
        .command = c->command,
    };
    c->program = NULL; /* the basis's now */
    c->command = NULL;
    bool done = made->names != NULL;
    for (size_t k = 0; done && k < c->materials; k++) {
        made->names[k] = strdup(c->names[k]);
        done = made->names[k] != NULL;
    }
    gonio_status status = done ? gonio_i_basis_finish(c->context, made) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = check_hash(c, "checksum", c->checksum, made->checksum);
    }
    if (status == GONIO_OK) {
        status = check_hash(c, "fingerprint", c->fingerprint, made->fingerprint);
    }
    if (status == GONIO_OK) {
        status = check_hash(c, "loadings_checksum", c->loadings_checksum, made->loadings_checksum);
    }
    if (status == GONIO_OK) {
        status =
            check_hash(c, "mixture_parents_checksum", c->parents_checksum, made->parents_checksum);
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

bool gonio_i_basis_may_be(const gonio_i_file *file)
{
    return gonio_i_file_begins(file, "\x89HDF\r\n\x1a\n", 8);
}

const char *gonio_i_basis_format_of(const gonio_i_file *file)
{
    const bool marked =
        memmem(file->head, file->head_size, format_name, sizeof format_name - 1) != NULL;
    return gonio_i_basis_may_be(file) && marked ? format_name : NULL;
}

const char *gonio_i_basis_format_name(int index)
{
    return index == 0 ? format_name : NULL;
}

gonio_status gonio_basis_read(gonio_context *context, const char *path, gonio_basis **basis)
{
    gonio_status status = check_file(context, path);
    if (status != GONIO_OK) {
        return status;
    }
    contents c = {.context = context, .path = path};
    gonio_i_hdf_session session;
    gonio_i_hdf_enter(&session);
    c.file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (c.file < 0) {
        status = gonio_i_fail(context, GONIO_ERROR_FORMAT,
                              "%s: not a gonio basis (not an HDF5 file, or a damaged one); "
                              "gonio learn makes one",
                              path);
    } else {
        status = read_contents(&c);
        H5Fclose(c.file);
    }
    gonio_i_hdf_leave(&session);
    if (status == GONIO_OK) {
        status = check_values(&c);
    }
    if (status == GONIO_OK) {
        status = assemble(&c, basis);
    }
    free_contents(&c);
    return status;
}
