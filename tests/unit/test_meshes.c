/* Meshes: OBJ and PLY. */
#include "../support.h"

#include <gonio/gonio.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/mesh.h"
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
    assert_int_equal(read_mesh("v 0 0 0\nmtllib 0\nmap_Pr", 23, &mesh), GONIO_ERROR_DATA);
}

/* Where a great many triangles share corners, each keeps its own normal: comparing all of them with
 * each other would take minutes. */
static void crowded_corners_are_read(void **state)
{
    (void)state;
    enum { FACES = 20000, LINE = 8 };
    static const char head[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0.5\n";
    const size_t size = sizeof head - 1 + (size_t)(FACES + 1) * LINE;
    char *obj = malloc(size + 1);
    gonio_mesh *mesh = NULL;
    assert_non_null(obj);
    strcpy(obj, head);
    for (size_t k = 0; k < FACES; k++) {
        strcpy(obj + sizeof head - 1 + k * LINE, "f 1 2 3\n");
    }
    strcpy(obj + size - LINE, "f 1 2 4\n");
    assert_int_equal(read_mesh(obj, size, &mesh), GONIO_OK);
    free(obj);
    const float *last = mesh->normal + 9 * (size_t)FACES;
    assert_true(fabsf(mesh->normal[2] - 1.0F) < 1e-3F);
    assert_true(fabsf(last[1] + 0.447214F) < 1e-5F);
    assert_true(fabsf(last[2] - 0.894427F) < 1e-5F);
    gonio_mesh_free(&mesh);
}

static double area_of(const gonio_mesh *mesh)
{
    double sum = 0.0;
    for (size_t t = 0; t < mesh->triangles; t++) {
        const float *p[3];
        double u[3];
        double v[3];
        for (int k = 0; k < 3; k++) {
            p[k] = mesh->position + 3 * (size_t)mesh->corner[3 * t + (size_t)k];
        }
        for (int k = 0; k < 3; k++) {
            u[k] = (double)p[1][k] - (double)p[0][k];
            v[k] = (double)p[2][k] - (double)p[0][k];
        }
        sum += 0.5 * hypot(hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2]),
                           u[0] * v[1] - u[1] * v[0]);
    }
    return sum;
}

/* Corners that stand behind their faces, counted backwards, repeated, with texture, normals, a
 * fourth number, a colour, in lines that go on, after a carriage return. */
static void objs_of_all_kinds_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t triangles, corners; /* without normals, three for each triangle */
    } kinds[] = {
        {"f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", 1, 3},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf 1 2 -1\n", 2, 6},
        {"v 0 0 0 2\nv 2 0 0 2\nv 0 2 0 2\nvn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1\nf 1//1 2//1 "
         "3//1\n",
         2, 3},
        {"v 0 0 0 1 0 0\r\nv 1 0 0 0 1 0\r\nv 0 1 0 0 0 1\r\nf 1/7 2/8 \\\r\n 3/9\r\n", 1, 3},
        {"  v 0 0 0\n\tv 1 0 0\nv 0 1 0\nl 1 2\np 1\nf 1 2\nf 1 2 3 # a face", 1, 3},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 1\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
         "f 1//1 2//1 3//1\nf 4//2 5//2 6//2\n",
         2, 4},
    };
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        gonio_mesh *mesh = NULL;
        assert_int_equal(read_mesh(kinds[k].text, strlen(kinds[k].text), &mesh), GONIO_OK);
        assert_int_equal(gonio_mesh_triangles(mesh), kinds[k].triangles);
        assert_int_equal(gonio_mesh_corners(mesh), kinds[k].corners);
        gonio_mesh_free(&mesh);
    }
}

