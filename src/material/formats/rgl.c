/* RGL .bsdf files: BRDFs measured by the adaptive parameterisation of Dupuy and Jakob, "An Adaptive
 * Parameterization for Efficient Material Acquisition and Rendering" (2018), which Mitsuba 3 and
 * pbrt-v4 render as `measured`.
 *
 * A tensor file (tensor_file.h). With u(theta) = (2 theta/pi)^(1/2), v(phi) = (phi + pi)/(2 pi), m
 * the half vector, and s the place of (u(theta_m), v(phi_m - phi_i)) under the density vndf of
 * visible normals for the incidence (warp.h; phi_m alone if the material is anisotropic),
 *
 *     rho = values(s | incidence) ndf(u(theta_m), v) / (4 sigma(u(theta_i), v(phi_i)) cos theta_o).
 *
 * Values are interpolated linearly between the incidences and between the nodes of a grid over s.
 * Where the field jacobian is 0 they hold rho cos theta_o itself.
 * They can be negative where light is outside the colours of sRGB: such a channel has no data.
 * Light was measured up to 80 degrees; values beyond are extrapolated. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../inside.h"
#include "../tensor_file.h"
#include "format.h"
#include "rgl.h"

static const double MEASURED = 80.0 * M_PI / 180.0;

static void release(void *self)
{
    gonio_i_rgl *r = self;
    free(r->wavelength);
    free(r->phi);
    free(r->theta);
    free(r->ndf.value);
    free(r->sigma.value);
    gonio_i_warp_free(&r->vndf);
    free(r->value);
    free(r->luminance);
    free(r->valid);
    free(r->description);
    free(r);
}

/* ---- evaluation ---- */

static double look_up(const float *value, size_t width, gonio_i_step x, gonio_i_step y)
{
    const float *at = value + y.before * width + x.before;
    const double low = (1.0 - x.share) * (double)at[0] + x.share * (double)at[1];
    const double high = (1.0 - x.share) * (double)at[width] + x.share * (double)at[width + 1];
    return (1.0 - y.share) * low + y.share * high;
}

double gonio_i_rgl_image_at(const gonio_i_rgl_image *i, double x, double y)
{
    return look_up(i->value, i->width, gonio_i_step_evenly(i->width, x),
                   gonio_i_step_evenly(i->height, y));
}

double gonio_i_rgl_place_of_theta(double theta)
{
    return sqrt(fmax(theta, 0.0) * (2.0 / M_PI));
}

/* In [0, 1). */
double gonio_i_rgl_place_of_phi(double phi)
{
    const double place = (phi + M_PI) / (2.0 * M_PI);
    return place - floor(place);
}

static gonio_i_blend blend_incidences(const gonio_i_rgl *r, gonio_angles incident)
{
    const gonio_i_step t = gonio_i_step_among(r->theta, r->thetas, incident.theta);
    const gonio_i_step p = gonio_i_step_among(r->phi, r->phis, incident.phi);
    gonio_i_blend blend = {0};
    for (size_t a = 0; a < 2; a++) {
        for (size_t b = 0; b < 2; b++) {
            const double weight =
                (a == 0 ? 1.0 - p.share : p.share) * (b == 0 ? 1.0 - t.share : t.share);
            if (weight > 0.0) {
                blend.slice[blend.count] = (p.before + a) * r->thetas + t.before + b;
                blend.weight[blend.count++] = weight;
            }
        }
    }
    return blend;
}

typedef struct vector {
    double x, y, z;
} vector;

static vector to_vector(gonio_angles a)
{
    return (vector){sin(a.theta) * cos(a.phi), sin(a.theta) * sin(a.phi), cos(a.theta)};
}

static gonio_angles to_angles(vector v)
{
    return (gonio_angles){atan2(hypot(v.x, v.y), v.z), atan2(v.y, v.x)};
}

/* Files of symmetrical materials hold azimuths of incidence of a half or a quarter circle from -pi
 * on. Both directions are rotated or mirrored until the incident one is in this range. */
