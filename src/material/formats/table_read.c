/* Reading tables of any channels in HDF5: table_file.h has the layout. Between the centres of bins
 * values are linear, as in tables of R, G, B (gonio_table_value). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/hdf_read.h"
#include "../../direction/grid.h"
#include "format.h"
#include "table_file.h"

typedef struct table {
    size_t channels;
    double *wavelength; /* [channels], nm; NULL for colours or grey */
    float *value;       /* [bin][channel] */
} table;

static void release(void *self)
{
    table *t = self;
    free(t->wavelength);
    free(t->value);
    free(t);
}

static void evaluate_pair(const table *t, gonio_pair pair, double *values)
{
    gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
    const int points = gonio_i_trilinear(gonio_half_difference_from_pair(pair), stencil);
    for (size_t c = 0; c < t->channels; c++) {
        double sum = 0.0;
        double total = 0.0;
        for (int k = 0; k < points; k++) {
            const size_t bin = (size_t)gonio_bin_index(stencil[k].bin);
            const double here = (double)t->value[bin * t->channels + c];
            sum += here >= 0.0 ? stencil[k].weight * here : 0.0;
            total += here >= 0.0 ? stencil[k].weight : 0.0;
        }
        values[c] = total > 0.0 ? sum / total : NAN;
    }
}

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    const table *t = self;
    (void)context;
    for (size_t k = 0; k < count; k++) {
        evaluate_pair(t, pairs[k], values + k * t->channels);
    }
    return GONIO_OK;
}

/* ---- reading ---- */

static gonio_status damaged(gonio_context *context, const char *path, const char *what)
{
    return gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: %s", path, what);
}

/* The shape of rho, and what is wrong with it; NULL if it is a table of the grid. */
static const char *find_shape(gonio_i_hdf_object rho, gonio_i_hdf_array *array)
{
    const char *problem = gonio_i_hdf_describe(rho, array);
    const size_t *extent = array->extent;
    const bool fits = problem != NULL ||
                      (array->rank == GONIO_I_TABLE_RANK && extent[0] >= 1 &&
                       extent[0] <= GONIO_I_TABLE_CHANNELS && extent[1] == GONIO_THETA_H_BINS &&
                       extent[2] == GONIO_THETA_D_BINS && extent[3] == GONIO_PHI_D_BINS);
    return fits ? problem : "is not channels x 90 x 90 x 180 (theta_h, theta_d, phi_d)";
}

/* Moves numbers of rho[channel][bin] to value[bin][channel]. */
static void keep_run(void *user, size_t first, size_t count, const void *values)
{
    const table *t = user;
    const float *run = values;
    for (size_t k = 0; k < count; k++) {
        const size_t channel = (first + k) / GONIO_BINS;
        const size_t bin = (first + k) % GONIO_BINS;
        t->value[bin * t->channels + channel] = isfinite(run[k]) ? run[k] : NAN;
    }
}

static gonio_status read_rho(gonio_context *context, const char *path, gonio_i_hdf_object rho,
                             table *t)
{
    gonio_i_hdf_array array = {0};
    const char *problem = find_shape(rho, &array);
    if (problem != NULL) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: rho %s", path, problem);
    }
    t->channels = array.extent[0];
    const size_t count = GONIO_BINS * t->channels;
    t->value = gonio_i_allocate(context, count, sizeof *t->value);
    if (t->value == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const float unwritten = isfinite(array.unwritten) ? (float)array.unwritten : NAN;
    for (size_t k = 0; k < count && unwritten != 0.0F; k++) {
        t->value[k] = unwritten;
    }
    problem = gonio_i_hdf_visit(rho, GONIO_I_HDF_FLOAT, keep_run, t);
    return problem == NULL ? GONIO_OK
                           : gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: rho %s", path, problem);
}

static gonio_status read_wavelengths(gonio_context *context, const char *path,
                                     gonio_i_hdf_object root, table *t)
{
    size_t count = 0;
    void *wavelength = NULL;
    gonio_i_hdf_object found;
    if (!gonio_i_hdf_find(root, "wavelength_nm", &found)) {
        return t->channels == 1 || t->channels == GONIO_CHANNELS
                   ? GONIO_OK
                   : damaged(context, path, "neither 1 or 3 channels nor wavelength_nm");
    }
    const char *wrong = gonio_i_hdf_read_array(root, "wavelength_nm", 1, GONIO_I_TABLE_CHANNELS,
                                               GONIO_I_HDF_DOUBLE, &wavelength, &count);
    if (wrong != NULL) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: wavelength_nm: %s", path, wrong);
    }
    t->wavelength = wavelength;
    bool good = count == t->channels;
    for (size_t k = 0; good && k < count; k++) {
        good = t->wavelength[k] > 0.0 && isfinite(t->wavelength[k]);
    }
    return good ? GONIO_OK
                : damaged(context, path, "wavelength_nm must have one wavelength for each channel");
}

static gonio_status read_table(gonio_context *context, const char *path, gonio_i_hdf_object root,
                               table *t)
{
    int64_t version = 0;
    gonio_i_hdf_object rho;
    if (!gonio_i_hdf_read_number(root, "version", &version) || version != GONIO_I_TABLE_VERSION) {
        return damaged(context, path, "a table of another version, or a damaged one");
    }
    if (!gonio_i_hdf_find(root, "rho", &rho)) {
        return damaged(context, path, "a table without rho");
    }
    const gonio_status status = read_rho(context, path, rho, t);
    return status == GONIO_OK ? read_wavelengths(context, path, root, t) : status;
}

static gonio_status read_file(gonio_context *context, const char *path, table *t)
{
    gonio_i_hdf_file *file = gonio_i_hdf_open(path);
    if (file == NULL) {
        return damaged(context, path, "a damaged HDF5 file");
    }
    const gonio_status status = read_table(context, path, gonio_i_hdf_root(file), t);
    gonio_i_hdf_close(file);
    return status;
}

static gonio_status open_table(gonio_context *context, const gonio_i_file *file,
                               gonio_material_source *source, char **description)
{
    table *t = gonio_i_allocate(context, 1, sizeof *t);
    gonio_status status = t != NULL ? read_file(context, file->path, t) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        *description = gonio_i_format("gonio BRDF table %d x %d x %d, %zu %s%s", GONIO_THETA_H_BINS,
                                      GONIO_THETA_D_BINS, GONIO_PHI_D_BINS, t->channels,
                                      t->wavelength != NULL ? "wavelength" : "channel",
                                      t->channels == 1 ? "" : "s");
    }
    if (status != GONIO_OK) {
        if (t != NULL) {
            release(t);
        }
        return status;
    }
    *source = (gonio_material_source){.evaluate = evaluate,
                                      .release = release,
                                      .self = t,
                                      .channels = t->channels,
                                      .wavelength = t->wavelength};
    return GONIO_OK;
}

/* HDF5 with the format's name, which stands near the start. */
static bool recognises(const gonio_i_file *file)
{
    static const char name[] = GONIO_I_TABLE_FORMAT;
    return gonio_i_file_begins(file, "\x89HDF\r\n\x1a\n", 8) &&
           memmem(file->head, file->head_size, name, sizeof name - 1) != NULL;
}

const gonio_i_format_reader gonio_i_table_reader = {
    .name = "gonio BRDF table .h5", .recognises = recognises, .open = open_table};
