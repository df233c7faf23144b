/* What the page is compared with, from the C library: page-facts ORIGINAL FOLDER writes
 *   values.json      random pairs of directions and the BRDF there
 *   sphere.json      the sphere under a lamp: radiance at the middle of each pixel
 *   deviation.binary a made-up table of standard deviations
 *   poles.binary     a made-up material that depends on phi_d where that means nothing
 *   poles.json       its BRDF near theta_h = 0 and theta_d = 0, as values.json */
#include <gonio/gonio.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/random.h"

enum { PAIRS = 4000, SIZE = 96 };

static void write_json(json_t *json, const char *folder, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (json_dump_file(json, path, JSON_COMPACT | JSON_REAL_PRECISION(12)) != 0) {
        fprintf(stderr, "%s: cannot be written\n", path);
        exit(1);
    }
    json_decref(json);
}

static gonio_angles random_angles(gonio_i_random *random)
{
    return (gonio_angles){gonio_i_random_uniform(random) * M_PI / 2.0,
                          gonio_i_random_uniform(random) * 2.0 * M_PI};
}

static void add_value(const gonio_table *table, gonio_pair pair, json_t *list)
{
    double rho[GONIO_CHANNELS];
    const bool found = gonio_table_value(table, gonio_half_difference_from_pair(pair), rho);
    json_array_append_new(list, json_pack("[f,f,f,f,f,f,f,b]", pair.incident.theta,
                                          pair.incident.phi, pair.outgoing.theta, pair.outgoing.phi,
                                          rho[0], rho[1], rho[2], found));
}

static json_t *values(const gonio_table *table)
{
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, 0);
    json_t *list = json_array();
    for (int k = 0; k < PAIRS; k++) {
        const gonio_pair pair = {random_angles(&random), random_angles(&random)};
        add_value(table, pair, list);
    }
    return list;
}

/* Half of them with theta_d up to 1 degree, half with theta_h up to 0.006 degrees; the first are
 * the poles themselves. */
