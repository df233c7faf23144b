/* Meshes: OBJ and PLY. */
#include "../support.h"

#include <gonio/gonio.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "render_fixture.h"

static const char binary_ply[] = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
                                 "property float x\nproperty float y\nproperty float z\n"
                                 "element face 1\nproperty list uchar int vertex_indices\n"
                                 "end_header\n"
                                 "\0\0\0\0\0\0\0\0\0\0\0\0"     /* 0 0 0 */
                                 "\0\0\x80\x3f\0\0\0\0\0\0\0\0" /* 1 0 0 */
                                 "\0\0\0\0\0\0\x80\x3f\0\0\0\0" /* 0 1 0 */
                                 "\3\0\0\0\0\1\0\0\0\2\0\0\0";

static void meshes_are_read(void **state)
{
    (void)state;
    static const char obj[] = "# a square and a flat triangle\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                              "f 1 2 3 4\nf 1 2 2\n";
    static const char ply[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                              "property float y\nproperty float z\nelement face 1\n"
                              "property list uchar int vertex_indices\nend_header\n"
                              "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    gonio_mesh *mesh = NULL;
    assert_int_equal(read_mesh(obj, sizeof obj - 1, &mesh), GONIO_OK);
    assert_int_equal(gonio_mesh_triangles(mesh), 2);
    gonio_mesh_free(&mesh);
    assert_int_equal(read_mesh(ply, sizeof ply - 1, &mesh), GONIO_OK);
    assert_int_equal(gonio_mesh_triangles(mesh), 1);
    gonio_mesh_free(&mesh);
    assert_int_equal(read_mesh(binary_ply, sizeof binary_ply - 1, &mesh), GONIO_OK);
    assert_int_equal(gonio_mesh_triangles(mesh), 1);
    assert_int_equal(gonio_mesh_corners(mesh), 3);
    gonio_mesh_free(&mesh);
}

/* Whatever the unit, corners are joined only where they are the same. Materials are not read. */
static void small_objs_are_read(void **state)
{
    (void)state;
    static const char obj[] = "mtllib 0\nmap_Pr\n  mtllib \\\n v\nusemtl x\n"
                              "v 0 0 0\nv 1e-6 0 0\nv 1e-6 1e-6 0\nv 0 1e-6 0\n"
                              "f 1 2 3\nf 1 3 4\n";
    gonio_mesh *mesh = NULL;
    assert_int_equal(read_mesh(obj, sizeof obj - 1, &mesh), GONIO_OK);
    assert_int_equal(gonio_mesh_triangles(mesh), 2);
    assert_true(gonio_mesh_corners(mesh) >= 4);
    gonio_mesh_free(&mesh);
    assert_int_equal(read_mesh("v 0 0 0\nmtllib 0\nmap_Pr", 23, &mesh), GONIO_ERROR_FORMAT);
}

static void damaged_meshes_are_refused(void **state)
{
    (void)state;
    gonio_mesh *mesh = NULL;
    static const char *const bad[] = {
        "v 0 0 0\nv 1 0 0\nv 0 1 0\n",                    /* no faces */
        "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n",           /* no extent */
        "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n",         /* not finite */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n",           /* no such corner */
        "ply\nformat ascii 1.0\nelement vertex 9\nend\n", /* no end */
        "solid cube\n",                                   /* STL */
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        const gonio_status status = read_mesh(bad[k], strlen(bad[k]), &mesh);
        if (status != GONIO_ERROR_DATA && status != GONIO_ERROR_FORMAT) {
            fail_msg("mesh %zu: status %d", k, status);
        }
        assert_null(mesh);
    }
    /* Cut anywhere: read or refused, but nothing else. */
    for (size_t size = 1; size < sizeof binary_ply - 1; size++) {
        if (read_mesh(binary_ply, size, &mesh) == GONIO_OK) {
            gonio_mesh_free(&mesh);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes_are_read),
        cmocka_unit_test(small_objs_are_read),
        cmocka_unit_test(damaged_meshes_are_refused),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
