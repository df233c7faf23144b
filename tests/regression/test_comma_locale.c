/* A program in a locale whose numbers have decimal commas gets the same files as any other: bases,
 * plans, readings, materials, pictures, pages. */
#include <gonio/gonio.h>

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support.h"
#include "../unit/made_basis.h"

enum { READINGS = 6, PATH = 512 };

/* "folder/name", in a buffer that the next four calls leave alone. */
static const char *at(const char *folder, const char *name)
{
    static char path[4][PATH];
    static int next = 0;
    next = (next + 1) % 4;
    snprintf(path[next], PATH, "%s/%s", folder, name);
    return path[next];
}

static void copy_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static gonio_basis *learn_and_read(const char *folder)
{
    gonio_basis *made = made_basis(NULL, GONIO_BIVARIATE, GONIO_SEPARATE, 1);
    gonio_basis *read = NULL;
    assert_int_equal(gonio_basis_write(NULL, made, NULL, at(folder, "basis")), GONIO_OK);
    gonio_basis_free(&made);
    assert_int_equal(gonio_basis_read(NULL, at(folder, "basis"), &read), GONIO_OK);
    return read;
}

static void plan_and_measure(const char *folder, const gonio_basis *basis)
{
    gonio_plan_options wanted;
    gonio_plan_options_default(&wanted);
    wanted.count = READINGS;
    gonio_plan *plan = NULL;
    assert_int_equal(gonio_plan_create(NULL, basis, &wanted, &plan), GONIO_OK);
    assert_int_equal(gonio_plan_write(NULL, plan, NULL, at(folder, "plan.csv")), GONIO_OK);
    gonio_plan_free(&plan);

    gonio_readings *readings = NULL;
    gonio_material *material = NULL;
    const gonio_readings_options as_plan = {.size = sizeof as_plan, .average_repeats = true};
    assert_int_equal(gonio_readings_read(NULL, at(folder, "plan.csv"), &as_plan, &readings),
                     GONIO_OK);
    assert_int_equal(gonio_material_open(NULL, "atlas:gold-polished", &material), GONIO_OK);
    assert_int_equal(gonio_measure_material(NULL, readings, material, NULL), GONIO_OK);
    assert_int_equal(gonio_readings_write(NULL, readings, NULL, at(folder, "readings.csv")),
                     GONIO_OK);
    assert_int_equal(gonio_readings_write(NULL, readings, NULL, at(folder, "readings.json")),
                     GONIO_OK);
    gonio_material_free(&material);
    gonio_readings_free(&readings);
}

static gonio_material *reconstruct(const gonio_basis *basis, const char *path,
                                   gonio_reconstruction **made)
{
    gonio_readings *readings = NULL;
    gonio_material *material = NULL;
    gonio_reconstruct_options how;
    gonio_reconstruct_options_default(&how);
    how.method = "posterior";
    const gonio_readings_options with = {
        .size = sizeof with, .values_needed = true, .average_repeats = true};
    assert_int_equal(gonio_readings_read(NULL, path, &with, &readings), GONIO_OK);
    assert_int_equal(gonio_reconstruct(NULL, basis, readings, &how, made), GONIO_OK);
    gonio_readings_free(&readings);
    assert_int_equal(gonio_reconstruction_material(NULL, basis, *made, "made", &material),
                     GONIO_OK);
    return material;
}

static void read_and_write_again(const char *from, const char *to)
{
    gonio_material *material = NULL;
    gonio_write_options how;
    gonio_write_options_default(&how);
    how.average_azimuths = true; /* of Klems' patches */
    assert_int_equal(gonio_material_open(NULL, from, &material), GONIO_OK);
    assert_int_equal(gonio_material_write(NULL, material, to, &how), GONIO_OK);
    gonio_material_free(&material);
}

/* The formats of text, coarse, and what is read back from them. */
static void convert(const char *folder, const gonio_material *material)
{
    static const char *const names[] = {"made.csv", "made.bsdf.txt", "made.xml"};
    static const char *const formats[] = {"csv", "zemax", "klems"};
    gonio_write_options how;
    gonio_write_options_default(&how);
    how.theta_i_step = how.theta_o_step = M_PI / 12.0;
    how.phi_step = M_PI / 6.0;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        how.format = formats[k];
        assert_int_equal(gonio_material_write(NULL, material, at(folder, names[k]), &how),
                         GONIO_OK);
    }
    read_and_write_again(at(folder, "made.xml"), at(folder, "klems.binary"));
    for (size_t k = 0; k < 2; k++) {
        gonio_readings *readings = NULL;
        assert_int_equal(gonio_readings_read(NULL, at(folder, names[k]), NULL, &readings),
                         GONIO_OK);
        assert_int_equal(gonio_readings_write(NULL, readings, NULL,
                                              at(folder, k == 0 ? "grid.csv" : "zemax.csv")),
                         GONIO_OK);
        gonio_readings_free(&readings);
    }
}

/* The same readings as text of other kinds. */
static void read_other_texts(const char *folder)
{
    static const char *const texts[] = {
        "1\n550.5\n0.25 0.0 0.5 3.0 0.125\n0.25 0.0 0.75 3.0 0.0625\n",
        "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,550.5nm_per_sr\n10.5,0,20.5,180,0.125\n",
    };
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        gonio_readings *readings = NULL;
        copy_text(at(folder, "text"), texts[k]);
        assert_int_equal(gonio_readings_read(NULL, at(folder, "text"), NULL, &readings), GONIO_OK);
        const gonio_readings_view *view = gonio_readings_describe(readings);
        assert_float_equal(view->wavelength[0], 550.5, 0.0);
        assert_float_equal(gonio_readings_value(readings, 0, 0), 0.125, 0.0);
        gonio_readings_free(&readings);
    }
}

