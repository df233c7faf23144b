/* UTIA .bin files: anisotropic BRDFs (Filip and Vavra 2014, "Template-Based Sampling of Anisotropic
 * BRDFs").
 *
 * No header: little-endian float64 in three planes R, G, B of
 * [theta_i 6][phi_i 48][theta_v 6][phi_v 48], in steps of 15 and 7.5 degrees, so that measured
 * polar angles end at 75 degrees. Linear between them. Negative values are noise in the dark, taken
 * as 0.
 *
 * The same layout in other steps is known by its size: theta in steps that divide 90 degrees, phi
 * in the same steps or in half of them. No two of these have the same size.
 *
 * Files of the database hold 140 times the BRDF. Such values would reflect far more light than
 * arrives. This distinguishes them from files that hold the BRDF itself. */
#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../core/core.h"
#include "../warp.h"
#include "format.h"

static const double DEGREE = M_PI / 180.0;
static const double UNIT = 140.0; /* of the database's files */
static const double LARGEST = 1e9;

/* Steps of theta, degrees. */
static const double steps[] = {15.0, 30.0, 22.5, 18.0, 10.0, 9.0, 7.5, 6.0, 5.0};

enum { STEPS = sizeof steps / sizeof *steps };

typedef struct utia {
    size_t thetas;     /* 0, step, ... below 90 degrees */
    size_t phis;       /* of a turn */
    size_t directions; /* thetas * phis */
    double theta_step;
    double phi_step;
    double *value; /* [channel][incident][outgoing] */
} utia;

static size_t values_of(const utia *u)
{
    return GONIO_CHANNELS * u->directions * u->directions;
}

static size_t bytes_of(const utia *u)
{
    return values_of(u) * sizeof *u->value;
}

/* The layout number k, that of the database first; phi in half the steps, then in the same. */
static utia layout_of(size_t k)
{
    const double theta = steps[k / 2];
    const double phi = k % 2 == 0 ? theta / 2.0 : theta;
    utia u = {.thetas = (size_t)lround(90.0 / theta),
              .phis = (size_t)lround(360.0 / phi),
              .theta_step = theta * DEGREE,
              .phi_step = phi * DEGREE};
    u.directions = u.thetas * u.phis;
    return u;
}

/* The layout of a file's size. False if there is none. */
static bool find_layout(uint64_t size, utia *u)
{
    for (size_t k = 0; k < 2 * STEPS; k++) {
        *u = layout_of(k);
        if (bytes_of(u) == size) {
            return true;
        }
    }
    return false;
}

static size_t value_at(const utia *u, size_t channel, size_t in, size_t out)
{
    return (channel * u->directions + in) * u->directions + out;
}

/* ---- evaluation ---- */

/* The four measured directions around one, and their weights. */
typedef struct around {
    size_t direction[4];
    double weight[4];
} around;

static around find_around(const utia *u, gonio_angles at)
{
    const gonio_i_step t =
        gonio_i_step_evenly(u->thetas, at.theta / ((double)(u->thetas - 1) * u->theta_step));
    const double revolutions = at.phi / (2.0 * M_PI);
    const double place = (revolutions - floor(revolutions)) * (double)u->phis;
    const size_t whole = (size_t)place;
    const size_t before = whole < u->phis ? whole : 0; /* rounding may make a turn of it */
    const double share = place - floor(place);
    around a;
    for (size_t k = 0; k < 4; k++) {
        const size_t next = before + k % 2;
        const size_t p = next < u->phis ? next : 0;
        a.direction[k] = (t.before + k / 2) * u->phis + p;
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
        const around in = find_around(u, pairs[n].incident);
        const around out = find_around(u, pairs[n].outgoing);
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            double sum = 0.0;
            for (size_t k = 0; k < 16; k++) {
                sum += in.weight[k / 4] * out.weight[k % 4] *
                       u->value[value_at(u, c, in.direction[k / 4], out.direction[k % 4])];
            }
            values[n * GONIO_CHANNELS + c] = sum;
        }
    }
    return GONIO_OK;
}

/* ---- reading ---- */

