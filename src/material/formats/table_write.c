/* Writing tables of any channels in HDF5: table_file.h has the layout. */
#include <math.h>
#include <stdlib.h>

#include "../../core/hdf_write.h"
#include "../../core/output.h"
#include "../sampler.h"
#include "anisotropic_file.h"
#include "table_file.h"
#include "writers.h"

enum { BINS = GONIO_SLAB_BINS, SIDES = 2, DEFLATE = 4 };

typedef struct writer {
    gonio_context *context;
    const gonio_i_sampler *sampler;
    hid_t file;
    hid_t rho;
    gonio_pair *pair; /* [BINS][SIDES] */
    double *value;    /* [BINS][SIDES][channels] */
    float *slab;      /* [BINS], of a channel */
    bool *inside;     /* [BINS] */
} writer;

/* The pairs at the centres of a slab's bins, either side of the reciprocal pair. */
static void set_directions(const writer *w, int theta_h)
{
    for (int k = 0; k < BINS; k++) {
        const gonio_bin bin = {theta_h, k / GONIO_PHI_D_BINS, k % GONIO_PHI_D_BINS};
        const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
        w->inside[k] = gonio_bin_is_valid(bin);
        w->pair[SIDES * k] = pair;
        w->pair[SIDES * k + 1] = (gonio_pair){pair.outgoing, pair.incident};
    }
}

/* The mean of the sides that have data. */
static float mean_of(const writer *w, int bin, size_t channel)
{
    const size_t channels = w->sampler->view->channels;
    double sum = 0.0;
    double count = 0.0;
    for (int side = 0; side < SIDES; side++) {
        const double here = w->value[(size_t)(SIDES * bin + side) * channels + channel];
        sum += isnan(here) ? 0.0 : here;
        count += isnan(here) ? 0.0 : 1.0;
    }
    return w->inside[bin] && count > 0.0 ? (float)(sum / count) : NAN;
}

