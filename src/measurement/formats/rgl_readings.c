/* The samples of an RGL .bsdf as readings: what its goniophotometer measured. */
#include <math.h>
#include <stdlib.h>

#include "../../material/formats/rgl_samples.h"
#include "../../material/tensor_file.h"
#include "../import.h"
#include "format.h"

static const double MEASURED = 80.0; /* degrees; beyond it the values of files are extrapolated */

static gonio_status add_sample(gonio_i_import *in, const gonio_i_rgl *rgl, size_t k, bool measured,
                               double *value)
{
    const gonio_i_rgl_sample sample = gonio_i_rgl_sample_of(rgl, k, value);
    const double angle[4] = {sample.pair.incident.theta, sample.pair.incident.phi,
                             sample.pair.outgoing.theta, sample.pair.outgoing.phi};
    gonio_i_row row = {.planned = GONIO_ALL_CHANNELS, .line = k + 1, .value = value};
    for (int a = 0; a < 4; a++) {
        row.degrees[a] = gonio_i_import_degrees(in, angle[a]);
    }
    const bool beyond =
        row.degrees[0] > MEASURED || (row.degrees[2] > MEASURED && row.degrees[2] < 90.0);
    if (sample.flag != measured || beyond) {
        gonio_i_import_leave_out(in, GONIO_I_EXTRAPOLATED);
        return GONIO_OK;
    }
    return gonio_i_import_add(in, &row);
}

static gonio_status add_samples(gonio_i_import *in, const gonio_i_rgl *rgl)
{
    gonio_status status = gonio_i_import_channels(in, rgl->channels, rgl->wavelength);
    double *value = gonio_i_allocate(in->context, rgl->channels, sizeof *value);
    if (status == GONIO_OK && value == NULL) {
        status = GONIO_ERROR_MEMORY;
    }
    const size_t count = gonio_i_rgl_sample_count(rgl);
    const bool measured = gonio_i_rgl_flag_of_measured(rgl);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = add_sample(in, rgl, k, measured, value);
    }
    free(value);
    return status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    static const gonio_convention stated = {.angles = GONIO_RADIANS, .values = GONIO_VALUE_BRDF};
    gonio_material *material = NULL;
    gonio_i_import in;
    gonio_i_import_begin(&in, file->context, readings, "the samples of an RGL .bsdf", &stated);
    gonio_i_import_leniently(&in);
    gonio_status status = gonio_material_open(file->context, file->path, &material);
    const gonio_i_rgl *rgl = status == GONIO_OK ? gonio_i_rgl_of(material) : NULL;
    if (status == GONIO_OK && rgl == NULL) {
        status = gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                              "%s: a tensor file, but no RGL .bsdf; only of these the samples are "
                              "known",
                              file->path);
    }
    if (status == GONIO_OK && rgl != NULL) {
        status = add_samples(&in, rgl);
    }
    gonio_material_free(&material);
    return gonio_i_import_end(&in, status);
}

static bool recognises(const char *text, size_t size)
{
    return gonio_i_tensor_recognises((const unsigned char *)text, size);
}

const gonio_i_readings_format gonio_i_readings_rgl = {
    .word = "rgl", .name = "samples of RGL files", .recognises = recognises, .read = read};