static gonio_status read_bytes(gonio_context *context, const char *path, void *to, size_t bytes)
{
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    char *next = to;
    size_t left = bytes;
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

/* The sum of the values of one incident direction, weighted by cos theta sin theta. */
static double find_reflected(const utia *u, size_t channel, size_t in)
{
    double sum = 0.0;
    for (size_t t = 0; t < u->thetas; t++) {
        const double theta = (double)t * u->theta_step;
        for (size_t out = t * u->phis; out < (t + 1) * u->phis; out++) {
            sum += u->value[value_at(u, channel, in, out)] * cos(theta) * sin(theta);
        }
    }
    return sum;
}

/* The largest albedo up to the last polar angle, as a mean over azimuths of incidence. */
static double find_albedo(const utia *u)
{
    double most = 0.0;
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        for (size_t t = 0; t < u->thetas; t++) {
            double sum = 0.0;
            for (size_t in = t * u->phis; in < (t + 1) * u->phis; in++) {
                sum += find_reflected(u, c, in);
            }
            most = fmax(most, sum / (double)u->phis * u->theta_step * u->phi_step);
        }
    }
    return most;
}

static gonio_status check_values(gonio_context *context, const char *path, utia *u)
{
    double *value = u->value;
    for (size_t k = 0; k < values_of(u); k++) {
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
    double *value = u->value;
    if (find_albedo(u) <= 1.2) {
        return false;
    }
    for (size_t k = 0; k < values_of(u); k++) {
        value[k] /= UNIT;
    }
    return true;
}

static void release(void *self)
{
    utia *u = self;
    if (u != NULL) {
        free(u->value);
    }
    free(u);
}

static gonio_status refuse_size(gonio_context *context, const gonio_i_file *file)
{
    return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                        "%s: like UTIA .bin, but %zu bytes are of no known grid: theta in steps of "
                        "15 degrees (1990656 bytes with phi in 7.5), 30, 22.5, 18, 10, 9, 7.5, 6 "
                        "or 5, phi in the same steps or in half of them",
                        file->path, (size_t)file->size);
}

static char *describe(const utia *u, bool scaled)
{
    const bool usual = u->directions == layout_of(0).directions;
    char grid[64] = "";
    if (!usual) {
        snprintf(grid, sizeof grid, " in steps of %g and %g degrees", u->theta_step / DEGREE,
                 u->phi_step / DEGREE);
    }
    return gonio_i_format("UTIA anisotropic BRDF, %zu x %zu directions%s%s", u->directions,
                          u->directions, grid, scaled ? ", values divided by 140" : "");
}

static gonio_status read_values(gonio_context *context, const gonio_i_file *file, utia *u)
{
    if (!find_layout(file->size, u)) {
        return refuse_size(context, file);
    }
    u->value = gonio_i_allocate(context, values_of(u), sizeof *u->value);
    gonio_status status = u->value != NULL ? read_bytes(context, file->path, u->value, bytes_of(u))
                                           : GONIO_ERROR_MEMORY;
    return status == GONIO_OK ? check_values(context, file->path, u) : status;
}

static gonio_status open_utia(gonio_context *context, const gonio_i_file *file,
                              gonio_material_source *source, char **description)
{
    utia *u = gonio_i_allocate(context, 1, sizeof *u);
    const gonio_status status = u != NULL ? read_values(context, file, u) : GONIO_ERROR_MEMORY;
    if (status != GONIO_OK) {
        release(u);
        return status;
    }
    *description = describe(u, scale_values(u));
    *source = (gonio_material_source){.evaluate = evaluate,
                                      .release = release,
                                      .self = u,
                                      .channels = GONIO_CHANNELS,
                                      .anisotropic = true,
                                      .theta_limit = (double)(u->thetas - 1) * u->theta_step};
    return GONIO_OK;
}

/* Whether a size is that of three planes of a square number of values. */
static bool are_square_planes(uint64_t size)
{
    const uint64_t plane = GONIO_CHANNELS * sizeof(double);
    const uint64_t values = size / plane;
    const uint64_t directions = (uint64_t)llround(sqrt((double)values));
    return size % plane == 0 && size > 0 && directions * directions == values;
}

/* By the size, and numbers at the beginning that can be values. Of sizes other than the database's
 * they have to be so large that text is none of them. */
static bool recognises(const gonio_i_file *file)
{
    const utia first = layout_of(0);
    const bool usual = file->size == bytes_of(&first);
    const double least = usual ? 1e-100 : 1e-20;
    bool any = usual;
    if (!usual && !are_square_planes(file->size)) {
        return false;
    }
    for (size_t k = 0; k + sizeof(double) <= file->head_size; k += sizeof(double)) {
        double value = 0.0;
        memcpy(&value, file->head + k, sizeof value);
        value = from_file(value);
        if (!(fabs(value) <= LARGEST) || (value != 0.0 && fabs(value) < least)) {
            return false;
        }
        any = any || value != 0.0;
    }
    return any;
}

const gonio_i_format_reader gonio_i_utia_reader = {
    .name = "UTIA .bin", .recognises = recognises, .open = open_utia};