static void reduce(const gonio_i_rgl *r, vector *i, vector *o)
{
    if (r->repeats >= 2) {
        const double y = i->y > 0.0 ? -1.0 : 1.0;
        const double x = r->repeats == 4 ? (i->x > 0.0 ? -1.0 : 1.0) : y;
        *i = (vector){x * i->x, y * i->y, i->z};
        *o = (vector){x * o->x, y * o->y, o->z};
    }
}

static void evaluate_values(const gonio_i_rgl *r, const gonio_i_blend *blend, const double s[2],
                            double factor, double *values)
{
    const gonio_i_step x = gonio_i_step_evenly(r->side, s[0]);
    const gonio_i_step y = gonio_i_step_evenly(r->side, s[1]);
    const size_t nodes = r->side * r->side;
    for (size_t c = 0; c < r->channels; c++) {
        double sum = 0.0;
        for (int k = 0; k < blend->count; k++) {
            const float *value = r->value + (blend->slice[k] * r->channels + c) * nodes;
            sum += blend->weight[k] * look_up(value, r->side, x, y);
        }
        values[c] = sum * factor;
    }
}

static void evaluate_pair(const gonio_i_rgl *r, gonio_pair pair, double *values)
{
    vector i = to_vector(pair.incident);
    vector o = to_vector(pair.outgoing);
    reduce(r, &i, &o);
    const gonio_angles incident = to_angles(i);
    const gonio_angles half = to_angles((vector){i.x + o.x, i.y + o.y, i.z + o.z});
    const gonio_i_blend blend = blend_incidences(r, incident);
    const double u[2] = {
        gonio_i_rgl_place_of_theta(half.theta),
        gonio_i_rgl_place_of_phi(r->isotropic ? half.phi - incident.phi : half.phi)};
    double s[2];
    gonio_i_warp_invert(&r->vndf, &blend, u, s);
    const double area = gonio_i_rgl_image_at(&r->sigma, gonio_i_rgl_place_of_theta(incident.theta),
                                             gonio_i_rgl_place_of_phi(incident.phi));
    const double factor =
        r->jacobian ? gonio_i_rgl_image_at(&r->ndf, u[0], u[1]) / (4.0 * area) : 1.0;
    evaluate_values(r, &blend, s, factor / o.z, values);
}

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    const gonio_i_rgl *r = self;
    (void)context;
    for (size_t k = 0; k < count; k++) {
        evaluate_pair(r, pairs[k], values + k * r->channels);
    }
    return GONIO_OK;
}

const gonio_i_rgl *gonio_i_rgl_of(const gonio_material *material)
{
    return material->source.evaluate == evaluate ? material->source.self : NULL;
}

/* ---- reading ---- */

/* A file while it is read. */
typedef struct reader {
    gonio_context *context;
    gonio_i_tensor_file file;
    gonio_i_rgl *r;
} reader;

static gonio_status wrong_shape(const reader *in, const char *name)
{
    return gonio_i_fail(in->context, GONIO_ERROR_FORMAT,
                        "%s: the shape of the field '%s' does not fit the others", in->file.path,
                        name);
}

/* Ascending angles or wavelengths. */
static gonio_status read_axis(const reader *in, const char *name, size_t *count, double **axis)
{
    const gonio_i_tensor *field = NULL;
    float *values = NULL;
    gonio_status status =
        gonio_i_tensor_expect(in->context, &in->file, name, GONIO_I_TENSOR_F32, 1, &field);
    if (status == GONIO_OK) {
        status = gonio_i_tensor_floats(in->context, &in->file, field, &values);
    }
    if (status != GONIO_OK) {
        return status;
    }
    *count = field->count;
    *axis = gonio_i_allocate(in->context, field->count, sizeof **axis);
    status = *axis != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < field->count && status == GONIO_OK; k++) {
        (*axis)[k] = (double)values[k];
        if (k > 0 && (*axis)[k] <= (*axis)[k - 1]) {
            status = gonio_i_fail(in->context, GONIO_ERROR_FORMAT,
                                  "%s: the field '%s' does not ascend", in->file.path, name);
        }
    }
    free(values);
    return status;
}

