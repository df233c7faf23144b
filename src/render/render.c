/* Rendering: light that comes straight from a lamp or an environment to every pixel. */
#include <math.h>
#include <string.h>

#include "../core/core.h"
#include "../core/random.h"
#include "environment.h"
#include "geometry.h"
#include "render.h"
#include "scene.h"

void gonio_render_options_default(gonio_render_options *options)
{
    *options = (gonio_render_options){.width = 512,
                                      .height = 512,
                                      .samples = 64,
                                      .lamp = GONIO_LAMP_DIRECTIONAL,
                                      .lamp_position = {-0.5, 0.7071067811865476, 0.5},
                                      .field_of_view = M_PI / 6.0};
}

/* ---- the camera ---- */

typedef struct camera {
    gonio_i_frame frame; /* z: from the object to the viewer */
    double distance;     /* of the viewer; 0 for parallel rays */
    double half_side;    /* of the shorter side: a slope, or for parallel rays a length */
    int width, height;
} camera;

static const double share = 0.95; /* of the shorter side, which the unit sphere fills */

static camera place_camera(const gonio_render_options *o)
{
    camera c = {.width = o->width, .height = o->height};
    const double z[3] = {cos(o->elevation) * sin(o->azimuth), sin(o->elevation),
                         cos(o->elevation) * cos(o->azimuth)};
    const double x[3] = {cos(o->azimuth), 0.0, -sin(o->azimuth)};
    const double y[3] = {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2],
                         z[0] * x[1] - z[1] * x[0]};
    memcpy(c.frame.x, x, sizeof x);
    memcpy(c.frame.y, y, sizeof y);
    memcpy(c.frame.z, z, sizeof z);
    c.half_side = 1.0 / share;
    if (o->field_of_view > 0.0) {
        const double vertical = tan(0.5 * o->field_of_view);
        const double shorter = fmin(1.0, (double)o->width / o->height);
        c.half_side = vertical * shorter;
        c.distance = 1.0 / sin(atan(share * c.half_side)); /* the sphere's rim is tangent to rays */
    }
    return c;
}

/* The ray through a place in the image, in pixels from the top left. */
static void camera_ray(const camera *c, double x, double y, double origin[3], double direction[3])
{
    const double scale = 2.0 * c->half_side / (c->width < c->height ? c->width : c->height);
    const double right = (x - 0.5 * c->width) * scale;
    const double up = (0.5 * c->height - y) * scale;
    const bool parallel = c->distance == 0.0;
    const double from[3] = {parallel ? right : 0.0, parallel ? up : 0.0,
                            parallel ? 4.0 : c->distance};
    const double towards[3] = {parallel ? 0.0 : right, parallel ? 0.0 : up, -1.0};
    gonio_i_to_world(&c->frame, from, origin);
    gonio_i_to_world(&c->frame, towards, direction);
    gonio_i_normalise(direction);
}

/* ---- light ---- */

typedef struct view {
    const gonio_render_options *options;
    const gonio_i_scene *scene;
    const gonio_i_surface *surface, *sampler;
    camera camera;
} view;

/* Between the world and the environment's own frame: a turn about y. */
static void turn(double angle, const double from[3], double to[3])
{
    const double c = cos(angle);
    const double s = sin(angle);
    const double turned[3] = {c * from[0] - s * from[2], from[1], s * from[0] + c * from[2]};
    memcpy(to, turned, sizeof turned);
}

/* A place on the object that is being shaded. */
typedef struct place {
    const gonio_i_hit *hit;
    gonio_i_frame frame; /* about the normal */
    double outgoing[3];  /* in the frame */
} place;

/* Adds what a direction (of the world) contributes: the BRDF times cosine times light. */
static void add_light(const view *v, const place *p, const double world[3], double distance,
                      const double light[3], double factor, double sum[3])
{
    double incident[3];
    double rho[GONIO_CHANNELS];
    gonio_i_to_local(&p->frame, world, incident);
    if (incident[2] <= 0.0 || gonio_i_dot(p->hit->face, world) <= 0.0 ||
        !gonio_i_scene_is_free(v->scene, p->hit, world, distance)) {
        return;
    }
    gonio_i_surface_value(v->surface, incident, p->outgoing, rho);
    for (int k = 0; k < 3; k++) {
        sum[k] += rho[k] * incident[2] * light[k] * factor;
    }
}

