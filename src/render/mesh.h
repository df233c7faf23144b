/* Meshes inside the library, and what their readers fill in. */
#ifndef GONIO_RENDER_MESH_H
#define GONIO_RENDER_MESH_H

#include <gonio/render.h>

#include "image.h"

struct gonio_mesh {
    size_t corners, triangles;
    float *position;  /* [corners][3], within the unit sphere */
    float *normal;    /* [corners][3], unit or zero where the faces cancel out */
    uint32_t *corner; /* [triangles][3] */
};

/* A mesh that is being read. */
typedef struct gonio_i_mesh_making {
    gonio_context *context;
    const char *path; /* for messages */
    gonio_mesh *mesh;
    size_t corner_room, triangle_room;
    size_t flat;       /* number of triangles without area, which are left out */
    bool with_normals; /* every corner has a normal */
    uint32_t *polygon; /* [polygon_count], of the face that is being read */
    size_t polygon_count, polygon_room;
    size_t comparisons; /* that dividing polygons took so far */
} gonio_i_mesh_making;

/* Adds a corner; normal is NULL where there is none. Errors: _DATA if it is not finite, _MEMORY. */
gonio_status gonio_i_mesh_add_corner(gonio_i_mesh_making *making, const float position[3],
                                     const float *normal);

/* Adds a triangle of existing corners. Errors: _FORMAT if one does not exist, _MEMORY. */
gonio_status gonio_i_mesh_add_triangle(gonio_i_mesh_making *making, const uint32_t corner[3]);

/* Adds a face of existing corners, one by one. _end divides it into triangles; fewer than three
 * corners are none. Errors: as above. */
gonio_status gonio_i_mesh_add_to_polygon(gonio_i_mesh_making *making, uint32_t corner);
gonio_status gonio_i_mesh_end_polygon(gonio_i_mesh_making *making);

/* The readers. Errors: _FORMAT, and those above. */
gonio_status gonio_i_read_obj(gonio_i_mesh_making *making, const gonio_i_bytes *bytes);
gonio_status gonio_i_read_ply(gonio_i_mesh_making *making, const gonio_i_bytes *bytes);

/* Makes a flat square sample that faces +z, within the unit sphere. Errors: _MEMORY. */
gonio_status gonio_i_mesh_flat(gonio_context *context, gonio_mesh **mesh);

/* So many lines, elements or corners are read or made between two reports of progress. */
enum { GONIO_I_MESH_PROGRESS = 1 << 14 };

/* Makes normals for a mesh without. The normal at a corner of a triangle is the mean, weighted by
 * area, of the faces around the corner that are within 50 degrees of the triangle; that of the
 * triangle alone where tens of thousands of triangles meet at a corner, which would take too long.
 * Corners are no longer shared afterwards. Errors: _MEMORY, _CANCELLED. */
gonio_status gonio_i_mesh_make_normals(gonio_context *context, gonio_mesh *mesh);

#endif
