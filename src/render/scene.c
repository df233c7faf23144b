/* Ray tracing by Embree: see scene.h. */
#include "scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "embree_library.h"
#include "geometry.h"
#include "mesh.h"

/* The distance from the surface at which a ray begins. The object has radius 1. */
static const double away = 1e-4;

struct gonio_i_scene {
    RTCDevice device;
    RTCScene scene;
    const gonio_mesh *mesh;
};

void gonio_i_scene_free(gonio_i_scene **scene)
{
    if (scene == NULL || *scene == NULL) {
        return;
    }
    if ((*scene)->scene != NULL) {
        rtcReleaseScene((*scene)->scene);
    }
    if ((*scene)->device != NULL) {
        rtcReleaseDevice((*scene)->device);
    }
    free(*scene);
    *scene = NULL;
}

/* ---- geometry ---- */

static bool fill(RTCGeometry geometry, enum RTCBufferType type, enum RTCFormat format, size_t item,
                 size_t count, const void *data)
{
    void *buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, item, count);
    if (buffer != NULL) {
        memcpy(buffer, data, item * count);
    }
    return buffer != NULL;
}

static bool fill_geometry(RTCGeometry geometry, const gonio_mesh *mesh)
{
    static const float sphere[4] = {0.0F, 0.0F, 0.0F, 1.0F};
    if (mesh == NULL) {
        return fill(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, sizeof sphere, 1, sphere);
    }
    return fill(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                mesh->corners, mesh->position) &&
           fill(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                mesh->triangles, mesh->corner);
}

static bool build(gonio_i_scene *s)
{
    RTCGeometry geometry = rtcNewGeometry(
        s->device, s->mesh == NULL ? RTC_GEOMETRY_TYPE_SPHERE_POINT : RTC_GEOMETRY_TYPE_TRIANGLE);
    if (geometry == NULL) {
        return false;
    }
    const bool filled = fill_geometry(geometry, s->mesh);
    if (filled) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(s->scene, geometry);
        rtcSetSceneFlags(s->scene, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(s->scene);
    }
    rtcReleaseGeometry(geometry);
    return filled && rtcGetDeviceError(s->device) == RTC_ERROR_NONE;
}

/* One thread builds the tree. So the tree does not depend on the number of threads, nor does the
 * face to which an edge belongs. */
gonio_status gonio_i_scene_create(gonio_context *context, const gonio_mesh *mesh,
                                  gonio_i_scene **scene)
{
    const gonio_status status = gonio_i_embree_load(context);
    gonio_i_scene *made = status == GONIO_OK ? gonio_i_allocate(context, 1, sizeof *made) : NULL;
    if (made == NULL) {
        return status == GONIO_OK ? GONIO_ERROR_MEMORY : status;
    }
    made->mesh = mesh;
    made->device = rtcNewDevice("threads=1,set_affinity=0,verbose=0");
    made->scene = made->device != NULL ? rtcNewScene(made->device) : NULL;
    if (made->scene == NULL || !build(made)) {
        const enum RTCError error = rtcGetDeviceError(made->device);
        gonio_i_scene_free(&made);
        return gonio_i_fail(
            context, GONIO_ERROR_MEMORY, "the object cannot be prepared for rays: %s",
            error == RTC_ERROR_UNSUPPORTED_CPU ? "the processor lacks SSE2" : "out of memory");
    }
    *scene = made;
    return GONIO_OK;
}

/* ---- rays ---- */

static struct RTCRay ray_from(const double origin[3], const double direction[3], double distance)
{
    return (struct RTCRay){.org_x = (float)origin[0],
                           .org_y = (float)origin[1],
                           .org_z = (float)origin[2],
                           .dir_x = (float)direction[0],
                           .dir_y = (float)direction[1],
                           .dir_z = (float)direction[2],
                           .tfar = (float)distance,
                           .mask = UINT32_MAX};
}

static void orient_towards(const double side[3], double v[3])
{
    const double sign = gonio_i_dot3(side, v) < 0.0 ? -1.0 : 1.0;
    for (int k = 0; k < 3; k++) {
        v[k] *= sign;
    }
}

/* Interpolates the normal between the corners. Where they cancel out, it is that of the face. */
static void interpolate_normal(const gonio_mesh *mesh, const struct RTCHit *hit,
                               gonio_i_hit *result)
{
    const uint32_t *corner = mesh->corner + 3 * (size_t)hit->primID;
    const double weight[3] = {1.0 - (double)hit->u - (double)hit->v, (double)hit->u,
                              (double)hit->v};
    for (int k = 0; k < 3; k++) {
        result->normal[k] = 0.0;
        for (int c = 0; c < 3; c++) {
            result->normal[k] += weight[c] * (double)mesh->normal[3 * (size_t)corner[c] + k];
        }
    }
    if (gonio_i_length(result->normal) < 1e-3) {
        memcpy(result->normal, result->face, sizeof result->normal);
    }
    gonio_i_normalise(result->normal);
}

bool gonio_i_scene_trace(const gonio_i_scene *scene, const double origin[3],
                         const double direction[3], gonio_i_hit *hit)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    struct RTCRayHit found = {.ray = ray_from(origin, direction, INFINITY),
                              .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    rtcIntersect1(scene->scene, &context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return false;
    }
    const double back[3] = {-direction[0], -direction[1], -direction[2]};
    gonio_i_along(origin, (double)found.ray.tfar, direction, hit->point);
    hit->face[0] = (double)found.hit.Ng_x;
    hit->face[1] = (double)found.hit.Ng_y;
    hit->face[2] = (double)found.hit.Ng_z;
    gonio_i_normalise(hit->face);
    orient_towards(back, hit->face);
    if (scene->mesh == NULL) {
        memcpy(hit->normal, hit->face, sizeof hit->normal);
        return true;
    }
    interpolate_normal(scene->mesh, &found.hit, hit);
    orient_towards(hit->face, hit->normal);
    if (gonio_i_dot3(hit->normal, back) <= 0.0) { /* at the rim of a coarse mesh */
        memcpy(hit->normal, hit->face, sizeof hit->normal);
    }
    return true;
}

/* A sphere casts no shadow on its own lit side. */
bool gonio_i_scene_is_free(const gonio_i_scene *scene, const gonio_i_hit *hit,
                           const double direction[3], double distance)
{
    if (scene->mesh == NULL) {
        return true;
    }
    double origin[3];
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    gonio_i_along(hit->point, away, hit->face, origin);
    struct RTCRay ray = ray_from(origin, direction, distance);
    rtcOccluded1(scene->scene, &context, &ray);
    return ray.tfar >= 0.0F;
}
