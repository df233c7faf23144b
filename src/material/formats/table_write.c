/* Writing tables of any channels in HDF5: table_file.h has the layout. */
#include <math.h>
#include <stdlib.h>

#include <zlib.h>

#include "../../core/hdf_write.h"
#include "../../core/output.h"
#include "../sampler.h"
#include "anisotropic_file.h"
#include "table_file.h"
#include "writers.h"

enum { BINS = GONIO_SLAB_BINS, SIDES = 2, DEFLATE = 4 };

/* Values that are looked up at a time, roughly, and channels that are compressed at a time. */
enum { VALUES = 1 << 20, CHUNKS = 64 };

/* A compressed slab of a channel. */
typedef struct packed {
    unsigned char *shuffled; /* [BINS * sizeof(float)] */
    unsigned char *bytes;    /* [most] */
    uLongf size;
    bool done;
} packed;

typedef struct writer {
    gonio_context *context;
    const gonio_i_sampler *sampler;
    hid_t file;
    hid_t rho;
    int rows;         /* of theta_d, that are looked up at a time */
    gonio_pair *pair; /* [rows][GONIO_PHI_D_BINS][SIDES] */
    double *value;    /* [rows][GONIO_PHI_D_BINS][SIDES][channels] */
    float *slab;      /* [channels][BINS] */
    packed chunk[CHUNKS];
} writer;

/* ---- values ---- */

/* The pairs at the centres of some rows of bins, either side of the reciprocal pair. */
static void set_directions(const writer *w, int theta_h, int first, int rows)
{
    for (int k = 0; k < rows * GONIO_PHI_D_BINS; k++) {
        const gonio_bin bin = {theta_h, first + k / GONIO_PHI_D_BINS, k % GONIO_PHI_D_BINS};
        const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
        w->pair[SIDES * k] = pair;
        w->pair[SIDES * k + 1] = (gonio_pair){pair.outgoing, pair.incident};
    }
}

/* The mean of the sides that have data. */
static float mean_of(const double *value, size_t channels, size_t channel)
{
    double sum = 0.0;
    double count = 0.0;
    for (int side = 0; side < SIDES; side++) {
        const double here = value[(size_t)side * channels + channel];
        sum += isnan(here) ? 0.0 : here;
        count += isnan(here) ? 0.0 : 1.0;
    }
    return count > 0.0 ? (float)(sum / count) : NAN;
}

static void fill_bin(const writer *w, gonio_bin bin, const double *value)
{
    const size_t channels = w->sampler->view->channels;
    const bool inside = gonio_bin_is_valid(bin);
    float *slab = w->slab + (size_t)bin.theta_d * GONIO_PHI_D_BINS + bin.phi_d;
    for (size_t c = 0; c < channels; c++) {
        slab[c * BINS] = inside ? mean_of(value, channels, c) : NAN;
    }
}

static gonio_status fill_rows(const writer *w, int theta_h, int first, int rows)
{
    const size_t bins = (size_t)rows * GONIO_PHI_D_BINS;
    const size_t each = SIDES * w->sampler->view->channels;
    set_directions(w, theta_h, first, rows);
    const gonio_status status =
        gonio_i_sampler_values(w->context, w->sampler, w->pair, bins * SIDES, w->value);
    for (size_t k = 0; k < bins && status == GONIO_OK; k++) {
        const gonio_bin bin = {theta_h, first + (int)(k / GONIO_PHI_D_BINS),
                               (int)(k % GONIO_PHI_D_BINS)};
        fill_bin(w, bin, w->value + k * each);
    }
    return status;
}

/* ---- chunks ---- */

/* What HDF5's filters do, which are of one thread: bytes of the same place in the numbers together,
 * then deflate. */
static void compress_chunk(const float *slab, packed *c)
{
    const unsigned char *from = (const unsigned char *)slab;
    for (size_t byte = 0; byte < sizeof *slab; byte++) {
        for (size_t k = 0; k < BINS; k++) {
            c->shuffled[byte * BINS + k] = from[k * sizeof *slab + byte];
        }
    }
    c->size = compressBound(BINS * sizeof *slab);
    c->done = compress2(c->bytes, &c->size, c->shuffled, BINS * sizeof *slab, DEFLATE) == Z_OK;
}

