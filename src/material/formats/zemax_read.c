/* Zemax BSDF files as materials: between the angles of the grid values are interpolated in its own
 * parameterisation, about the mirror direction.
 *
 * Linear in the logarithm, between the values that were measured: 0 is none. Rotations of the
 * sample are the azimuths of the light. They repeat after a turn or half a turn, whichever they
 * fill; those of a quarter turn are mirrored. Light nearer to the normal than the first incidence
 * is taken as that. Where light has no values there, those with light and viewer exchanged are
 * taken. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/core.h"
#include "../../core/number.h"
#include "../../core/text_encoding.h"
#include "../../core/text_file.h"
#include "../colour.h"
#include "../warp.h"
#include "format.h"
#include "zemax_grid.h"

enum { NEIGHBOURS = 1 << GONIO_I_ZEMAX_AXES };

static const double SLACK = 0.01; /* degrees */
static const double LARGEST = 1e9;

typedef struct zemax {
    gonio_i_zemax_grid grid; /* logarithms of the values; NaN: none */
    double period;           /* of rotations, degrees; 0: there is one */
    bool mirrored;           /* rotations of a quarter turn */
    bool half;               /* azimuths of one half, the other is the same */
} zemax;

static void release(void *self)
{
    zemax *z = self;
    gonio_i_zemax_free(&z->grid);
    free(z);
}

/* ---- where a pair of directions is in the grid ---- */

typedef struct place {
    double at[GONIO_I_ZEMAX_AXES]; /* degrees */
} place;

static double degrees(double radians)
{
    return radians * 180.0 / M_PI;
}

static double within(double angle, double period)
{
    return angle - period * floor(angle / period);
}

/* Turns an angle into the range that a periodic axis begins with. */
static double wrap(const gonio_i_zemax_axis *axis, double angle, double period)
{
    return axis->degrees[0] + within(angle - axis->degrees[0], period);
}

/* The rotation of the sample. Returns whether the other side of the plane of incidence is meant. */
static bool find_rotation(const zemax *z, double phi_i, double *rotation)
{
    const gonio_i_zemax_axis *axis = &z->grid.axis[GONIO_I_ZEMAX_ROTATION];
    *rotation = axis->degrees[0];
    if (z->mirrored) {
        const double turned = within(phi_i - axis->degrees[0], 180.0);
        *rotation += turned <= 90.0 ? turned : 180.0 - turned;
        return turned > 90.0;
    }
    if (z->period > 0.0) {
        *rotation = wrap(axis, phi_i, z->period);
    }
    return false;
}

/* Polar angle and azimuth about the mirror direction m = (-sin t, 0, cos t) of light from
 * (sin t, 0, cos t); the azimuth is 0 towards the normal, u = (cos t, 0, sin t). */
static place find_place(const zemax *z, gonio_angles in, gonio_angles out)
{
    place p;
    const double across = out.phi - in.phi;
    const double x = sin(out.theta) * cos(across);
    const double y = sin(out.theta) * sin(across);
    const double height = cos(out.theta);
    const double along = -sin(in.theta) * x + cos(in.theta) * height;
    const double u = cos(in.theta) * x + sin(in.theta) * height;
    const bool other_side = find_rotation(z, degrees(in.phi), &p.at[GONIO_I_ZEMAX_ROTATION]);
    const double azimuth = degrees(atan2(other_side ? -y : y, u));
    p.at[GONIO_I_ZEMAX_INCIDENCE] = degrees(in.theta);
    p.at[GONIO_I_ZEMAX_RADIAL] = degrees(atan2(hypot(u, y), along));
    p.at[GONIO_I_ZEMAX_AZIMUTH] =
        z->half ? fabs(azimuth) : wrap(&z->grid.axis[GONIO_I_ZEMAX_AZIMUTH], azimuth, 360.0);
    return p;
}

/* ---- evaluation ---- */

/* The two angles around one, of which the second may be the first of the next period. */
typedef struct around {
    size_t index[2];
    double share; /* of the second */
} around;

static around find_around(const gonio_i_zemax_axis *axis, double at, double period)
{
    const double *node = axis->degrees;
    const size_t last = axis->count - 1;
    if (period > 0.0 && at > node[last]) {
        const double gap = node[0] + period - node[last];
        return (around){{last, 0}, fmin((at - node[last]) / gap, 1.0)};
    }
    const gonio_i_step step = gonio_i_step_among(node, axis->count, at);
    return (around){{step.before, step.before < last ? step.before + 1 : last}, step.share};
}

/* The mean of the logarithms around a place, of those that were measured; NaN without any. */
static double mean_around(const double *value, const size_t *index, const double *weight)
{
    double sum = 0.0;
    double total = 0.0;
    for (size_t k = 0; k < NEIGHBOURS; k++) {
        const double here = value[index[k]];
        if (weight[k] > 0.0 && !isnan(here)) {
            sum += weight[k] * here;
            total += weight[k];
        }
    }
    return total > 0.0 ? exp(sum / total) : NAN;
}