static bool write_channel(const writer *w, size_t channel, int theta_h)
{
    const hsize_t start[GONIO_I_TABLE_RANK] = {channel, (hsize_t)theta_h, 0, 0};
    const hsize_t count[GONIO_I_TABLE_RANK] = {1, 1, GONIO_THETA_D_BINS, GONIO_PHI_D_BINS};
    for (int k = 0; k < BINS; k++) {
        w->slab[k] = mean_of(w, k, channel);
    }
    const hid_t memory = H5Screate_simple(GONIO_I_TABLE_RANK, count, NULL);
    const hid_t place = H5Dget_space(w->rho);
    const bool done = H5Sselect_hyperslab(place, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
                      H5Dwrite(w->rho, H5T_NATIVE_FLOAT, memory, place, H5P_DEFAULT, w->slab) >= 0;
    H5Sclose(memory);
    H5Sclose(place);
    return done;
}

static gonio_status cannot_make(const writer *w)
{
    return gonio_i_fail(w->context, GONIO_ERROR_MEMORY, "HDF5 cannot make the table");
}

/* HDF5 is entered for the writing alone, as the material may come from HDF5 too. */
static gonio_status write_slab(const writer *w, int theta_h)
{
    set_directions(w, theta_h);
    const gonio_status status =
        gonio_i_sampler_values(w->context, w->sampler, w->pair, (size_t)BINS * SIDES, w->value);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_i_hdf_session session;
    bool done = true;
    gonio_i_hdf_enter(&session);
    for (size_t c = 0; c < w->sampler->view->channels && done; c++) {
        done = write_channel(w, c, theta_h);
    }
    gonio_i_hdf_leave(&session);
    return done ? gonio_i_progress(w->context, "writing", 0.98 * (theta_h + 1) / GONIO_THETA_H_BINS)
                : cannot_make(w);
}

/* ---- the file ---- */

static bool write_axes(const writer *w)
{
    double theta_h[GONIO_THETA_H_BINS];
    double theta_d[GONIO_THETA_D_BINS];
    double phi_d[GONIO_PHI_D_BINS];
    for (int k = 0; k < GONIO_PHI_D_BINS; k++) {
        const int other = k % GONIO_THETA_H_BINS;
        const gonio_half_difference centre = gonio_bin_centre((gonio_bin){other, other, k});
        theta_h[other] = centre.theta_h;
        theta_d[other] = centre.theta_d;
        phi_d[k] = centre.phi_d;
    }
    const size_t counts[3] = {GONIO_THETA_H_BINS, GONIO_THETA_D_BINS, GONIO_PHI_D_BINS};
    const gonio_material_view *view = w->sampler->view;
    const hid_t native = H5T_NATIVE_DOUBLE;
    const hid_t stored = H5T_IEEE_F64LE;
    return gonio_i_hdf_write_array(w->file, "theta_h", 1, &counts[0], native, stored, theta_h) &&
           gonio_i_hdf_write_array(w->file, "theta_d", 1, &counts[1], native, stored, theta_d) &&
           gonio_i_hdf_write_array(w->file, "phi_d", 1, &counts[2], native, stored, phi_d) &&
           (view->wavelength == NULL ||
            gonio_i_hdf_write_array(w->file, "wavelength_nm", 1, &view->channels, native, stored,
                                    view->wavelength));
}

static hid_t create_rho(const writer *w)
{
    const hsize_t extents[GONIO_I_TABLE_RANK] = {w->sampler->view->channels, GONIO_THETA_H_BINS,
                                                 GONIO_THETA_D_BINS, GONIO_PHI_D_BINS};
    const hsize_t chunk[GONIO_I_TABLE_RANK] = {1, 1, GONIO_THETA_D_BINS, GONIO_PHI_D_BINS};
    const hid_t space = H5Screate_simple(GONIO_I_TABLE_RANK, extents, NULL);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(properties, false); /* same input, same bytes */
    H5Pset_chunk(properties, GONIO_I_TABLE_RANK, chunk);
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, DEFLATE);
    const hid_t rho =
        H5Dcreate2(w->file, "rho", H5T_IEEE_F32LE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    H5Sclose(space);
    return rho;
}

static bool begin_file(writer *w)
{
    w->file = gonio_i_hdf_create_image();
    const bool described = w->file >= 0 &&
                           gonio_i_hdf_write_string(w->file, "format", GONIO_I_TABLE_FORMAT) &&
                           gonio_i_hdf_write_number(w->file, "version", GONIO_I_TABLE_VERSION) &&
                           gonio_i_hdf_write_string(w->file, "name", w->sampler->view->name) &&
                           gonio_i_hdf_write_string(w->file, "unit", "1/sr") && write_axes(w);
    w->rho = described ? create_rho(w) : -1;
    return w->rho >= 0;
}

static gonio_status write_image(const writer *w, const char *path)
{
    const void *image = NULL;
    size_t size = 0;
    gonio_i_output output;
    if (!gonio_i_hdf_read_image(w->file, &image, &size)) {
        return cannot_make(w);
    }
    gonio_status status = gonio_i_output_open(w->context, path, &output);
    if (status == GONIO_OK) {
        status = gonio_i_output_write(w->context, &output, image, size);
    }
    return gonio_i_output_close(w->context, &output, status);
}

static gonio_status make_file(writer *w, const char *path)
{
    gonio_i_hdf_session session;
    gonio_i_hdf_enter(&session);
    gonio_status status = begin_file(w) ? GONIO_OK : cannot_make(w);
    gonio_i_hdf_leave(&session);
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS && status == GONIO_OK; theta_h++) {
        status = write_slab(w, theta_h);
    }
    gonio_i_hdf_enter(&session);
    if (w->rho >= 0) {
        H5Dclose(w->rho);
    }
    if (status == GONIO_OK) {
        status = write_image(w, path);
    }
    if (w->file >= 0) {
        H5Fclose(w->file);
    }
    gonio_i_hdf_leave(&session);
    return status;
}

static gonio_status write_table(gonio_context *context, const gonio_material *material,
                                const char *path, const gonio_write_options *options)
{
    gonio_i_sampler sampler;
    if (gonio_material_describe(material)->anisotropic && !options->average_azimuths) {
        return gonio_i_anisotropic_write(context, material, path);
    }
    gonio_status status = gonio_i_sampler_begin(context, material, true, &sampler);
    if (status != GONIO_OK) {
        return status;
    }
    writer w = {.context = context, .sampler = &sampler, .file = -1, .rho = -1};
    w.pair = gonio_i_allocate(context, (size_t)BINS * SIDES, sizeof *w.pair);
    w.value =
        gonio_i_allocate(context, (size_t)BINS * SIDES * sampler.view->channels, sizeof *w.value);
    w.slab = gonio_i_allocate(context, BINS, sizeof *w.slab);
    w.inside = gonio_i_allocate(context, BINS, sizeof *w.inside);
    status = w.pair != NULL && w.value != NULL && w.slab != NULL && w.inside != NULL
                 ? make_file(&w, path)
                 : GONIO_ERROR_MEMORY;
    free(w.pair);
    free(w.value);
    free(w.slab);
    free(w.inside);
    gonio_i_sampler_end(&sampler);
    return status == GONIO_OK ? gonio_i_progress(context, "writing", 1.0) : status;
}

const gonio_i_format_writer gonio_i_table_writer = {
    .name = "table",
    .extension = ".h5",
    .summary =
        "table of any channels, HDF5; 90 x 90 x 180, or series of phi_h if anisotropic; reciprocal",
    .averages = true,
    .write = write_table,
};