/* Irradiance pi at the origin, facing the lamp. */
static void add_lamp(const view *v, const place *p, double sum[3])
{
    const gonio_render_options *o = v->options;
    double direction[3];
    double distance = INFINITY;
    double strength = M_PI;
    memcpy(direction, o->lamp_position, sizeof direction);
    if (o->lamp == GONIO_LAMP_POINT) {
        gonio_i_along(o->lamp_position, -1.0, p->hit->point, direction);
        distance = gonio_i_length(direction);
        strength *= gonio_i_dot(o->lamp_position, o->lamp_position) / (distance * distance);
    }
    gonio_i_normalise(direction);
    const double light[3] = {strength, strength, strength};
    add_light(v, p, direction, distance, light, 1.0, sum);
}

/* The balance heuristic: one direction of either kind, each divided by the sum of the densities. */
static void add_from_environment(const view *v, const place *p, const double own[3],
                                 double surface_density, double sum[3])
{
    const gonio_environment *e = v->options->environment;
    double world[3];
    double light[3];
    turn(v->options->environment_turn, own, world);
    gonio_i_environment_radiance(e, own, light);
    add_light(v, p, world, INFINITY, light,
              1.0 / (gonio_i_environment_density(e, own) + surface_density), sum);
}

static void add_environment(const view *v, const place *p, const double uniform[5], double sum[3])
{
    double own[3];
    double world[3];
    double local[3];
    gonio_i_environment_sample(v->options->environment, uniform, own);
    turn(v->options->environment_turn, own, world);
    gonio_i_to_local(&p->frame, world, local);
    if (local[2] > 0.0) {
        add_from_environment(v, p, own, gonio_i_surface_density(v->sampler, local, p->outgoing),
                             sum);
    }
    if (gonio_i_surface_sample(v->sampler, p->outgoing, uniform + 2, local)) {
        gonio_i_to_world(&p->frame, local, world);
        turn(-v->options->environment_turn, world, own);
        add_from_environment(v, p, own, gonio_i_surface_density(v->sampler, local, p->outgoing),
                             sum);
    }
}

/* ---- pixels ---- */

enum {
    NUMBERS = 7
}; /* random ones of a sample: 2 in the pixel, 2 of the environment, 3 of the BRDF */

static void shade(const view *v, const gonio_i_hit *hit, const double direction[3],
                  const double uniform[5], double sum[3])
{
    place p = {.hit = hit, .frame = gonio_i_frame_about(hit->normal)};
    const double back[3] = {-direction[0], -direction[1], -direction[2]};
    gonio_i_to_local(&p.frame, back, p.outgoing);
    if (p.outgoing[2] <= 0.0) {
        return;
    }
    if (v->options->environment != NULL) {
        add_environment(v, &p, uniform, sum);
    } else {
        add_lamp(v, &p, sum);
    }
}

static void show_environment(const view *v, const double direction[3], double sum[3])
{
    double own[3];
    double light[3];
    turn(-v->options->environment_turn, direction, own);
    gonio_i_environment_shown(v->options->environment, own, light);
    gonio_i_along(sum, 1.0, light, sum);
}

/* Every sample draws the same count of numbers, whatever the ray meets, so that materials rendered
 * with the same sampling share their noise. */
static void render_pixel(const view *v, int x, int y, float rgba[GONIO_IMAGE_CHANNELS])
{
    gonio_i_random random;
    const int samples = v->options->samples;
    const bool background = v->options->environment != NULL && v->options->show_environment;
    double sum[3] = {0.0, 0.0, 0.0};
    int covered = 0;
    gonio_i_random_seed(&random, v->options->seed, (uint64_t)y * GONIO_MOST_PIXELS + (uint64_t)x);
    for (int s = 0; s < samples; s++) {
        double uniform[NUMBERS];
        double origin[3];
        double direction[3];
        gonio_i_hit hit;
        for (int k = 0; k < NUMBERS; k++) {
            uniform[k] = gonio_i_random_uniform(&random);
        }
        camera_ray(&v->camera, x + uniform[0], y + uniform[1], origin, direction);
        if (gonio_i_scene_trace(v->scene, origin, direction, &hit)) {
            shade(v, &hit, direction, uniform + 2, sum);
            covered++;
        } else if (background) {
            show_environment(v, direction, sum);
            covered++;
        }
    }
    for (int k = 0; k < 3; k++) {
        rgba[k] = (float)(sum[k] / samples);
    }
    rgba[3] = (float)covered / (float)samples;
}

