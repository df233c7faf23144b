/* UTIA .bin files: anisotropic BRDFs (Filip and Vavra 2014, "Template-Based Sampling of Anisotropic
 * BRDFs").
 *
 * No header: little-endian float64 in three planes R, G, B of
 * [theta_i 6][phi_i 48][theta_v 6][phi_v 48], in steps of 15 and 7.5 degrees, so that measured
 * polar angles end at 75 degrees. Linear between them. Negative values are noise in the dark, taken
 * as 0.
 *
 * Files of the database hold 140 times the BRDF. Such values would reflect far more light than
 * arrives. This distinguishes them from files that hold the BRDF itself. */
#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../core/core.h"
#include "../warp.h"
#include "format.h"

enum {
    THETAS = 6,
    PHIS = 48,
    DIRECTIONS = THETAS * PHIS,
    PLANE = DIRECTIONS * DIRECTIONS,
    VALUES = GONIO_CHANNELS * PLANE,
    BYTES = VALUES * (int)sizeof(double)
};

static const double THETA_STEP = 15.0 * M_PI / 180.0;
static const double PHI_STEP = 7.5 * M_PI / 180.0;
static const double UNIT = 140.0; /* of the database's files */
static const double LARGEST = 1e9;

typedef struct utia {
    double value[GONIO_CHANNELS][DIRECTIONS][DIRECTIONS]; /* [channel][incident][outgoing] */
} utia;

/* ---- evaluation ---- */

/* The four measured directions around one, and their weights. */
typedef struct around {
    size_t direction[4];
    double weight[4];
} around;

static around find_around(gonio_angles at)
{
    const gonio_i_step t = gonio_i_step_evenly(THETAS, at.theta / ((THETAS - 1) * THETA_STEP));
    const double revolutions = at.phi / (2.0 * M_PI);
    const double place = (revolutions - floor(revolutions)) * PHIS;
    const size_t before = (size_t)place % PHIS;
    const double share = place - floor(place);
    around a;
    for (size_t k = 0; k < 4; k++) {
        const size_t p = (before + k % 2) % PHIS;
        a.direction[k] = (t.before + k / 2) * PHIS + p;
        a.weight[k] = (k / 2 ? t.share : 1.0 - t.share) * (k % 2 ? share : 1.0 - share);
    }
    return a;
}

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    const utia *u = self;
    (void)context;
    for (size_t n = 0; n < count; n++) {
        const around in = find_around(pairs[n].incident);
        const around out = find_around(pairs[n].outgoing);
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            double sum = 0.0;
            for (size_t k = 0; k < 16; k++) {
                sum += in.weight[k / 4] * out.weight[k % 4] *
                       u->value[c][in.direction[k / 4]][out.direction[k % 4]];
            }
            values[n * GONIO_CHANNELS + c] = sum;
        }
    }
    return GONIO_OK;
}

/* ---- reading ---- */

static gonio_status read_bytes(gonio_context *context, const char *path, void *to)
{
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    char *next = to;
    size_t left = BYTES;
    while (descriptor >= 0 && left > 0) {
        const ssize_t got = read(descriptor, next, left);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            break;
        }
        next += got;
        left -= (size_t)got;
    }
    const gonio_status status =
        left == 0 ? GONIO_OK
                  : gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path,
                                 errno != 0 ? strerror(errno) : "the file became shorter");
    if (descriptor >= 0) {
        close(descriptor);
    }
    return status;
}

static double from_file(double value)
{
    uint64_t bits = 0;
    memcpy(&bits, &value, sizeof bits);
    bits = le64toh(bits);
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* The largest albedo up to 75 degrees, as a mean over azimuths of incidence. */
static double find_albedo(const utia *u)
{
    double most = 0.0;
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        for (size_t t = 0; t < THETAS; t++) {
            double sum = 0.0;
            for (size_t in = t * PHIS; in < (t + 1) * PHIS; in++) {
                for (size_t out = 0; out < DIRECTIONS; out++) {
                    const size_t polar = out / PHIS;
                    const double theta = (double)polar * THETA_STEP;
                    sum += u->value[c][in][out] * cos(theta) * sin(theta);
                }
            }
            most = fmax(most, sum / PHIS * THETA_STEP * PHI_STEP);
        }
    }
    return most;
}

static gonio_status check_values(gonio_context *context, const char *path, utia *u)
{
    double *value = u->value[0][0];
    for (size_t k = 0; k < VALUES; k++) {
        value[k] = from_file(value[k]);
        if (!(fabs(value[k]) <= LARGEST)) {
            return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                                "%s: value %zu is not finite, or too large for a BRDF", path, k);
        }
        value[k] = fmax(value[k], 0.0);
    }
    return GONIO_OK;
}

/* Whether the values were 140 times the BRDF; then they are divided. */
static bool scale_values(utia *u)
{
    double *value = u->value[0][0];
    if (find_albedo(u) <= 1.2) {
        return false;
    }
    for (size_t k = 0; k < VALUES; k++) {
        value[k] /= UNIT;
    }
    return true;
}

static gonio_status open_utia(gonio_context *context, const gonio_i_file *file,
                              gonio_material_source *source, char **description)
{
    utia *u = gonio_i_allocate(context, 1, sizeof *u);
    gonio_status status = u != NULL ? read_bytes(context, file->path, u) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = check_values(context, file->path, u);
    }
    if (status == GONIO_OK) {
        const bool scaled = scale_values(u);
        *description = gonio_i_format("UTIA anisotropic BRDF, %d x %d directions%s", DIRECTIONS,
                                      DIRECTIONS, scaled ? ", values divided by 140" : "");
    }
    if (status != GONIO_OK) {
        free(u);
        return status;
    }
    *source = (gonio_material_source){.evaluate = evaluate,
                                      .release = free,
                                      .self = u,
                                      .channels = GONIO_CHANNELS,
                                      .anisotropic = true,
                                      .theta_limit = (THETAS - 1) * THETA_STEP};
    return GONIO_OK;
}

/* By the size, and numbers at the beginning that can be values. */
static bool recognises(const gonio_i_file *file)
{
    if (file->size != BYTES) {
        return false;
    }
    for (size_t k = 0; k + sizeof(double) <= file->head_size; k += sizeof(double)) {
        double value = 0.0;
        memcpy(&value, file->head + k, sizeof value);
        value = from_file(value);
        if (!(fabs(value) <= LARGEST) || (value != 0.0 && fabs(value) < 1e-100)) {
            return false;
        }
    }
    return true;
}

const gonio_i_format_reader gonio_i_utia_reader = {
    .name = "UTIA .bin", .recognises = recognises, .open = open_utia};
