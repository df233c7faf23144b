/* Rendering: direct light from a lamp or an environment, for every pixel. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "../core/options.h"
#include "../core/random.h"
#include "environment.h"
#include "geometry.h"
#include "mesh.h"
#include "scene.h"
#include "surface.h"

/* ---- the camera ---- */

typedef struct camera {
    gonio_i_frame frame; /* z: from the object to the viewer */
    double distance;     /* of the viewer from the object; 0 for parallel rays */
    double half_side;    /* of the shorter side: a slope, or for parallel rays a length */
    int width, height;
} camera;

static const double share = 0.95; /* of the shorter side: the unit sphere fills it */

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
    double turn_cosine, turn_sine; /* of the environment */
    bool tangents;                 /* frames follow the tangents */
} view;

/* Rotates a direction about y: from the world to the environment's frame (sign 1) or back (-1). */
static void turn(const view *v, double sign, const double from[3], double to[3])
{
    const double sine = sign * v->turn_sine;
    const double rotated[3] = {v->turn_cosine * from[0] - sine * from[2], from[1],
                               sine * from[0] + v->turn_cosine * from[2]};
    memcpy(to, rotated, sizeof rotated);
}

/* A place on the object that is being shaded. */
typedef struct place {
    const gonio_i_hit *hit;
    gonio_i_frame frame; /* about the normal */
    double outgoing[3];  /* in the frame */
} place;

/* Whether light from a direction (in the world) at a distance reaches the place. */
static bool arrives(const view *v, const place *p, const double world[3], double distance)
{
    return gonio_i_dot3(p->frame.z, world) > 0.0 && gonio_i_dot3(p->hit->face, world) > 0.0 &&
           gonio_i_scene_is_free(v->scene, p->hit, world, distance);
}

/* Adds reflected light: the BRDF times the cosine times the light. */
static void add_light(const view *v, const gonio_i_meeting *meeting, const double light[3],
                      double factor, double sum[3])
{
    double rho[GONIO_CHANNELS];
    gonio_i_surface_value(v->surface, meeting, rho);
    for (int k = 0; k < 3; k++) {
        sum[k] += rho[k] * meeting->incident * light[k] * factor;
    }
}

/* Adds the light of the lamp. Its irradiance at the origin, facing it, is pi. */
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
        strength *= gonio_i_dot3(o->lamp_position, o->lamp_position) / (distance * distance);
    }
    gonio_i_normalise(direction);
    if (arrives(v, p, direction, distance)) {
        const double light[3] = {strength, strength, strength};
        double incident[3];
        gonio_i_to_local(&p->frame, direction, incident);
        const gonio_i_meeting meeting = gonio_i_meet(incident, p->outgoing);
        add_light(v, &meeting, light, 1.0, sum);
    }
}

/* Adds the light from one direction by the balance heuristic: one direction is sampled from the
 * BRDF and one from the environment, and each is divided by the sum of both densities. `own` is in
 * the environment's frame. */
static void add_from_environment(const view *v, const place *p, const double own[3],
                                 const double world[3], const double incident[3], double sum[3])
{
    double light[3];
    double density;
    if (arrives(v, p, world, INFINITY)) {
        const gonio_i_meeting meeting = gonio_i_meet(incident, p->outgoing);
        gonio_i_environment_look(v->options->environment, own, light, &density);
        density += gonio_i_surface_density(v->sampler, &meeting);
        add_light(v, &meeting, light, 1.0 / density, sum);
    }
}

static void add_environment(const view *v, const place *p, const double uniform[5], double sum[3])
{
    double own[3];
    double world[3];
    double local[3];
    gonio_i_environment_sample(v->options->environment, uniform, own);
    turn(v, 1.0, own, world);
    gonio_i_to_local(&p->frame, world, local);
    if (local[2] > 0.0) {
        add_from_environment(v, p, own, world, local, sum);
    }
    if (gonio_i_surface_sample(v->sampler, p->outgoing, uniform + 2, local)) {
        gonio_i_to_world(&p->frame, local, world);
        turn(v, -1.0, world, own);
        add_from_environment(v, p, own, world, local, sum);
    }
}