/* Triangles of a concave polygon cover it: a star of ten corners, an L, in OBJ and PLY. */
static void concave_faces_are_covered(void **state)
{
    (void)state;
    static const char l_shape[] = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
                                  "f 3 4 5 6 1 2\n";
    static const char ply[] = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                              "property float y\nproperty float z\nelement face 1\n"
                              "property list uchar int vertex_indices\nend_header\n"
                              "0 0 -1\n0 3 3\n0 0 0\n0 -3 3\n4 1 2 3 0\n";
    char star[1024] = "";
    gonio_mesh *mesh = NULL;
    assert_int_equal(read_mesh(l_shape, sizeof l_shape - 1, &mesh), GONIO_OK);
    assert_int_equal(mesh->triangles, 4);
    assert_close(area_of(mesh), 3.0 / 2.0, 1e-5); /* scaled: the square's radius is sqrt(2) */
    gonio_mesh_free(&mesh);
    assert_int_equal(read_mesh(ply, sizeof ply - 1, &mesh), GONIO_OK);
    assert_int_equal(mesh->triangles, 2);
    assert_close(area_of(mesh), 3.0 / 13.0, 1e-5);
    gonio_mesh_free(&mesh);
    for (int k = 0; k < 10; k++) {
        const double radius = k % 2 == 0 ? 1.0 : 0.3;
        snprintf(star + strlen(star), sizeof star - strlen(star), "v %.9f %.9f 0\n",
                 radius * cos(0.2 * M_PI * k), radius * sin(0.2 * M_PI * k));
    }
    strcat(star, "f 2 3 4 5 6 7 8 9 10 1\n");
    assert_int_equal(read_mesh(star, strlen(star), &mesh), GONIO_OK);
    assert_int_equal(mesh->triangles, 8);
    const double centre = 0.5 * (1.0 + cos(0.8 * M_PI));
    const double size = hypot(cos(0.8 * M_PI) - centre, sin(0.8 * M_PI));
    assert_close(area_of(mesh), 10.0 * 0.5 * 0.3 * sin(0.2 * M_PI) / (size * size), 1e-5);
    gonio_mesh_free(&mesh);
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
        "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n",             /* two numbers */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n",           /* they count from 1 */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 1 2\n",          /* before the first */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3x\n",          /* no number */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//1 3//1\n",  /* no such normal */
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

/* Cancels while normals are made. */
static int cancel_normals(void *user, const char *task, double fraction)
{
    (void)user;
    (void)fraction;
    return strcmp(task, "making normals") == 0;
}

/* Cancels while a mesh is read. */
static int cancel_reading(void *user, const char *task, double fraction)
{
    (void)user;
    (void)fraction;
    return strcmp(task, "reading the mesh") == 0;
}

static gonio_status read_cancelled(int (*progress)(void *, const char *, double), const char *text,
                                   size_t size)
{
    gonio_context *usual = telling;
    gonio_mesh *mesh = NULL;
    const gonio_context_options options = {.size = sizeof options, .progress = progress};
    assert_int_equal(gonio_context_create(&telling, &options), GONIO_OK);
    const gonio_status status = read_mesh(text, size, &mesh);
    gonio_context_free(&telling);
    telling = usual;
    assert_true((mesh == NULL) == (status != GONIO_OK));
    gonio_mesh_free(&mesh);
    return status;
}

static void large_meshes_can_be_cancelled(void **state)
{
    (void)state;
    static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    enum { MANY = 2 * GONIO_I_MESH_PROGRESS };
    char *many = malloc(sizeof triangle + MANY);
    assert_non_null(many);
    memcpy(many, triangle, sizeof triangle - 1);
    memset(many + sizeof triangle - 1, '\n', MANY);
    assert_int_equal(read_cancelled(cancel_normals, triangle, sizeof triangle - 1),
                     GONIO_ERROR_CANCELLED);
    assert_int_equal(read_cancelled(cancel_reading, triangle, sizeof triangle - 1), GONIO_OK);
    assert_int_equal(read_cancelled(cancel_reading, many, sizeof triangle - 1 + MANY),
                     GONIO_ERROR_CANCELLED);
    free(many);
}

static void large_plys_can_be_cancelled(void **state)
{
    (void)state;
    enum { CORNERS = 2 * GONIO_I_MESH_PROGRESS };
    static const char head[] = "ply\nformat binary_little_endian 1.0\nelement vertex 32768\n"
                               "property uchar x\nproperty uchar y\nproperty uchar z\nend_header\n";
    assert_int_equal(CORNERS, 32768);
    char *many = calloc(sizeof head - 1 + 3 * (size_t)CORNERS, 1);
    assert_non_null(many);
    memcpy(many, head, sizeof head - 1);
    assert_int_equal(read_cancelled(cancel_reading, many, sizeof head - 1 + 3 * (size_t)CORNERS),
                     GONIO_ERROR_CANCELLED);
    free(many);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes_are_read),
        cmocka_unit_test(small_objs_are_read),
        cmocka_unit_test(crowded_corners_are_read),
        cmocka_unit_test(objs_of_all_kinds_are_read),
        cmocka_unit_test(concave_faces_are_covered),
        cmocka_unit_test(damaged_meshes_are_refused),
        cmocka_unit_test(large_meshes_can_be_cancelled),
        cmocka_unit_test(large_plys_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
