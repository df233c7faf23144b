/* MERL .binary tables: int32 theta_h, theta_d, phi_d bins, then three planes (R, G, B) of float64,
 * phi_d fastest; reflectance = stored x (1, 1.15, 1.66)/1500 1/sr; -1 for no data. All
 * little-endian. */
#include "merl.h"
#include "merl_halves.h"

#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "format.h"

const double gonio_i_merl_scale[GONIO_CHANNELS] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

enum {
    HEADER = 12,
    FULL_CIRCLE = GONIO_I_MERL_FULL_CIRCLE,
    PLANE = GONIO_SLAB_BINS * sizeof(double), /* bytes of one channel of a slab */
    BLOCK = 5                                 /* slabs that are written in a row; divides 90 */
};

typedef struct merl_table {
    int descriptor;
    int phi_bins; /* 180, or 360: phi_d to 2 pi, folded on reading */
    char *path;
    bool negative_noted; /* that negative numbers became 0; of all threads */
} merl_table;

static int32_t header_entry(const gonio_i_file *file, int k)
{
    uint32_t entry = 0;
    memcpy(&entry, file->head + 4 * k, sizeof entry);
    return (int32_t)le32toh(entry);
}

/* 12 + 24 n bytes for n bins; 0 if a dimension is not positive or the product overflows. */
static uint64_t table_size(const gonio_i_file *file)
{
    uint64_t bins = 1;
    for (int k = 0; k < 3; k++) {
        const int32_t entry = header_entry(file, k);
        if (entry <= 0 || __builtin_mul_overflow(bins, (uint64_t)entry, &bins)) {
            return 0;
        }
    }
    uint64_t size = 0;
    return __builtin_mul_overflow(bins, UINT64_C(24), &size) ? 0 : size + HEADER;
}

static bool recognises(const gonio_i_file *file)
{
    if (file->head_size < HEADER) {
        return false;
    }
    return (header_entry(file, 0) == GONIO_THETA_H_BINS &&
            header_entry(file, 1) == GONIO_THETA_D_BINS) ||
           table_size(file) == file->size;
}

static void byte_order_to_host(double *values, size_t count)
{
#if __BYTE_ORDER == __BIG_ENDIAN
    for (size_t k = 0; k < count; k++) {
        uint64_t bits;
        memcpy(&bits, values + k, sizeof bits);
        bits = le64toh(bits);
        memcpy(values + k, &bits, sizeof bits);
    }
#else
    (void)values;
    (void)count;
#endif
}

static gonio_status read_exactly(gonio_context *context, const merl_table *table, void *to,
                                 size_t size, off_t offset)
{
    char *next = to;
    while (size > 0) {
        const ssize_t got = pread(table->descriptor, next, size, offset);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got < 0) {
            return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", table->path,
                                strerror(errno));
        }
        if (got == 0) {
            return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                                "%s: ends early: the file became shorter while it was read",
                                table->path);
        }
        next += got;
        offset += got;
        size -= (size_t)got;
    }
    return GONIO_OK;
}

/* The offset of a slab's plane of a channel in a file of 180 bins. */
static off_t plane_offset(int channel, int theta_h)
{
    return (off_t)(HEADER + PLANE * (size_t)(GONIO_THETA_H_BINS * channel + theta_h));
}

/* Stored numbers to 1/sr; a bin that lacks any channel lacks all. Numbers between -1 and 0 beside
 * data are what dark subtraction leaves of a dark channel: 0. Returns how many bins have such. */
GONIO_I_VECTORISED static size_t to_reflectance(double *rho)
{
    size_t negative = 0;
    double *r = rho;
    double *g = rho + GONIO_SLAB_BINS;
    double *b = rho + 2 * (size_t)GONIO_SLAB_BINS;
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        /* False for -1 and NaN; infinity fails the second half. */
        const bool whole =
            (r[k] > -1.0) & (g[k] > -1.0) & (b[k] > -1.0) & (r[k] + g[k] + b[k] < INFINITY);
        const bool data = whole & ((r[k] >= 0.0) | (g[k] >= 0.0) | (b[k] >= 0.0));
        negative += data & ((r[k] < 0.0) | (g[k] < 0.0) | (b[k] < 0.0));
        r[k] = data ? (r[k] < 0.0 ? 0.0 : r[k]) * gonio_i_merl_scale[0] : -1.0;
        g[k] = data ? (g[k] < 0.0 ? 0.0 : g[k]) * gonio_i_merl_scale[1] : -1.0;
        b[k] = data ? (b[k] < 0.0 ? 0.0 : b[k]) * gonio_i_merl_scale[2] : -1.0;
    }
    return negative;
}

/* Notes negative numbers, once a material. */
static void note_negative(gonio_context *context, merl_table *table)
{
    bool before;
#pragma omp atomic capture
    {
        before = table->negative_noted;
        table->negative_noted = true;
    }
    if (!before) {
        gonio_i_note(context,
                     "%s: bins with data hold slightly negative numbers in a channel; 0 is taken",
                     table->path);
    }
}