/* ---- pixels ---- */

enum {
    NUMBERS = 7
}; /* random ones of a sample: 2 in the pixel, 2 of the environment, 3 of the BRDF */

static void shade(const view *v, const gonio_i_hit *hit, const double direction[3],
                  const double uniform[5], double sum[3])
{
    place p = {.hit = hit,
               .frame = v->tangents ? gonio_i_frame_along(hit->normal, v->options->grain)
                                    : gonio_i_frame_about(hit->normal)};
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
    turn(v, -1.0, direction, own);
    gonio_i_environment_shown(v->options->environment, own, light);
    gonio_i_along(sum, 1.0, light, sum);
}

/* The samples of a pixel: an even lattice of points, shifted at random for each pixel,
 * frac(shift + n g^-k) with g^8 = g + 1 (Roberts 2018; the shift by Cranley and Patterson 1976).
 * Samples do not depend on what the rays meet. So materials that are rendered with the same
 * sampling share their noise. */
typedef struct lattice {
    double number[NUMBERS], step[NUMBERS];
} lattice;

static lattice begin_lattice(uint64_t seed, int x, int y)
{
    const double g = 1.0969815577985598;
    lattice l;
    gonio_i_random random;
    gonio_i_random_seed(&random, seed, (uint64_t)y * GONIO_MOST_PIXELS + (uint64_t)x);
    double step = 1.0;
    for (int k = 0; k < NUMBERS; k++) {
        step /= g;
        l.step[k] = step;
        l.number[k] = gonio_i_random_uniform(&random);
    }
    return l;
}

static void next_point(lattice *l)
{
    for (int k = 0; k < NUMBERS; k++) {
        l->number[k] += l->step[k];
        l->number[k] -= l->number[k] >= 1.0 ? 1.0 : 0.0;
    }
}

static void render_pixel(const view *v, int x, int y, float rgba[GONIO_IMAGE_CHANNELS])
{
    lattice points = begin_lattice(v->options->seed, x, y);
    const double *uniform = points.number;
    const int samples = v->options->samples;
    const bool background = v->options->environment != NULL && v->options->show_environment;
    double sum[3] = {0.0, 0.0, 0.0};
    int covered = 0;
    for (int s = 0; s < samples; s++, next_point(&points)) {
        double origin[3];
        double direction[3];
        gonio_i_hit hit;
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

static gonio_status render_rows(gonio_context *context, int threads, const view *v,
                                gonio_image *image)
{
    gonio_status status = GONIO_OK;
    int finished = 0;
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
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%d samples a pixel are too few: at least 1 is needed", o->samples);
    }
    if (!(o->field_of_view >= 0.0 && o->field_of_view <= 2.0) || !isfinite(o->azimuth) ||
        !isfinite(o->elevation) || !isfinite(o->environment_turn) || !isfinite(o->grain)) {
        return gonio_i_fail(
            context, GONIO_ERROR_ARGUMENT,
            "invalid view: the field of view must be 0 to 2 rad, the angles finite");
    }
    if (o->environment == NULL && (!isfinite(distance) || distance == 0.0 ||
                                   (o->lamp == GONIO_LAMP_POINT && distance <= 1.0))) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "invalid lamp: its position must be finite and not the origin; a point "
                            "lamp must be farther than 1, the radius of the object");
    }
    return GONIO_OK;
}