/* The values around a place, and their weights. */
static void find_neighbours(const zemax *z, const place *p, size_t *index, double *weight)
{
    const gonio_i_zemax_axis *axis = z->grid.axis;
    const double period[GONIO_I_ZEMAX_AXES] = {
        [GONIO_I_ZEMAX_ROTATION] = z->period, [GONIO_I_ZEMAX_AZIMUTH] = z->half ? 0.0 : 360.0};
    around a[GONIO_I_ZEMAX_AXES];
    for (int k = 0; k < GONIO_I_ZEMAX_AXES; k++) {
        a[k] = find_around(&axis[k], p->at[k], period[k]);
    }
    for (size_t n = 0; n < NEIGHBOURS; n++) {
        index[n] = 0;
        weight[n] = 1.0;
        for (int k = 0; k < GONIO_I_ZEMAX_AXES; k++) {
            const size_t side = n >> k & 1;
            index[n] = index[n] * axis[k].count + a[k].index[side];
            weight[n] *= side ? a[k].share : 1.0 - a[k].share;
        }
    }
}

static bool is_beyond(const gonio_i_zemax_axis *axis, double at)
{
    return at > axis->degrees[axis->count - 1] + SLACK;
}

/* The values of the planes with light from `in`. Returns whether there are any. */
static bool look_up(const zemax *z, gonio_angles in, gonio_angles out,
                    double value[GONIO_I_ZEMAX_PLANES])
{
    const place p = find_place(z, in, out);
    size_t index[NEIGHBOURS];
    double weight[NEIGHBOURS];
    if (is_beyond(&z->grid.axis[GONIO_I_ZEMAX_INCIDENCE], p.at[GONIO_I_ZEMAX_INCIDENCE]) ||
        is_beyond(&z->grid.axis[GONIO_I_ZEMAX_RADIAL], p.at[GONIO_I_ZEMAX_RADIAL])) {
        return false;
    }
    find_neighbours(z, &p, index, weight);
    for (size_t c = 0; c < z->grid.planes; c++) {
        value[c] = mean_around(z->grid.value[c], index, weight);
    }
    return !isnan(value[0]);
}

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    const zemax *z = self;
    (void)context;
    for (size_t n = 0; n < count; n++) {
        double value[GONIO_I_ZEMAX_PLANES] = {NAN, NAN, NAN};
        double *to = values + n * z->grid.planes;
        if (!look_up(z, pairs[n].incident, pairs[n].outgoing, value)) {
            look_up(z, pairs[n].outgoing, pairs[n].incident, value);
        }
        if (z->grid.planes == GONIO_I_ZEMAX_PLANES) {
            gonio_i_xyz_to_rgb(value, to);
        } else {
            to[0] = value[0];
        }
    }
    return GONIO_OK;
}

/* ---- reading ---- */

static gonio_status check_axis(gonio_context *context, const char *path,
                               const gonio_i_zemax_axis *axis, const char *name)
{
    for (size_t k = 1; k < axis->count; k++) {
        if (!(axis->degrees[k] > axis->degrees[k - 1])) {
            return gonio_i_fail(context, GONIO_ERROR_DATA,
                                "%s: %s %g after %g: a material has ascending angles; 'gonio "
                                "reconstruct' makes one of any readings",
                                path, name, axis->degrees[k], axis->degrees[k - 1]);
        }
    }
    return GONIO_OK;
}

static double range_of(const gonio_i_zemax_axis *axis)
{
    return axis->degrees[axis->count - 1] - axis->degrees[0];
}

/* Finds after which turn of the sample rotations repeat. */
static gonio_status find_period(gonio_context *context, const char *path, zemax *z)
{
    const gonio_i_zemax_axis *axis = &z->grid.axis[GONIO_I_ZEMAX_ROTATION];
    const double range = range_of(axis);
    double step = 0.0;
    for (size_t k = 1; k < axis->count; k++) {
        step = fmax(step, axis->degrees[k] - axis->degrees[k - 1]);
    }
    z->mirrored = axis->count > 2 && fabs(range - 90.0) <= SLACK;
    z->period = axis->count == 1                                          ? 0.0
                : range + step >= 360.0 - SLACK                           ? 360.0
                : range + step >= 180.0 - SLACK && range <= 180.0 + SLACK ? 180.0
                                                                          : -1.0;
    if (z->period >= 0.0 || z->mirrored) {
        z->mirrored = z->mirrored && z->period < 0.0;
        z->period = fmax(z->period, 0.0);
        return GONIO_OK;
    }
    return gonio_i_fail(context, GONIO_ERROR_DATA,
                        "%s: SampleRotation from %g to %g degrees is no whole, half or quarter "
                        "turn, so other rotations are not known; 'gonio reconstruct "
                        "--anisotropic' makes a material of these readings",
                        path, axis->degrees[0], axis->degrees[axis->count - 1]);
}