static gonio_status read_full_plane(gonio_context *context, const merl_table *table, int channel,
                                    int theta_h, double *full)
{
    const size_t bins = (size_t)GONIO_THETA_D_BINS * FULL_CIRCLE;
    const size_t first = bins * (size_t)(GONIO_THETA_H_BINS * channel + theta_h);
    const gonio_status status =
        read_exactly(context, table, full, 8 * bins, (off_t)(HEADER + 8 * first));
    byte_order_to_host(full, bins);
    return status;
}

static gonio_status read_plane(gonio_context *context, const merl_table *table, int channel,
                               int theta_h, double *plane)
{
    if (table->phi_bins == GONIO_PHI_D_BINS) {
        const gonio_status status =
            read_exactly(context, table, plane, PLANE, plane_offset(channel, theta_h));
        byte_order_to_host(plane, GONIO_SLAB_BINS);
        return status;
    }
    double *full = gonio_i_allocate(context, (size_t)2 * GONIO_SLAB_BINS, sizeof *full);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (full != NULL) {
        status = read_full_plane(context, table, channel, theta_h, full);
        gonio_i_merl_fold(full, plane);
    }
    free(full);
    return status;
}

static gonio_status read_slab(void *self, gonio_context *context, int theta_h, double *rho)
{
    merl_table *table = self;
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        const gonio_status status =
            read_plane(context, table, channel, theta_h, rho + (size_t)channel * GONIO_SLAB_BINS);
        if (status != GONIO_OK) {
            return status;
        }
    }
    if (to_reflectance(rho) > 0) {
        note_negative(context, table);
    }
    return GONIO_OK;
}

static void release(void *self)
{
    merl_table *table = self;
    close(table->descriptor);
    free(table->path);
    free(table);
}

static gonio_status check_shape(gonio_context *context, const gonio_i_file *file)
{
    const int32_t bins[3] = {header_entry(file, 0), header_entry(file, 1), header_entry(file, 2)};
    if (bins[0] != GONIO_THETA_H_BINS || bins[1] != GONIO_THETA_D_BINS ||
        (bins[2] != GONIO_PHI_D_BINS && bins[2] != FULL_CIRCLE)) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: header says %d x %d x %d bins; gonio reads MERL tables of "
                            "90 x 90 x 180 or 90 x 90 x 360",
                            file->path, bins[0], bins[1], bins[2]);
    }
    const uint64_t size = table_size(file);
    if (file->size != size) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: %s: %llu bytes where a MERL table of 90 x 90 x %d bins has %llu; "
                            "copy it again from its source",
                            file->path, file->size < size ? "truncated" : "too long",
                            (unsigned long long)file->size, bins[2], (unsigned long long)size);
    }
    return GONIO_OK;
}

/* The limit of the RMS difference as a fraction of the RMS. Noise and rounding are below it. */
static const double much = 0.1;

