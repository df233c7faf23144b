/* KAIST .pbsdf files: polarised BRDFs of isotropic materials (Baek et al. 2020, "Image-Based
 * Acquisition and Modeling of Polarimetric Reflectance"), of which the unpolarised part is read.
 *
 * A tensor file (tensor_file.h) with M[phi_d][theta_d][theta_h][wavelength][4][4], Mueller matrices
 * whose first element is the BRDF of unpolarised light, without a cosine. phi_d goes from -180 to
 * 180 degrees and both theta from 0 to 90, both ends included, evenly; light is the direction that
 * phi_d is of. 0 and NaN: not measured. Between nodes values are linear; nodes without data are
 * left out and the weights of the others scaled up. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/core.h"
#include "../tensor_file.h"
#include "../warp.h"
#include "format.h"

enum { DIMENSIONS = 6, MUELLER = 16, MOST_WAVELENGTHS = 4096 };

typedef struct kaist {
    size_t phi_d; /* nodes, at least 2 each */
    size_t theta_d;
    size_t theta_h;
    size_t channels;
    double *wavelength; /* [channels], nm, as in the file */
    float *value;       /* [phi_d][theta_d][theta_h][channels]; NaN for no data */
} kaist;

static void release(void *self)
{
    kaist *k = self;
    free(k->wavelength);
    free(k->value);
    free(k);
}

/* ---- evaluation ---- */

/* As gonio_half_difference_from_pair, with phi_d over the full circle, scaled to 0 .. 1. */
static double place_of_phi_d(gonio_pair pair, double theta_h)
{
    const double x = sin(pair.incident.theta) * cos(pair.incident.phi);
    const double y = sin(pair.incident.theta) * sin(pair.incident.phi);
    const double sum_x = x + sin(pair.outgoing.theta) * cos(pair.outgoing.phi);
    const double sum_y = y + sin(pair.outgoing.theta) * sin(pair.outgoing.phi);
    const double phi_h = theta_h > 0.0 ? atan2(sum_y, sum_x) : 0.0;
    const double along = cos(phi_h) * x + sin(phi_h) * y;
    const double d_x = cos(theta_h) * along - sin(theta_h) * cos(pair.incident.theta);
    const double d_y = cos(phi_h) * y - sin(phi_h) * x;
    return (atan2(d_y, d_x) + M_PI) / (2.0 * M_PI);
}

static void evaluate_pair(const kaist *k, gonio_pair pair, double *values)
{
    const gonio_half_difference at = gonio_half_difference_from_pair(pair);
    const gonio_i_step step[3] = {gonio_i_step_evenly(k->phi_d, place_of_phi_d(pair, at.theta_h)),
                                  gonio_i_step_evenly(k->theta_d, at.theta_d / (M_PI / 2.0)),
                                  gonio_i_step_evenly(k->theta_h, at.theta_h / (M_PI / 2.0))};
    for (size_t c = 0; c < k->channels; c++) {
        double sum = 0.0;
        double total = 0.0;
        for (size_t corner = 0; corner < 8; corner++) {
            size_t node = 0;
            double weight = 1.0;
            const size_t nodes[3] = {k->phi_d, k->theta_d, k->theta_h};
            for (size_t a = 0; a < 3; a++) {
                const size_t next = corner >> a & 1;
                node = node * nodes[a] + step[a].before + next;
                weight *= next ? step[a].share : 1.0 - step[a].share;
            }
            const double here = (double)k->value[node * k->channels + c];
            sum += isnan(here) ? 0.0 : weight * here;
            total += isnan(here) ? 0.0 : weight;
        }
        values[c] = total > 0.0 ? sum / total : NAN;
    }
}

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    const kaist *k = self;
    (void)context;
    for (size_t n = 0; n < count; n++) {
        evaluate_pair(k, pairs[n], values + n * k->channels);
    }
    return GONIO_OK;
}

/* ---- reading ---- */

