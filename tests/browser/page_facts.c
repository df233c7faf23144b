/* What the page is compared with, from the C library: page-facts ORIGINAL FOLDER writes
 *   values.json      random pairs of directions and the BRDF there
 *   sphere.json      the sphere under a lamp: radiance at the middle of each pixel
 *   deviation.binary a made-up table of standard deviations */
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

static json_t *values(const gonio_table *table)
{
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, 0);
    json_t *list = json_array();
    for (int k = 0; k < PAIRS; k++) {
        const gonio_pair pair = {random_angles(&random), random_angles(&random)};
        double rho[GONIO_CHANNELS];
        const bool found = gonio_table_value(table, gonio_half_difference_from_pair(pair), rho);
        json_array_append_new(list, json_pack("[f,f,f,f,f,f,f,b]", pair.incident.theta,
                                              pair.incident.phi, pair.outgoing.theta,
                                              pair.outgoing.phi, rho[0], rho[1], rho[2], found));
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
static gonio_status read_deviation(void *self, gonio_context *context, int theta_h, double *rho)
{
    (void)self;
    (void)context;
    for (int k = 0; k < GONIO_SLAB_BINS; k++) {
        const gonio_bin bin = {theta_h, k / GONIO_PHI_D_BINS, k % GONIO_PHI_D_BINS};
        const double deviation = 0.03 + 0.2 * bin.theta_d / 90.0;
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            rho[channel * GONIO_SLAB_BINS + k] =
                gonio_bin_is_valid(bin) ? deviation * gonio_log_scale(channel) : -1.0;
        }
    }
    return GONIO_OK;
}

static gonio_status write_deviation(const char *folder)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/deviation.binary", folder);
    gonio_material *material = NULL;
    const gonio_material_source source = {.size = sizeof source, .read_slab = read_deviation};
    gonio_status status = gonio_material_create(NULL, "deviation", "made", &source, &material);
    if (status == GONIO_OK) {
        status = gonio_material_write_merl(NULL, material, path);
    }
    gonio_material_free(&material);
    return status;
}

int main(int argc, char **argv)
{
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    if (argc != 3 || gonio_material_open(NULL, argv[1], &material) != GONIO_OK ||
        gonio_table_load(NULL, material, &table) != GONIO_OK ||
        write_deviation(argv[2]) != GONIO_OK) {
        fprintf(stderr, "usage: page-facts ORIGINAL FOLDER\n");
        return 1;
    }
    write_json(values(table), argv[2], "values.json");
    write_json(sphere(table), argv[2], "sphere.json");
    gonio_table_free(&table);
    gonio_material_free(&material);
    return 0;
}