/* Compares the halves of a table of 360 bins, and warns if they differ much. */
static gonio_status compare_halves(gonio_context *context, const merl_table *table,
                                   double *difference)
{
    gonio_i_merl_halves halves = {0};
    gonio_status status = GONIO_OK;
    double *full = gonio_i_allocate(context, (size_t)2 * GONIO_SLAB_BINS, sizeof *full);
    if (full == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (int k = 0; k < GONIO_CHANNELS * GONIO_THETA_H_BINS && status == GONIO_OK; k++) {
        const int channel = k / GONIO_THETA_H_BINS;
        status = read_full_plane(context, table, channel, k % GONIO_THETA_H_BINS, full);
        gonio_i_merl_compare_halves(full, gonio_i_merl_scale[channel], &halves);
    }
    free(full);
    *difference = gonio_i_merl_difference(&halves);
    if (status == GONIO_OK && *difference > much) {
        gonio_i_warn(context,
                     "%s: phi_d and phi_d + 180 degrees, which are one sample turned around, "
                     "differ by %.0f %% (RMS): an anisotropic sample, or light and detector that "
                     "are not adjusted? The mean is taken",
                     table->path, 100.0 * *difference);
    }
    return status;
}

static gonio_status open_table(gonio_context *context, const gonio_i_file *file,
                               gonio_material_source *source, char **description)
{
    gonio_status status = check_shape(context, file);
    if (status != GONIO_OK) {
        return status;
    }
    merl_table *table = gonio_i_allocate(context, 1, sizeof *table);
    if (table == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    table->phi_bins = header_entry(file, 2);
    table->path = strdup(file->path);
    table->descriptor = open(file->path, O_RDONLY | O_CLOEXEC);
    if (table->path == NULL || table->descriptor < 0) {
        status = gonio_i_fail(context, table->descriptor < 0 ? GONIO_ERROR_IO : GONIO_ERROR_MEMORY,
                              "%s: cannot open: %s", file->path, strerror(errno));
        release(table);
        return status;
    }
    double difference = 0.0;
    const bool both = table->phi_bins == FULL_CIRCLE;
    status = both ? compare_halves(context, table, &difference) : GONIO_OK;
    if (status != GONIO_OK) {
        release(table);
        return status;
    }
    *description = gonio_i_format("MERL table 90 x 90 x %d", table->phi_bins);
    *source = (gonio_material_source){.read_slab = read_slab,
                                      .release = release,
                                      .self = table,
                                      .both_halves = both,
                                      .halves_difference = difference};
    return GONIO_OK;
}

const gonio_i_format_reader gonio_i_merl_reader = {
    .name = "MERL .binary table", .recognises = recognises, .open = open_table};

GONIO_I_VECTORISED static void to_stored(double *values, int channel)
{
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        const double stored =
            values[k] / gonio_i_merl_scale[channel]; /* outside of the choice: vectorises */
        values[k] = values[k] >= 0.0 ? stored : -1.0;
    }
    byte_order_to_host(values, GONIO_SLAB_BINS);
}

typedef struct writer {
    gonio_context *context;
    const gonio_material *material;
    gonio_i_output *output;
    gonio_i_tables_progress *progress;
    gonio_status status; /* of the first thread that failed */
} writer;

static gonio_status report_slab(const writer *w)
{
    size_t done;
#pragma omp atomic capture
    done = ++w->progress->slabs;
    const size_t all = w->progress->tables * GONIO_THETA_H_BINS;
    return gonio_i_progress(w->context, w->progress->task, 0.999 * (double)done / (double)all);
}

static gonio_status write_slab(const writer *w, int theta_h, double *rho)
{
    gonio_status status = gonio_material_read_slab(w->context, w->material, theta_h, rho);
    for (int channel = 0; channel < GONIO_CHANNELS && status == GONIO_OK; channel++) {
        double *plane = rho + (size_t)channel * GONIO_SLAB_BINS;
        to_stored(plane, channel);
        status = gonio_i_output_write_at(w->context, w->output, plane, PLANE,
                                         plane_offset(channel, theta_h));
    }
    return status == GONIO_OK ? report_slab(w) : status;
}

/* Writes some slabs, and starts their transfer to the disk while the next ones are computed. */
static gonio_status write_block(const writer *w, int first, double *rho)
{
    gonio_status status = GONIO_OK;
    for (int k = 0; k < BLOCK && status == GONIO_OK; k++) {
        status = write_slab(w, first + k, rho);
    }
    for (int channel = 0; channel < GONIO_CHANNELS && status == GONIO_OK; channel++) {
        gonio_i_output_start_flush(w->output, plane_offset(channel, first), BLOCK * PLANE);
    }
    return status;
}

static void write_blocks(writer *w, int threads)
{
#pragma omp parallel num_threads(threads)
    {
        double *rho = gonio_i_allocate(w->context, GONIO_SLAB_VALUES, sizeof *rho);
        gonio_status mine = rho != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
#pragma omp for schedule(dynamic)
        for (int first = 0; first < GONIO_THETA_H_BINS; first += BLOCK) {
            gonio_status seen;
#pragma omp atomic read
            seen = w->status;
            if (mine == GONIO_OK && seen == GONIO_OK) {
                mine = write_block(w, first, rho);
            }
            if (mine != GONIO_OK) {
#pragma omp atomic write
                w->status = mine;
            }
        }
        free(rho);
    }
}

static gonio_status write_header(gonio_context *context, gonio_i_output *output)
{
    const uint32_t header[3] = {htole32(GONIO_THETA_H_BINS), htole32(GONIO_THETA_D_BINS),
                                htole32(GONIO_PHI_D_BINS)};
    return gonio_i_output_write(context, output, header, sizeof header);
}

gonio_status gonio_i_merl_write(gonio_context *context, const gonio_material *material,
                                const char *path, int threads, gonio_i_tables_progress *progress,
                                gonio_i_output *output)
{
    gonio_status status = gonio_i_output_open(context, path, output);
    if (status == GONIO_OK) {
        status = gonio_i_output_reserve(context, output, plane_offset(GONIO_CHANNELS, 0));
    }
    if (status == GONIO_OK) {
        status = write_header(context, output);
    }
    if (status == GONIO_OK) {
        gonio_context *shared = gonio_i_shared_context_begin(context);
        writer w = {shared, material, output, progress, GONIO_OK};
        write_blocks(&w, threads);
        gonio_i_shared_context_end(shared, context);
        status = w.status;
    }
    return status == GONIO_OK ? gonio_i_output_flush(context, output) : status;
}

gonio_status gonio_material_write_merl(gonio_context *context, const gonio_material *material,
                                       const char *path)
{
    gonio_i_tables_progress progress = {"writing", 0, 1};
    gonio_i_output output;
    gonio_status status = gonio_i_merl_write(context, material, path,
                                             gonio_context_threads(context), &progress, &output);
    if (status == GONIO_OK) {
        status = gonio_i_progress(context, progress.task, 1.0);
    }
    return gonio_i_output_close(context, &output, status);
}