static gonio_status check_angles(gonio_context *context, const char *path, const zemax *z)
{
    gonio_status status = GONIO_OK;
    for (int k = 0; k < GONIO_I_ZEMAX_AXES && status == GONIO_OK; k++) {
        status = check_axis(context, path, &z->grid.axis[k], gonio_i_zemax_axis_names[k]);
    }
    const gonio_i_zemax_axis *incidence = &z->grid.axis[GONIO_I_ZEMAX_INCIDENCE];
    const gonio_i_zemax_axis *radial = &z->grid.axis[GONIO_I_ZEMAX_RADIAL];
    if (status == GONIO_OK && !(incidence->degrees[0] >= 0.0 && radial->degrees[0] >= 0.0 &&
                                incidence->degrees[incidence->count - 1] < 90.0)) {
        status = gonio_i_fail(context, GONIO_ERROR_DATA,
                              "%s: incidences from %g to %g degrees, radial angles from %g: from 0 "
                              "on, incidences below 90, are expected of a material",
                              path, incidence->degrees[0], incidence->degrees[incidence->count - 1],
                              radial->degrees[0]);
    }
    return status;
}

/* Takes logarithms. A value of X, Y, Z without the others is none. */
static gonio_status take_logarithms(gonio_context *context, const char *path, zemax *z)
{
    const size_t count = gonio_i_zemax_total(&z->grid);
    size_t measured = 0;
    for (size_t k = 0; k < count; k++) {
        bool known = true;
        for (size_t c = 0; c < z->grid.planes; c++) {
            const double value = z->grid.value[c][k];
            if (value > LARGEST) {
                return gonio_i_fail(context, GONIO_ERROR_DATA,
                                    "%s:%zu: %g 1/sr is too large for a BRDF", path,
                                    z->grid.line[k], value);
            }
            known = known && value > 0.0;
        }
        for (size_t c = 0; c < z->grid.planes; c++) {
            z->grid.value[c][k] = known ? log(z->grid.value[c][k]) : NAN;
        }
        measured += known;
    }
    return measured > 0 ? GONIO_OK
                        : gonio_i_fail(context, GONIO_ERROR_DATA,
                                       "%s: all values are 0: nothing was measured", path);
}

static gonio_status prepare(gonio_context *context, const char *path, zemax *z)
{
    gonio_status status = check_angles(context, path, z);
    if (status == GONIO_OK) {
        status = find_period(context, path, z);
    }
    z->half = range_of(&z->grid.axis[GONIO_I_ZEMAX_AZIMUTH]) <= 180.0 + SLACK;
    return status == GONIO_OK ? take_logarithms(context, path, z) : status;
}

static gonio_status read_grid(gonio_context *context, const char *path, gonio_i_zemax_grid *grid)
{
    char *text = NULL;
    size_t size = 0;
    gonio_i_plain_numbers plain;
    gonio_status status = gonio_i_text_read(context, path, &text, &size);
    if (status == GONIO_OK) {
        status = gonio_i_text_make_plain(context, path, &text, &size);
    }
    if (status == GONIO_OK) {
        status = GONIO_ERROR_MEMORY;
        if (gonio_i_plain_numbers_begin(&plain)) {
            status = gonio_i_zemax_read(context, path, text, size, grid);
            gonio_i_plain_numbers_end(&plain);
        }
    }
    free(text);
    return status;
}

static char *describe(const zemax *z)
{
    char text[160];
    const gonio_i_zemax_axis *axis = z->grid.axis;
    snprintf(text, sizeof text, "Zemax BSDF, %zu rotation%s x %zu incidences x %zu azimuths x %zu",
             axis[GONIO_I_ZEMAX_ROTATION].count, axis[GONIO_I_ZEMAX_ROTATION].count == 1 ? "" : "s",
             axis[GONIO_I_ZEMAX_INCIDENCE].count, axis[GONIO_I_ZEMAX_AZIMUTH].count,
             axis[GONIO_I_ZEMAX_RADIAL].count);
    return strdup(text);
}

static gonio_status open_zemax(gonio_context *context, const gonio_i_file *file,
                               gonio_material_source *source, char **description)
{
    zemax *z = gonio_i_allocate(context, 1, sizeof *z);
    gonio_status status = z != NULL ? read_grid(context, file->path, &z->grid) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = prepare(context, file->path, z);
    }
    if (status != GONIO_OK) {
        if (z != NULL) {
            release(z);
        }
        return status;
    }
    *description = describe(z);
    *source =
        (gonio_material_source){.evaluate = evaluate,
                                .release = release,
                                .self = z,
                                .channels = z->grid.planes,
                                .anisotropic = z->grid.axis[GONIO_I_ZEMAX_ROTATION].count > 1};
    return GONIO_OK;
}

static bool recognises(const gonio_i_file *file)
{
    char head[GONIO_I_HEAD + 1];
    const size_t size = gonio_i_text_plain_head(file->head, file->head_size, head, sizeof head);
    return gonio_i_zemax_recognises(head, size);
}

const gonio_i_format_reader gonio_i_zemax_reader = {
    .name = "Zemax BSDF", .recognises = recognises, .open = open_zemax, .readings = true};