static gonio_status render_rows(gonio_context *context, const view *v, gonio_image *image)
{
    gonio_status status = GONIO_OK;
    int finished = 0;
    const int threads = gonio_context_threads(context);
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (int y = 0; y < image->height; y++) {
        gonio_status mine;
#pragma omp atomic read
        mine = status;
        for (int x = 0; x < image->width && mine == GONIO_OK; x++) {
            render_pixel(v, x, y,
                         image->rgba +
                             ((size_t)y * (size_t)image->width + (size_t)x) * GONIO_IMAGE_CHANNELS);
        }
        int done;
#pragma omp atomic capture
        done = ++finished;
        if (mine == GONIO_OK) {
            mine = gonio_i_progress(context, "rendering", (double)done / image->height);
        }
        if (mine != GONIO_OK) {
#pragma omp atomic write
            status = mine;
        }
    }
    return status;
}

/* ---- a whole rendering ---- */

static gonio_status check(gonio_context *context, const gonio_render_options *o)
{
    const double distance = gonio_i_length(o->lamp_position);
    if (o->samples < 1) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "%d samples a pixel: at least 1",
                            o->samples);
    }
    if (!(o->field_of_view >= 0.0 && o->field_of_view <= 2.0) || !isfinite(o->azimuth) ||
        !isfinite(o->elevation) || !isfinite(o->environment_turn)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "no view: the field of view must be 0 to 2 rad, angles finite");
    }
    if (o->environment == NULL && (!isfinite(distance) || distance == 0.0 ||
                                   (o->lamp == GONIO_LAMP_POINT && distance <= 1.0))) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "no lamp: its position must be finite and not the origin, that of a "
                            "point farther away than 1, the radius of the object");
    }
    return GONIO_OK;
}

gonio_status gonio_i_render_surface(gonio_context *context, const gonio_i_surface *surface,
                                    const gonio_i_surface *sampler,
                                    const gonio_render_options *options, gonio_image **image)
{
    gonio_i_scene *scene = NULL;
    gonio_image *made = NULL;
    gonio_status status = check(context, options);
    if (status == GONIO_OK) {
        status = gonio_image_create(context, options->width, options->height, &made);
    }
    if (status == GONIO_OK) {
        status = gonio_i_scene_create(context, options->mesh, &scene);
    }
    if (status == GONIO_OK) {
        const view v = {options, scene, surface, sampler, place_camera(options)};
        status = render_rows(context, &v, made);
    }
    gonio_i_scene_free(&scene);
    if (status != GONIO_OK) {
        gonio_image_free(&made);
        return status;
    }
    *image = made;
    return GONIO_OK;
}

gonio_status gonio_render(gonio_context *context, const gonio_material *material,
                          const gonio_render_options *options, gonio_image **image)
{
    gonio_render_options defaults;
    gonio_render_options_default(&defaults);
    options = options != NULL ? options : &defaults;
    gonio_i_surface *surface = NULL;
    gonio_i_surface *sampler = NULL;
    gonio_status status = check(context, options);
    if (status == GONIO_OK) {
        status = gonio_i_surface_create(context, material, &surface);
    }
    if (status == GONIO_OK && options->sample_like != NULL && options->environment != NULL) {
        status = gonio_i_surface_create(context, options->sample_like, &sampler);
    }
    if (status == GONIO_OK) {
        status = gonio_i_render_surface(context, surface, sampler != NULL ? sampler : surface,
                                        options, image);
    }
    gonio_i_surface_free(&sampler);
    gonio_i_surface_free(&surface);
    return status;
}

/* ---- two materials ---- */

gonio_status gonio_compare_rendered(gonio_context *context, const gonio_material *reference,
                                    const gonio_material *other, gonio_image_error *error)
{
    gonio_render_options options;
    gonio_render_options_default(&options);
    options.width = options.height = 256;
    options.sample_like = reference;
    gonio_environment *studio = NULL;
    gonio_image *first = NULL;
    gonio_image *second = NULL;
    gonio_status status = gonio_environment_open(context, "studio", false, &studio);
    options.environment = studio;
    if (status == GONIO_OK) {
        status = gonio_render(context, reference, &options, &first);
    }
    if (status == GONIO_OK) {
        status = gonio_render(context, other, &options, &second);
    }
    if (status == GONIO_OK) {
        const gonio_tone tone = gonio_tone_measure(first, 0.18);
        status = gonio_image_compare(context, first, second, &tone, error, NULL);
    }
    gonio_image_free(&first);
    gonio_image_free(&second);
    gonio_environment_free(&studio);
    return status;
}