/* HDF5 is entered for the writing alone, as the material may come from HDF5 too. */
static bool write_chunks(const writer *w, size_t first, size_t count, int theta_h)
{
    gonio_i_hdf_session session;
    bool done = true;
    gonio_i_hdf_enter(&session);
    for (size_t k = 0; k < count && done; k++) {
        const hsize_t at[GONIO_I_TABLE_RANK] = {first + k, (hsize_t)theta_h, 0, 0};
        done = w->chunk[k].done &&
               H5Dwrite_chunk(w->rho, H5P_DEFAULT, 0, at, w->chunk[k].size, w->chunk[k].bytes) >= 0;
    }
    gonio_i_hdf_leave(&session);
    return done;
}

static bool write_channels(writer *w, int theta_h)
{
    const size_t channels = w->sampler->view->channels;
    bool done = true;
    for (size_t first = 0; first < channels && done; first += CHUNKS) {
        const size_t count = channels - first < CHUNKS ? channels - first : CHUNKS;
#pragma omp parallel for schedule(dynamic, 1) num_threads(gonio_context_threads(w->context))
        for (size_t k = 0; k < count; k++) {
            compress_chunk(w->slab + (first + k) * BINS, &w->chunk[k]);
        }
        done = write_chunks(w, first, count, theta_h);
    }
    return done;
}

static gonio_status cannot_make(const writer *w)
{
    return gonio_i_fail(w->context, GONIO_ERROR_MEMORY, "HDF5 cannot make the table");
}

static gonio_status write_slab(writer *w, int theta_h)
{
    gonio_status status = GONIO_OK;
    for (int first = 0; first < GONIO_THETA_D_BINS && status == GONIO_OK; first += w->rows) {
        const int left = GONIO_THETA_D_BINS - first;
        status = fill_rows(w, theta_h, first, left < w->rows ? left : w->rows);
    }
    if (status == GONIO_OK && !write_channels(w, theta_h)) {
        status = cannot_make(w);
    }
    return status == GONIO_OK
               ? gonio_i_progress(w->context, "writing", 0.98 * (theta_h + 1) / GONIO_THETA_H_BINS)
               : status;
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
    gonio_status status = gonio_i_hdf_load(w->context);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_i_hdf_enter(&session);
    status = begin_file(w) ? GONIO_OK : cannot_make(w);
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

static bool begin_writer(writer *w)
{
    const size_t channels = w->sampler->view->channels;
    const size_t row = (size_t)GONIO_PHI_D_BINS * SIDES;
    const size_t size = BINS * sizeof(float);
    const size_t rows = VALUES / (row * channels);
    w->rows = rows < 1 ? 1 : rows > GONIO_THETA_D_BINS ? GONIO_THETA_D_BINS : (int)rows;
    w->pair = gonio_i_allocate(w->context, (size_t)w->rows * row, sizeof *w->pair);
    w->value = gonio_i_allocate(w->context, (size_t)w->rows * row * channels, sizeof *w->value);
    w->slab = gonio_i_allocate(w->context, channels * BINS, sizeof *w->slab);
    bool done = w->pair != NULL && w->value != NULL && w->slab != NULL;
    for (size_t k = 0; k < CHUNKS && k < channels && done; k++) {
        w->chunk[k].shuffled = gonio_i_allocate(w->context, size, 1);
        w->chunk[k].bytes = gonio_i_allocate(w->context, compressBound(size), 1);
        done = w->chunk[k].shuffled != NULL && w->chunk[k].bytes != NULL;
    }
    return done;
}

static void end_writer(writer *w)
{
    free(w->pair);
    free(w->value);
    free(w->slab);
    for (size_t k = 0; k < CHUNKS; k++) {
        free(w->chunk[k].shuffled);
        free(w->chunk[k].bytes);
    }
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
    status = begin_writer(&w) ? make_file(&w, path) : GONIO_ERROR_MEMORY;
    end_writer(&w);
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
