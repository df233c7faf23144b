/* Polygons of a mesh in triangles: fans where they are convex, otherwise ears cut off one by one
 * (Meisters 1975), seen along the polygon's mean normal. */
#include <math.h>
#include <stdlib.h>

#include "geometry.h"
#include "mesh.h"

/* Comparisons that cutting ears may take in all faces of a mesh: some seconds. */
static const size_t patience = 400000000;

/* A polygon seen along its normal: its corners in that plane, counter-clockwise. */
typedef struct outline {
    double (*at)[2]; /* of all corners */
    size_t *left;    /* [count], those that are not cut off yet */
    size_t count;
} outline;

gonio_status gonio_i_mesh_add_to_polygon(gonio_i_mesh_making *making, uint32_t corner)
{
    if (corner >= making->mesh->corners) {
        return gonio_i_fail(making->context, GONIO_ERROR_FORMAT,
                            "%s: a face names a corner that does not exist", making->path);
    }
    if (making->polygon_count == making->polygon_room) {
        const size_t room = making->polygon_room > 0 ? 2 * making->polygon_room : 64;
        uint32_t *larger = reallocarray(making->polygon, room, sizeof *larger);
        if (larger == NULL) {
            return gonio_i_fail(making->context, GONIO_ERROR_MEMORY, "%s: too large: out of memory",
                                making->path);
        }
        making->polygon = larger;
        making->polygon_room = room;
    }
    making->polygon[making->polygon_count++] = corner;
    return GONIO_OK;
}

/* ---- the plane ---- */

static const float *position_of(const gonio_i_mesh_making *m, size_t k)
{
    return m->mesh->position + 3 * (size_t)m->polygon[k];
}

/* Newell's sum over the edges, as long as twice the area. */
static void mean_normal(const gonio_i_mesh_making *m, double normal[3])
{
    const float *origin = position_of(m, 0);
    normal[0] = normal[1] = normal[2] = 0.0;
    for (size_t k = 0; k < m->polygon_count; k++) {
        const float *p = position_of(m, k);
        const float *q = position_of(m, (k + 1) % m->polygon_count);
        double a[3];
        double b[3];
        for (int c = 0; c < 3; c++) {
            a[c] = (double)p[c] - (double)origin[c];
            b[c] = (double)q[c] - (double)origin[c];
        }
        normal[0] += a[1] * b[2] - a[2] * b[1];
        normal[1] += a[2] * b[0] - a[0] * b[2];
        normal[2] += a[0] * b[1] - a[1] * b[0];
    }
}

/* Leaves out the axis that the normal is closest to; the others are in an order that keeps the
 * sense of rotation. */
static void project(const gonio_i_mesh_making *m, const double normal[3], double (*at)[2])
{
    int axis = fabs(normal[1]) > fabs(normal[0]) ? 1 : 0;
    axis = fabs(normal[2]) > fabs(normal[axis]) ? 2 : axis;
    const int first = (axis + (normal[axis] < 0.0 ? 2 : 1)) % 3;
    const int second = (axis + (normal[axis] < 0.0 ? 1 : 2)) % 3;
    for (size_t k = 0; k < m->polygon_count; k++) {
        at[k][0] = (double)position_of(m, k)[first];
        at[k][1] = (double)position_of(m, k)[second];
    }
}

/* Twice the area of a triangle: positive if it is counter-clockwise. */
static double area_of(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* ---- triangles ---- */

static gonio_status add_triangle(gonio_i_mesh_making *m, size_t a, size_t b, size_t c)
{
    const uint32_t corner[3] = {m->polygon[a], m->polygon[b], m->polygon[c]};
    return gonio_i_mesh_add_triangle(m, corner);
}

static gonio_status add_fan(gonio_i_mesh_making *m)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 2; k < m->polygon_count && status == GONIO_OK; k++) {
        status = add_triangle(m, 0, k - 1, k);
    }
    return status;
}

/* Whether a fan about the first corner covers a polygon without turning back. */
static bool is_fan(const outline *o)
{
    bool fan = true;
    for (size_t k = 2; k < o->count && fan; k++) {
        fan = area_of(o->at[0], o->at[k - 1], o->at[k]) >= 0.0;
    }
    return fan;
}

/* Whether the corner number k of those left can be cut off: it is convex, and no other is in its
 * triangle. */
static bool is_ear(gonio_i_mesh_making *m, const outline *o, size_t k)
{
    const double *a = o->at[o->left[(k + o->count - 1) % o->count]];
    const double *b = o->at[o->left[k]];
    const double *c = o->at[o->left[(k + 1) % o->count]];
    bool ear = area_of(a, b, c) > 0.0;
    for (size_t j = 0; j < o->count && ear; j++) {
        const double *p = o->at[o->left[j]];
        const bool own = (p[0] == a[0] && p[1] == a[1]) || (p[0] == b[0] && p[1] == b[1]) ||
                         (p[0] == c[0] && p[1] == c[1]);
        m->comparisons++;
        ear = own || area_of(a, b, p) < 0.0 || area_of(b, c, p) < 0.0 || area_of(c, a, p) < 0.0;
    }
    return ear;
}

static gonio_status cut(gonio_i_mesh_making *m, outline *o, size_t k)
{
    const gonio_status status = add_triangle(m, o->left[(k + o->count - 1) % o->count], o->left[k],
                                             o->left[(k + 1) % o->count]);
    o->count--;
    for (; k < o->count; k++) {
        o->left[k] = o->left[k + 1];
    }
    return status;
}

/* Where a damaged polygon has no ear, the next corner is cut off all the same. */
static gonio_status cut_ears(gonio_i_mesh_making *m, outline *o)
{
    gonio_status status = GONIO_OK;
    size_t from = 1;
    for (size_t k = 0; k < o->count; k++) {
        o->left[k] = k;
    }
    while (o->count >= 3 && status == GONIO_OK) {
        size_t tried = 0;
        while (tried < o->count && m->comparisons < patience &&
               !is_ear(m, o, (from + tried) % o->count)) {
            tried++;
        }
        from = (from + tried) % o->count;
        status = cut(m, o, from);
    }
    return status;
}

static gonio_status add_polygon(gonio_i_mesh_making *m)
{
    double normal[3];
    outline o = {.count = m->polygon_count};
    o.at = gonio_i_allocate(m->context, o.count, sizeof *o.at);
    o.left = gonio_i_allocate(m->context, o.count, sizeof *o.left);
    gonio_status status = o.at != NULL && o.left != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        mean_normal(m, normal);
        project(m, normal, o.at);
        status = is_fan(&o) ? add_fan(m) : cut_ears(m, &o);
    }
    free(o.at);
    free(o.left);
    return status;
}

gonio_status gonio_i_mesh_end_polygon(gonio_i_mesh_making *making)
{
    gonio_status status = GONIO_OK;
    if (making->polygon_count == 3) {
        status = add_triangle(making, 0, 1, 2);
    } else if (making->polygon_count > 3) {
        status = add_polygon(making);
    }
    making->polygon_count = 0;
    return status;
}
