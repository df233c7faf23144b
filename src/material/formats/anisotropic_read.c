/* Reading anisotropic tables in HDF5: anisotropic_file.h has the layout. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/hdf_read.h"
#include "../anisotropic_table.h"
#include "anisotropic_file.h"
#include "format.h"

enum { RANK = GONIO_I_ANISOTROPIC_RANK, MOST_CHANNELS = 4096 };

/* A file while it is read. */
typedef struct reader {
    gonio_context *context;
    const char *path;
    gonio_i_hdf_object root;
    gonio_anisotropic_table t;
} reader;

static gonio_status damaged(const reader *in, const char *what)
{
    return gonio_i_fail(in->context, GONIO_ERROR_FORMAT, "%s: %s", in->path, what);
}

/* The sizes of the table from the shape of its coefficients, and what is wrong with it, or NULL. */
static const char *find_shape(reader *in)
{
    gonio_i_hdf_object set;
    gonio_i_hdf_array array = {0};
    if (!gonio_i_hdf_find(in->root, "coefficient", &set)) {
        return "is missing";
    }
    const char *problem = gonio_i_hdf_describe(set, &array);
    const size_t *extent = array.extent;
    if (problem != NULL) {
        return problem;
    }
    if (array.rank != RANK || extent[0] != GONIO_THETA_H_BINS || extent[1] != GONIO_THETA_D_BINS ||
        extent[2] > GONIO_PHI_D_BINS || extent[3] > MOST_CHANNELS || extent[4] % 2 != 1 ||
        extent[4] > 1 + 2 * GONIO_ANISOTROPIC_ORDERS) {
        return "is not 90 x 90 x phi_d x channels x (1 + 2 orders)";
    }
    in->t.phi_d_cells = (int)extent[2];
    in->t.channels = extent[3];
    in->t.orders = (int)(extent[4] / 2);
    return NULL;
}

/* Numbers of a dataset of one dimension. */
static gonio_status read_numbers(const reader *in, const char *name, size_t expected,
                                 const double **numbers)
{
    void *data = NULL;
    size_t count = 0;
    const char *wrong =
        gonio_i_hdf_read_array(in->root, name, 1, MOST_CHANNELS, GONIO_I_HDF_DOUBLE, &data, &count);
    if (wrong != NULL) {
        return gonio_i_fail(in->context, GONIO_ERROR_FORMAT, "%s: %s %s", in->path, name, wrong);
    }
    if (count != expected) {
        free(data);
        return gonio_i_fail(in->context, GONIO_ERROR_FORMAT, "%s: %s must have %zu numbers",
                            in->path, name, expected);
    }
    *numbers = data;
    return GONIO_OK;
}

static gonio_status read_lists(reader *in)
{
    const double *limit = NULL;
    gonio_i_hdf_object found;
    gonio_status status = read_numbers(in, "floor", in->t.channels, &in->t.floor);
    if (status == GONIO_OK && gonio_i_hdf_find(in->root, "wavelength_nm", &found)) {
        status = read_numbers(in, "wavelength_nm", in->t.channels, &in->t.wavelength);
    }
    if (status == GONIO_OK) {
        status = read_numbers(in, "theta_limit", 1, &limit);
    }
    if (status == GONIO_OK && limit != NULL) {
        in->t.theta_limit = limit[0];
    }
    free((void *)limit);
    return status;
}

/* A series with a number that is not finite has no data. */
static void mark_holes(const gonio_anisotropic_table *t, float *coefficient)
{
    const size_t terms = 1 + 2 * (size_t)t->orders;
    const size_t series = gonio_i_anisotropic_count(t) / terms;
    for (size_t k = 0; k < series; k++, coefficient += terms) {
        bool finite = true;
        for (size_t n = 0; n < terms; n++) {
            finite = finite && isfinite(coefficient[n]);
        }
        coefficient[0] = finite ? coefficient[0] : NAN;
    }
}

static gonio_status read_coefficients(reader *in)
{
    size_t shape[RANK];
    void *coefficient = NULL;
    const char *wrong =
        gonio_i_hdf_read_array(in->root, "coefficient", RANK, gonio_i_anisotropic_count(&in->t),
                               GONIO_I_HDF_FLOAT, &coefficient, shape);
    if (wrong != NULL) {
        return gonio_i_fail(in->context, GONIO_ERROR_FORMAT, "%s: coefficient %s", in->path, wrong);
    }
    mark_holes(&in->t, coefficient);
    in->t.coefficient = coefficient;
    return GONIO_OK;
}

static gonio_status read_table(reader *in)
{
    int64_t version = 0;
    int64_t symmetry = 0;
    if (!gonio_i_hdf_read_number(in->root, "version", &version) ||
        version != GONIO_I_ANISOTROPIC_VERSION ||
        !gonio_i_hdf_read_number(in->root, "symmetry", &symmetry)) {
        return damaged(in, "a table of another version, or a damaged one");
    }
    in->t.symmetry = symmetry >= 1 && symmetry <= GONIO_ANISOTROPIC_ORDERS ? (int)symmetry : 0;
    const char *wrong = find_shape(in);
    if (wrong != NULL) {
        return gonio_i_fail(in->context, GONIO_ERROR_FORMAT, "%s: coefficient %s", in->path, wrong);
    }
    const gonio_status status = read_lists(in);
    if (status != GONIO_OK) {
        return status;
    }
    return gonio_i_anisotropic_fits(&in->t)
               ? read_coefficients(in)
               : damaged(in, "these sizes and numbers are not those of a table");
}

static gonio_status read_file(reader *in)
{
    gonio_i_hdf_file *file = gonio_i_hdf_open(in->path);
    if (file == NULL) {
        return damaged(in, "a damaged HDF5 file");
    }
    in->root = gonio_i_hdf_root(file);
    const gonio_status status = read_table(in);
    gonio_i_hdf_close(file);
    return status;
}

static gonio_status open_table(gonio_context *context, const gonio_i_file *file,
                               gonio_material_source *source, char **description)
{
    reader in = {.context = context, .path = file->path, .t = {.size = sizeof in.t}};
    gonio_status status = read_file(&in);
    if (status == GONIO_OK) {
        *description = gonio_i_anisotropic_describe(&in.t);
        status = gonio_i_anisotropic_source(context, &in.t, source);
    }
    if (status != GONIO_OK) {
        gonio_i_anisotropic_clear(&in.t);
    }
    return status;
}

/* HDF5 with the format's name, which stands near the start. */
static bool recognises(const gonio_i_file *file)
{
    static const char name[] = GONIO_I_ANISOTROPIC_FORMAT;
    return gonio_i_file_begins(file, "\x89HDF\r\n\x1a\n", 8) &&
           memmem(file->head, file->head_size, name, sizeof name - 1) != NULL;
}

const gonio_i_format_reader gonio_i_anisotropic_reader = {
    .name = "gonio anisotropic table .h5", .recognises = recognises, .open = open_table};