static gonio_status read_image(const reader *in, const char *name, gonio_i_rgl_image *to)
{
    const gonio_i_tensor *field = NULL;
    const gonio_status status =
        gonio_i_tensor_expect(in->context, &in->file, name, GONIO_I_TENSOR_F32, 2, &field);
    if (status != GONIO_OK) {
        return status;
    }
    if (field->shape[0] < 2 || field->shape[1] < 2) {
        return wrong_shape(in, name);
    }
    to->height = field->shape[0];
    to->width = field->shape[1];
    return gonio_i_tensor_floats(in->context, &in->file, field, &to->value);
}

/* A square of nodes for each incidence, at least 2 x 2. */
static bool has_shape(const gonio_i_rgl *r, const gonio_i_tensor *field)
{
    const uint64_t *last = field->shape + field->dimensions - 2;
    return field->shape[0] == r->phis && field->shape[1] == r->thetas && last[0] >= 2 &&
           last[1] >= 2;
}

static gonio_status read_vndf(const reader *in)
{
    const gonio_i_tensor *field = NULL;
    float *values = NULL;
    gonio_status status =
        gonio_i_tensor_expect(in->context, &in->file, "vndf", GONIO_I_TENSOR_F32, 4, &field);
    if (status == GONIO_OK && !has_shape(in->r, field)) {
        return wrong_shape(in, "vndf");
    }
    if (status == GONIO_OK) {
        status = gonio_i_tensor_floats(in->context, &in->file, field, &values);
    }
    if (status == GONIO_OK) {
        status = gonio_i_warp_create(in->context, values, in->r->phis * in->r->thetas,
                                     field->shape[2], field->shape[3], &in->r->vndf);
    }
    free(values);
    return status;
}

static gonio_status read_values(const reader *in)
{
    gonio_i_rgl *r = in->r;
    const char *name = r->wavelength != NULL ? "spectra" : "rgb";
    const gonio_i_tensor *field = NULL;
    const gonio_status status =
        gonio_i_tensor_expect(in->context, &in->file, name, GONIO_I_TENSOR_F32, 5, &field);
    if (status != GONIO_OK) {
        return status;
    }
    if (!has_shape(r, field) || field->shape[2] != r->channels ||
        field->shape[3] != field->shape[4]) {
        return wrong_shape(in, name);
    }
    r->side = field->shape[4];
    return gonio_i_tensor_floats(in->context, &in->file, field, &r->value);
}

/* Reads a field of bytes; NULL and size 0 if there is no such field. */
static gonio_status read_bytes(const reader *in, const char *name, unsigned char **bytes,
                               size_t *count)
{
    const gonio_i_tensor *field = gonio_i_tensor_find(&in->file, name);
    if (field == NULL || field->count == 0) {
        return GONIO_OK;
    }
    gonio_status status =
        gonio_i_tensor_expect(in->context, &in->file, name, GONIO_I_TENSOR_U8, 1, &field);
    if (status != GONIO_OK) {
        return status;
    }
    *bytes = gonio_i_allocate(in->context, field->count, 1);
    *count = field->count;
    return *bytes == NULL
               ? GONIO_ERROR_MEMORY
               : gonio_i_tensor_read(in->context, &in->file, field, 0, field->count, *bytes);
}

static gonio_status read_jacobian(const reader *in)
{
    unsigned char *bytes = NULL;
    size_t count = 0;
    const gonio_status status = read_bytes(in, "jacobian", &bytes, &count);
    in->r->jacobian = status != GONIO_OK || count == 0 || bytes[0] != 0;
    free(bytes);
    return status;
}

