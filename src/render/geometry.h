/* Vectors of three. */
#ifndef GONIO_RENDER_GEOMETRY_H
#define GONIO_RENDER_GEOMETRY_H

#include <math.h>

static inline double gonio_i_dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double gonio_i_length(const double a[3])
{
    return sqrt(gonio_i_dot3(a, a));
}

/* a + s b; result may be a. */
static inline void gonio_i_along(const double a[3], double s, const double b[3], double result[3])
{
    for (int k = 0; k < 3; k++) {
        result[k] = a[k] + s * b[k];
    }
}

/* Scales a vector to length 1. A zero vector stays. */
static inline void gonio_i_normalise(double a[3])
{
    const double length = gonio_i_length(a);
    for (int k = 0; k < 3 && length > 0.0; k++) {
        a[k] /= length;
    }
}

/* An orthonormal frame: to_local gives coordinates in it, to_world goes back. */
typedef struct gonio_i_frame {
    double x[3], y[3], z[3];
} gonio_i_frame;

/* Any frame about a unit vector (Duff et al. 2017). */
static inline gonio_i_frame gonio_i_frame_about(const double z[3])
{
    const double sign = copysign(1.0, z[2]);
    const double a = -1.0 / (sign + z[2]);
    const double b = z[0] * z[1] * a;
    return (gonio_i_frame){{1.0 + sign * z[0] * z[0] * a, sign * b, -sign * z[0]},
                           {b, sign + z[1] * z[1] * a, -z[1]},
                           {z[0], z[1], z[2]}};
}

/* A frame about a unit vector whose x axis is horizontal, to the right of who looks at the surface
 * with y up, and then turned about z by an angle. Where z is upright any x will do. */
static inline gonio_i_frame gonio_i_frame_along(const double z[3], double angle)
{
    const double radius = sqrt(z[0] * z[0] + z[2] * z[2]);
    if (radius < 1e-9) {
        return gonio_i_frame_about(z);
    }
    const double right[3] = {z[2] / radius, 0.0, -z[0] / radius};
    const double up[3] = {z[1] * right[2], z[2] * right[0] - z[0] * right[2], -z[1] * right[0]};
    gonio_i_frame frame = {.z = {z[0], z[1], z[2]}};
    for (int k = 0; k < 3; k++) {
        frame.x[k] = cos(angle) * right[k] + sin(angle) * up[k];
        frame.y[k] = cos(angle) * up[k] - sin(angle) * right[k];
    }
    return frame;
}

static inline void gonio_i_to_local(const gonio_i_frame *frame, const double world[3],
                                    double local[3])
{
    local[0] = gonio_i_dot3(world, frame->x);
    local[1] = gonio_i_dot3(world, frame->y);
    local[2] = gonio_i_dot3(world, frame->z);
}

static inline void gonio_i_to_world(const gonio_i_frame *frame, const double local[3],
                                    double world[3])
{
    for (int k = 0; k < 3; k++) {
        world[k] = local[0] * frame->x[k] + local[1] * frame->y[k] + local[2] * frame->z[k];
    }
}

/* The luminance of linear BT.709 colours. */
static inline double gonio_i_luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

#endif
