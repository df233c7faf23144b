/* Reading tables of any channels in HDF5: table_file.h has the layout. Between the centres of bins
 * values are linear, as in tables of R, G, B (gonio_table_value). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/hdf.h"
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

/* The shape of rho; false if it is no table of the grid. */
static bool find_shape(hid_t rho, table *t)
{
    hsize_t extents[H5S_MAX_RANK] = {0};
    const hid_t space = H5Dget_space(rho);
    const bool simple = H5Sis_simple(space) > 0 &&
                        H5Sget_simple_extent_ndims(space) == GONIO_I_TABLE_RANK &&
                        H5Sget_simple_extent_dims(space, extents, NULL) >= 0;
    H5Sclose(space);
    t->channels = (size_t)extents[0];
    return simple && extents[0] >= 1 && extents[0] <= GONIO_I_TABLE_CHANNELS &&
           extents[1] == GONIO_THETA_H_BINS && extents[2] == GONIO_THETA_D_BINS &&
           extents[3] == GONIO_PHI_D_BINS;
}

/* Whether rho is in this file, not in others that it names, and can have the stated size:
 * compression makes numbers at most a thousand times smaller. */
static bool is_stored(hid_t rho, const table *t)
{
    enum { MOST_DEFLATION = 2000 };
    const double bytes = (double)t->channels * GONIO_BINS * sizeof(float);
    const hid_t properties = H5Dget_create_plist(rho);
    const bool own = H5Pget_external_count(properties) == 0 &&
                     H5Pget_layout(properties) != H5D_VIRTUAL &&
                     bytes <= (double)H5Dget_storage_size(rho) * MOST_DEFLATION;
    H5Pclose(properties);
    return own;
}

static bool read_slab(hid_t rho, size_t channel, size_t theta_h, float *slab)
{
    const hsize_t start[GONIO_I_TABLE_RANK] = {channel, theta_h, 0, 0};
    const hsize_t count[GONIO_I_TABLE_RANK] = {1, 1, GONIO_THETA_D_BINS, GONIO_PHI_D_BINS};
    const hid_t memory = H5Screate_simple(GONIO_I_TABLE_RANK, count, NULL);
    const hid_t place = H5Dget_space(rho);
    const bool done = H5Sselect_hyperslab(place, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
                      H5Dread(rho, H5T_NATIVE_FLOAT, memory, place, H5P_DEFAULT, slab) >= 0;
    H5Sclose(memory);
    H5Sclose(place);
    return done;
}

static gonio_status read_values(gonio_context *context, const char *path, hid_t rho, table *t)
{
    float *slab = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof *slab);
    t->value = gonio_i_allocate(context, GONIO_BINS * t->channels, sizeof *t->value);
    gonio_status status = slab != NULL && t->value != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t c = 0; c < t->channels; c++) {
        for (size_t h = 0; h < GONIO_THETA_H_BINS && status == GONIO_OK; h++) {
            if (!read_slab(rho, c, h, slab)) {
                status = damaged(context, path, "rho cannot be read; the file is damaged");
            }
            for (size_t k = 0; k < GONIO_SLAB_BINS && status == GONIO_OK; k++) {
                t->value[(h * GONIO_SLAB_BINS + k) * t->channels + c] =
                    isfinite(slab[k]) ? slab[k] : NAN;
            }
        }
    }
    free(slab);
    return status;
}

static gonio_status read_wavelengths(gonio_context *context, const char *path, hid_t file, table *t)
{
    size_t count = 0;
    void *wavelength = NULL;
    if (H5Lexists(file, "wavelength_nm", H5P_DEFAULT) <= 0) {
        return t->channels == 1 || t->channels == GONIO_CHANNELS
                   ? GONIO_OK
                   : damaged(context, path, "neither 1 or 3 channels nor wavelength_nm");
    }
    const char *wrong = gonio_i_hdf_read_array(file, "wavelength_nm", 1, GONIO_I_TABLE_CHANNELS,
                                               H5T_NATIVE_DOUBLE, &wavelength, &count);
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

static gonio_status read_table(gonio_context *context, const char *path, hid_t file, table *t)
{
    int64_t version = 0;
    if (!gonio_i_hdf_read_number(file, "version", &version) || version != GONIO_I_TABLE_VERSION) {
        return damaged(context, path, "a table of another version, or a damaged one");
    }
    const hid_t rho = H5Dopen2(file, "rho", H5P_DEFAULT);
    if (rho < 0) {
        return damaged(context, path, "a table without rho");
    }
    gonio_status status =
        find_shape(rho, t)
            ? GONIO_OK
            : damaged(context, path,
                      "rho is not channels x 90 x 90 x 180 (theta_h, theta_d, phi_d)");
    if (status == GONIO_OK && !is_stored(rho, t)) {
        status = damaged(context, path, "rho is not in the file, or not all of it");
    }
    if (status == GONIO_OK) {
        status = read_wavelengths(context, path, file, t);
    }
    if (status == GONIO_OK) {
        status = read_values(context, path, rho, t);
    }
    H5Dclose(rho);
    return status;
}

static gonio_status read_file(gonio_context *context, const char *path, table *t)
{
    gonio_i_hdf_session session;
    gonio_i_hdf_enter(&session);
    const hid_t file = gonio_i_hdf_open(path);
    const gonio_status status = file >= 0 ? read_table(context, path, file, t)
                                          : damaged(context, path, "a damaged HDF5 file");
    if (file >= 0) {
        H5Fclose(file);
    }
    gonio_i_hdf_leave(&session);
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

const gonio_i_format_reader gonio_i_table_reader = {"gonio BRDF table .h5", recognises, open_table};
