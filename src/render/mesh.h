/* Inside a mesh. */
#ifndef GONIO_RENDER_MESH_H
#define GONIO_RENDER_MESH_H

#include <gonio/render.h>

struct gonio_mesh {
    size_t corners, triangles;
    float *position;  /* [corners][3], within the unit sphere */
    float *normal;    /* [corners][3], unit or zero where the faces cancel out */
    uint32_t *corner; /* [triangles][3] */
};

#endif