/* Reads the fields that only a copy of the file needs. */
static gonio_status read_rest(const reader *in)
{
    gonio_i_rgl *r = in->r;
    const gonio_i_tensor *field = NULL;
    gonio_status status = read_bytes(in, "description", &r->description, &r->description_size);
    if (status == GONIO_OK) {
        status = read_bytes(in, "valid", &r->valid, &r->valid_size);
    }
    if (status != GONIO_OK || gonio_i_tensor_find(&in->file, "luminance") == NULL) {
        return status;
    }
    status =
        gonio_i_tensor_expect(in->context, &in->file, "luminance", GONIO_I_TENSOR_F32, 4, &field);
    if (status != GONIO_OK) {
        return status;
    }
    if (!has_shape(r, field) || field->shape[2] != r->side || field->shape[3] != r->side) {
        return wrong_shape(in, "luminance");
    }
    return gonio_i_tensor_floats(in->context, &in->file, field, &r->luminance);
}

static gonio_status read_channels(const reader *in)
{
    in->r->channels = GONIO_CHANNELS;
    return gonio_i_tensor_find(&in->file, "wavelengths") != NULL
               ? read_axis(in, "wavelengths", &in->r->channels, &in->r->wavelength)
               : GONIO_OK;
}

static void find_symmetry(gonio_i_rgl *r)
{
    r->isotropic = r->phis <= 2;
    r->repeats = 1;
    if (!r->isotropic) {
        const double range = r->phi[r->phis - 1] - r->phi[0];
        r->repeats = (int)fmin(fmax(round(2.0 * M_PI / range), 1.0), 4.0);
    }
}

static gonio_status read_rgl(const reader *in)
{
    gonio_i_rgl *r = in->r;
    gonio_status status = read_axis(in, "phi_i", &r->phis, &r->phi);
    if (status == GONIO_OK) {
        status = read_axis(in, "theta_i", &r->thetas, &r->theta);
    }
    if (status == GONIO_OK) {
        find_symmetry(r);
        status = read_channels(in);
    }
    if (status == GONIO_OK) {
        status = read_image(in, "ndf", &r->ndf);
    }
    if (status == GONIO_OK) {
        status = read_image(in, "sigma", &r->sigma);
    }
    if (status == GONIO_OK) {
        status = read_vndf(in);
    }
    if (status == GONIO_OK) {
        status = read_values(in);
    }
    if (status == GONIO_OK) {
        status = read_jacobian(in);
    }
    return status == GONIO_OK ? read_rest(in) : status;
}

static char *describe(const gonio_i_rgl *r)
{
    return gonio_i_format(
        "RGL %s BSDF, %s, %zu x %zu at %zu incidences", r->isotropic ? "isotropic" : "anisotropic",
        r->wavelength != NULL ? "spectral" : "RGB", r->side, r->side, r->phis * r->thetas);
}

static gonio_status open_rgl(gonio_context *context, const gonio_i_file *file,
                             gonio_material_source *source, char **description)
{
    reader in = {.context = context};
    gonio_status status = gonio_i_tensor_open(context, file->path, &in.file);
    if (status != GONIO_OK) {
        return status;
    }
    in.r = gonio_i_allocate(context, 1, sizeof *in.r);
    status = in.r != NULL ? read_rgl(&in) : GONIO_ERROR_MEMORY;
    gonio_i_tensor_close(&in.file);
    if (status != GONIO_OK) {
        if (in.r != NULL) {
            release(in.r);
        }
        return status;
    }
    *description = describe(in.r);
    *source = (gonio_material_source){.evaluate = evaluate,
                                      .release = release,
                                      .self = in.r,
                                      .channels = in.r->channels,
                                      .wavelength = in.r->wavelength,
                                      .anisotropic = !in.r->isotropic,
                                      .theta_limit = MEASURED};
    return GONIO_OK;
}

/* Tensor files of two kinds begin alike; the names of the fields stand near the start. */
static bool recognises(const gonio_i_file *file)
{
    return gonio_i_tensor_recognises((const unsigned char *)file->head, file->head_size) &&
           memmem(file->head, file->head_size, "vndf", 4) != NULL;
}

const gonio_i_format_reader gonio_i_rgl_reader = {
    .name = "RGL .bsdf", .recognises = recognises, .open = open_rgl};