static gonio_status render_surface(gonio_context *context, const gonio_i_surface *surface,
                                   const gonio_i_surface *sampler,
                                   const gonio_render_options *options, gonio_image **image)
{
    gonio_i_scene *scene = NULL;
    gonio_image *made = NULL;
    gonio_mesh *flat = NULL;
    gonio_status status = check(context, options);
    if (status == GONIO_OK) {
        status = gonio_image_create(context, options->width, options->height, &made);
    }
    if (status == GONIO_OK && options->flat && options->mesh == NULL) {
        status = gonio_i_mesh_flat(context, &flat);
    }
    if (status == GONIO_OK) {
        status = gonio_i_scene_create(context, flat != NULL ? flat : options->mesh, &scene);
    }
    if (status == GONIO_OK) {
        const view v = {.options = options,
                        .scene = scene,
                        .surface = surface,
                        .sampler = sampler,
                        .camera = place_camera(options),
                        .tangents = gonio_i_surface_is_anisotropic(surface),
                        .turn_cosine = cos(options->environment_turn),
                        .turn_sine = sin(options->environment_turn)};
        status = render_rows(context, gonio_context_threads(context), &v, made);
    }
    gonio_i_scene_free(&scene);
    gonio_mesh_free(&flat);
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
    gonio_render_options how;
    gonio_i_surface *surface = NULL;
    gonio_status status = GONIO_I_TAKE(context, gonio_render_options, options, &how);
    if (status == GONIO_OK) {
        status = check(context, &how);
    }
    if (status == GONIO_OK) {
        status = gonio_i_surface_create(context, material, &surface);
    }
    if (status == GONIO_OK) {
        status = render_surface(context, surface, surface, &how, image);
    }
    gonio_i_surface_free(&surface);
    return status;
}

/* ---- a material and others ---- */

struct gonio_reference {
    gonio_render_options options;
    gonio_environment *environment; /* the reference's own; NULL if it is the caller's */
    gonio_i_surface *surface;
    gonio_image *image;
    gonio_tone tone;
};

void gonio_reference_free(gonio_reference **reference)
{
    if (reference == NULL || *reference == NULL) {
        return;
    }
    gonio_environment_free(&(*reference)->environment);
    gonio_i_surface_free(&(*reference)->surface);
    gonio_image_free(&(*reference)->image);
    free(*reference);
    *reference = NULL;
}

static gonio_status set_yardstick(gonio_context *context, gonio_reference *reference)
{
    reference->options.width = reference->options.height = 256;
    const gonio_status status =
        gonio_environment_open(context, "studio", false, &reference->environment);
    reference->options.environment = reference->environment;
    return status;
}

gonio_status gonio_reference_create(gonio_context *context, const gonio_material *material,
                                    const gonio_render_options *options,
                                    gonio_reference **reference)
{
    gonio_reference *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = GONIO_I_TAKE(context, gonio_render_options, options, &made->options);
    if (options == NULL) {
        status = set_yardstick(context, made);
    }
    if (status == GONIO_OK) {
        status = check(context, &made->options);
    }
    if (status == GONIO_OK) {
        status = gonio_i_surface_create(context, material, &made->surface);
    }
    if (status == GONIO_OK) {
        status =
            render_surface(context, made->surface, made->surface, &made->options, &made->image);
    }
    if (status != GONIO_OK) {
        gonio_reference_free(&made);
        return status;
    }
    made->tone = gonio_tone_measure(made->image, 0.18);
    *reference = made;
    return GONIO_OK;
}

const gonio_image *gonio_reference_image(const gonio_reference *reference)
{
    return reference->image;
}

gonio_tone gonio_reference_tone(const gonio_reference *reference)
{
    return reference->tone;
}

gonio_status gonio_reference_render(gonio_context *context, const gonio_reference *reference,
                                    const gonio_material *other, gonio_image **image)
{
    gonio_i_surface *surface = NULL;
    gonio_status status = gonio_i_surface_create(context, other, &surface);
    if (status == GONIO_OK) {
        status = render_surface(context, surface, reference->surface, &reference->options, image);
    }
    gonio_i_surface_free(&surface);
    return status;
}

gonio_status gonio_reference_compare(gonio_context *context, const gonio_reference *reference,
                                     const gonio_material *other, gonio_image_error *error)
{
    gonio_image *image = NULL;
    gonio_status status = gonio_reference_render(context, reference, other, &image);
    if (status == GONIO_OK) {
        status =
            gonio_image_compare(context, reference->image, image, &reference->tone, error, NULL);
    }
    gonio_image_free(&image);
    return status;
}