static const char mesh_text[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                "property float y\nproperty float z\nelement face 1\n"
                                "property list uchar int vertex_indices\nend_header\n"
                                "-0.5 -0.5 0.25\n0.75 -0.5 0.25\n0.25 0.5 0.25\n3 0 1 2\n";

static void render(const char *folder, const gonio_material *material)
{
    gonio_mesh *mesh = NULL;
    gonio_image *image = NULL;
    copy_text(at(folder, "mesh.ply"), mesh_text);
    const gonio_status status = gonio_mesh_read(NULL, at(folder, "mesh.ply"), &mesh);
    if (status == GONIO_ERROR_ARGUMENT) { /* built without the renderer */
        return;
    }
    assert_int_equal(status, GONIO_OK);
    gonio_render_options how;
    gonio_render_options_default(&how);
    how.width = how.height = 32;
    how.samples = 4;
    how.mesh = mesh;
    assert_int_equal(gonio_render(NULL, material, &how, &image), GONIO_OK);
    assert_int_equal(gonio_image_write_exr(NULL, image, at(folder, "made.exr")), GONIO_OK);
    gonio_image_free(&image);
    gonio_mesh_free(&mesh);
}

static void write_page(const char *folder, const gonio_material *material)
{
    const gonio_page_content content = {.size = sizeof content, .reference = material};
    if (gonio_page_is_built()) {
        assert_int_equal(gonio_page_write(NULL, &content, at(folder, "page.html")), GONIO_OK);
    }
}

static void whole_chain(const char *folder)
{
    gonio_reconstruction *from_csv = NULL;
    gonio_reconstruction *from_json = NULL;
    gonio_basis *basis = learn_and_read(folder);
    plan_and_measure(folder, basis);
    gonio_material *material = reconstruct(basis, at(folder, "readings.csv"), &from_csv);
    gonio_material *other = reconstruct(basis, at(folder, "readings.json"), &from_json);
    assert_int_equal(gonio_material_write(NULL, material, at(folder, "made.binary"), NULL),
                     GONIO_OK);
    assert_int_equal(gonio_material_write(NULL, other, at(folder, "other.binary"), NULL), GONIO_OK);
    convert(folder, material);
    read_other_texts(folder);
    render(folder, material);
    write_page(folder, material);
    gonio_material_free(&material);
    gonio_material_free(&other);
    gonio_reconstruction_free(&from_csv);
    gonio_reconstruction_free(&from_json);
    gonio_basis_free(&basis);
}

/* Whether the locale, made in the folder, is now the program's. */
static bool enter_locale(const char *folder, const char *of)
{
    char command[PATH * 2];
    char name[64];
    snprintf(name, sizeof name, "%s.UTF-8", of);
    snprintf(command, sizeof command, "localedef -c -i %s -f UTF-8 %s/%s >/dev/null 2>&1", of,
             folder, name);
    setenv("LOCPATH", folder, 1);
    return system(command) != -1 && setlocale(LC_ALL, name) != NULL;
}

static void assert_same_files(const char *folder, const char *other)
{
    char command[PATH * 3];
    snprintf(command, sizeof command, "diff -r %s %s", folder, other);
    assert_int_equal(system(command), 0);
}

static char said[256];

static void keep(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    (void)level;
    snprintf(said, sizeof said, "%s", text);
}

static void assert_message_has_points(void)
{
    const gonio_context_options talk = {.size = sizeof talk, .message = keep};
    gonio_context *context = NULL;
    gonio_readings *readings = NULL;
    const double wrong = -1.5;
    const double value = 1.0;
    const gonio_pair pair = {{0.5, 0.0}, {0.5, 3.0}};
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = 1,
                                          .channels = 1,
                                          .pair = &pair,
                                          .wavelength = &wrong,
                                          .value = &value};
    assert_int_equal(gonio_context_create(&context, &talk), GONIO_OK);
    assert_int_equal(gonio_readings_create(context, &arrays, NULL, &readings),
                     GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(said, "-1.5"));
    gonio_context_free(&context);
}

/* Commas, and a separator of two bytes. */
static void test_same_files(void **state)
{
    static const char *const locales[] = {"de_DE", "ps_AF"};
    (void)state;
    char *plain = support_folder();
    bool any = false;
    whole_chain(plain);
    for (size_t k = 0; k < sizeof locales / sizeof *locales; k++) {
        char *kept = support_folder();
        char *folder = support_folder();
        if (enter_locale(kept, locales[k])) {
            char sample[16];
            snprintf(sample, sizeof sample, "%.1f", 1.5);
            assert_string_not_equal(sample, "1.5");
            whole_chain(folder);
            assert_message_has_points();
            setlocale(LC_ALL, "C");
            assert_same_files(plain, folder);
            any = true;
        }
        support_remove(folder);
        support_remove(kept);
    }
    support_remove(plain);
    if (!any) {
        print_message("SKIPPED: no locale with decimal commas can be made (localedef)\n");
        skip();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_files)};
    return cmocka_run_group_tests_name("comma_locale", tests, NULL, NULL);
}