static json_t *values_at_poles(const gonio_table *table)
{
    gonio_i_random random;
    gonio_i_random_seed(&random, 2, 0);
    json_t *list = json_array();
    for (int k = 0; k < PAIRS; k++) {
        const double near = M_PI / 180.0 * (k < 2 ? 0.0 : gonio_i_random_uniform(&random));
        const double wide = 1.2 * gonio_i_random_uniform(&random);
        const double phi_d = M_PI * gonio_i_random_uniform(&random);
        const gonio_half_difference at = {k % 2 == 0 ? wide : 0.006 * near,
                                          k % 2 == 0 ? near : wide, phi_d};
        add_value(table, gonio_pair_from_half_difference(at), list);
    }
    return list;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* In the frame of the normal; any tangent serves an isotropic material. */
static gonio_angles angles_about(const double normal[3], const double v[3])
{
    const double length = hypot(normal[0], normal[2]);
    const double x[3] = {normal[2] / length, 0.0, -normal[0] / length};
    const double y[3] = {normal[1] * x[2], normal[2] * x[0] - normal[0] * x[2], -normal[1] * x[0]};
    return (gonio_angles){acos(fmin(dot(v, normal), 1.0)), atan2(dot(v, y), dot(v, x))};
}

/* Where the ray through (x, y) of a picture from -1 to 1 meets the unit sphere, and the direction
 * back; seen from +z, field of view 30 degrees, the sphere filling 0.95 of it. */
static bool meet(double x, double y, double point[3], double back[3])
{
    const double tangent = tan(M_PI / 12.0);
    const double distance = 1.0 / sin(atan(0.95 * tangent));
    const double length = sqrt(1.0 + tangent * tangent * (x * x + y * y));
    const double ray[3] = {x * tangent / length, y * tangent / length, -1.0 / length};
    const double half = distance * ray[2];
    const double discriminant = half * half - distance * distance + 1.0;
    const double along = -half - sqrt(fmax(discriminant, 0.0));
    for (int k = 0; k < 3; k++) {
        point[k] = (k == 2 ? distance : 0.0) + along * ray[k];
        back[k] = -ray[k];
    }
    return discriminant > 0.0;
}

/* Radiance under a lamp of irradiance pi at azimuth -45, elevation 45 degrees, and the cosines. */
static json_t *pixel(const gonio_table *table, double x, double y)
{
    const double lamp[3] = {-0.5, sqrt(0.5), 0.5};
    double point[3];
    double back[3];
    if (!meet(x, y, point, back)) {
        return json_null();
    }
    const gonio_pair pair = {angles_about(point, lamp), angles_about(point, back)};
    double rho[GONIO_CHANNELS];
    gonio_table_value(table, gonio_half_difference_from_pair(pair), rho);
    const double cosine = fmax(dot(point, lamp), 0.0);
    return json_pack("[f,f,f,f,f]", M_PI * cosine * rho[0], M_PI * cosine * rho[1],
                     M_PI * cosine * rho[2], cosine, dot(point, back));
}

static json_t *sphere(const gonio_table *table)
{
    json_t *list = json_array();
    for (int row = 0; row < SIZE; row++) { /* bottom row first */
        for (int column = 0; column < SIZE; column++) {
            json_array_append_new(list, pixel(table, 2.0 * (column + 0.5) / SIZE - 1.0,
                                              2.0 * (row + 0.5) / SIZE - 1.0));
        }
    }
    return json_pack("{s:i, s:o}", "size", SIZE, "pixels", list);
}

/* Grows towards grazing angles: what the file holds is the deviation itself. */
/* A made-up table: the value of each bin in units of s, in all channels alike. */
typedef double (*made_value)(gonio_bin bin);

static double deviation_of(gonio_bin bin)
{
    return 0.03 + 0.2 * bin.theta_d / 90.0;
}

static double turning_value(gonio_bin bin)
{
    return 100.0 * (1.5 + cos(2.0 * M_PI * (bin.phi_d + 0.5) / GONIO_PHI_D_BINS));
}

static gonio_status read_made(void *self, gonio_context *context, int theta_h, double *rho)
{
    const made_value *value = self;
    (void)context;
    for (int k = 0; k < GONIO_SLAB_BINS; k++) {
        const gonio_bin bin = {theta_h, k / GONIO_PHI_D_BINS, k % GONIO_PHI_D_BINS};
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            rho[channel * GONIO_SLAB_BINS + k] =
                gonio_bin_is_valid(bin) ? (*value)(bin)*gonio_log_scale(channel) : -1.0;
        }
    }
    return GONIO_OK;
}

/* Writes FOLDER/NAME.binary; *table: the same to look values up, if it is not NULL. */
static gonio_status write_made(const char *folder, const char *name, made_value value,
                               gonio_table **table)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.binary", folder, name);
    gonio_material *material = NULL;
    const gonio_material_source source = {
        .size = sizeof source, .read_slab = read_made, .self = &value};
    gonio_status status = gonio_material_create(NULL, name, "made", &source, &material);
    if (status == GONIO_OK) {
        status = gonio_material_write_merl(NULL, material, path);
    }
    if (status == GONIO_OK && table != NULL) {
        status = gonio_table_load(NULL, material, table);
    }
    gonio_material_free(&material);
    return status;
}

int main(int argc, char **argv)
{
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    gonio_table *poles = NULL;
    if (argc != 3 || gonio_material_open(NULL, argv[1], &material) != GONIO_OK ||
        gonio_table_load(NULL, material, &table) != GONIO_OK ||
        write_made(argv[2], "deviation", deviation_of, NULL) != GONIO_OK ||
        write_made(argv[2], "poles", turning_value, &poles) != GONIO_OK) {
        fprintf(stderr, "usage: page-facts ORIGINAL FOLDER\n");
        return 1;
    }
    write_json(values(table), argv[2], "values.json");
    write_json(values_at_poles(poles), argv[2], "poles.json");
    write_json(sphere(table), argv[2], "sphere.json");
    gonio_table_free(&poles);
    gonio_table_free(&table);
    gonio_material_free(&material);
    return 0;
}