static gonio_status read_wavelengths(gonio_context *context, const gonio_i_tensor_file *file,
                                     kaist *k)
{
    const gonio_i_tensor *field = NULL;
    gonio_status status =
        gonio_i_tensor_expect(context, file, "wvls", GONIO_I_TENSOR_U16, 1, &field);
    if (status != GONIO_OK) {
        return status;
    }
    if (field->count != k->channels) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: the field 'wvls' has %llu wavelengths, 'M' %zu", file->path,
                            (unsigned long long)field->count, k->channels);
    }
    uint16_t read[MOST_WAVELENGTHS];
    k->wavelength = gonio_i_allocate(context, k->channels, sizeof *k->wavelength);
    status = k->wavelength == NULL
                 ? GONIO_ERROR_MEMORY
                 : gonio_i_tensor_read(context, file, field, 0, k->channels, read);
    for (size_t c = 0; c < k->channels && status == GONIO_OK; c++) {
        k->wavelength[c] = read[c];
    }
    return status;
}

/* The first elements of the matrices of one phi_d and theta_d. */
static gonio_status read_row(gonio_context *context, const gonio_i_tensor_file *file,
                             const gonio_i_tensor *field, size_t row, size_t count, float *matrices,
                             float *values)
{
    const gonio_status status = gonio_i_tensor_read(
        context, file, field, (uint64_t)row * count * MUELLER, count * MUELLER, matrices);
    for (size_t n = 0; n < count && status == GONIO_OK; n++) {
        const float first = matrices[n * MUELLER];
        values[row * count + n] = first > 0.0F && isfinite(first) ? first : NAN;
    }
    return status;
}

static gonio_status read_values(gonio_context *context, const gonio_i_tensor_file *file,
                                const gonio_i_tensor *field, kaist *k)
{
    const size_t count = k->theta_h * k->channels;
    float *matrices = gonio_i_allocate(context, count * MUELLER, sizeof *matrices);
    k->value = gonio_i_allocate(context, k->phi_d * k->theta_d * count, sizeof *k->value);
    gonio_status status = matrices != NULL && k->value != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t row = 0; row < k->phi_d * k->theta_d && status == GONIO_OK; row++) {
        status = read_row(context, file, field, row, count, matrices, k->value);
    }
    free(matrices);
    return status;
}

static gonio_status read_kaist(gonio_context *context, const gonio_i_tensor_file *file, kaist *k)
{
    const gonio_i_tensor *field = NULL;
    gonio_status status =
        gonio_i_tensor_expect(context, file, "M", GONIO_I_TENSOR_F32, DIMENSIONS, &field);
    if (status != GONIO_OK) {
        return status;
    }
    const uint64_t *shape = field->shape;
    if (shape[0] < 2 || shape[1] < 2 || shape[2] < 2 || shape[3] > MOST_WAVELENGTHS ||
        shape[4] != 4 || shape[5] != 4) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: the field 'M' is not phi_d x theta_d x theta_h x wavelengths x 4 "
                            "x 4 with two or more of each angle",
                            file->path);
    }
    k->phi_d = shape[0];
    k->theta_d = shape[1];
    k->theta_h = shape[2];
    k->channels = shape[3];
    status = read_wavelengths(context, file, k);
    return status == GONIO_OK ? read_values(context, file, field, k) : status;
}

static gonio_status open_kaist(gonio_context *context, const gonio_i_file *file,
                               gonio_material_source *source, char **description)
{
    gonio_i_tensor_file tensors;
    gonio_status status = gonio_i_tensor_open(context, file->path, &tensors);
    if (status != GONIO_OK) {
        return status;
    }
    kaist *k = gonio_i_allocate(context, 1, sizeof *k);
    status = k != NULL ? read_kaist(context, &tensors, k) : GONIO_ERROR_MEMORY;
    gonio_i_tensor_close(&tensors);
    if (status == GONIO_OK) {
        *description = gonio_i_format("KAIST polarised BRDF %zu x %zu x %zu, %zu wavelengths, its "
                                      "unpolarised part",
                                      k->theta_h, k->theta_d, k->phi_d, k->channels);
    }
    if (status != GONIO_OK) {
        if (k != NULL) {
            release(k);
        }
        return status;
    }
    *source = (gonio_material_source){.evaluate = evaluate,
                                      .release = release,
                                      .self = k,
                                      .channels = k->channels,
                                      .wavelength = k->wavelength};
    return GONIO_OK;
}

static bool recognises(const gonio_i_file *file)
{
    return gonio_i_tensor_recognises((const unsigned char *)file->head, file->head_size) &&
           memmem(file->head, file->head_size, "wvls", 4) != NULL &&
           memmem(file->head, file->head_size, "vndf", 4) == NULL;
}

const gonio_i_format_reader gonio_i_kaist_reader = {
    .name = "KAIST .pbsdf", .recognises = recognises, .open = open_kaist};
