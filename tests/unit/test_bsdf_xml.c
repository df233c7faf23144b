/* Materials as BSDF-XML: Klems matrices and tensor trees with known values, and files that lie. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <zlib.h>

#include <gonio/material.h>

#include "material_files.h"
#include "mutations.h"

static const int rings[9] = {1, 8, 16, 20, 24, 24, 24, 16, 12};
static const double bounds[10] = {0.0, 5.0, 15.0, 25.0, 35.0, 45.0, 55.0, 65.0, 75.0, 90.0};

enum { PATCHES = 145, TEXT = 4 << 20 };

/* What a matrix holds: an incident and an outgoing patch can be told from it. */
static double klems_value(size_t in, size_t out)
{
    return 0.001 * (double)in + 0.000001 * (double)out;
}

typedef struct xml {
    char *text;
    size_t length;
} xml;

static void say(xml *x, const char *text)
{
    const size_t size = strlen(text);
    assert_true(x->length + size < TEXT);
    memcpy(x->text + x->length, text, size + 1);
    x->length += size;
}

static void say_matrix(xml *x, const char *unit, const char *wavelength, const char *direction,
                       double factor, const char *between)
{
    char number[64];
    say(x, "<WavelengthData><LayerNumber>System</LayerNumber><Wavelength unit=\"");
    say(x, unit);
    say(x, "\">");
    say(x, wavelength);
    say(x, "</Wavelength><WavelengthDataBlock><WavelengthDataDirection>");
    say(x, direction);
    say(x, "</WavelengthDataDirection><ColumnAngleBasis>LBNL/Klems Full</ColumnAngleBasis>"
           "<RowAngleBasis>LBNL/Klems Full</RowAngleBasis>"
           "<ScatteringDataType>BTDF</ScatteringDataType><ScatteringData>\n");
    for (size_t row = 0; row < PATCHES; row++) {
        for (size_t column = 0; column < PATCHES; column++) {
            snprintf(number, sizeof number, "%.6f%s", factor * klems_value(column, row), between);
            say(x, number);
        }
        say(x, "\n");
    }
    say(x, "</ScatteringData></WavelengthDataBlock></WavelengthData>\n");
}

static xml begin_xml(const char *prolog, const char *structure)
{
    xml x = {malloc(TEXT), 0};
    assert_non_null(x.text);
    say(&x, "<?xml version=\"1.0\"?>\n");
    say(&x, prolog);
    say(&x, "<WindowElement xmlns=\"http://windows.lbl.gov\"><Optical><Layer><DataDefinition>"
            "<IncidentDataStructure>");
    say(&x, structure);
    say(&x, "</IncidentDataStructure></DataDefinition>\n");
    return x;
}

static void end_xml(xml *x, const char *path)
{
    say(x, "</Layer></Optical></WindowElement>\n");
    write_bytes(path, x->text, x->length);
    free(x->text);
}

/* Independent of the reader: the patch by a search through all. */
static size_t patch_of(double theta, double phi)
{
    size_t first = 0;
    for (size_t r = 0; r < 9; r++) {
        for (int j = 0; j < rings[r]; j++) {
            const double apart = remainder(phi / degree - 360.0 * j / rings[r], 360.0);
            if (theta / degree >= bounds[r] && theta / degree < bounds[r + 1] &&
                fabs(apart) <= 180.0 / rings[r]) {
                return first + (size_t)j;
            }
        }
        first += (size_t)rings[r];
    }
    return first;
}

static void check_klems(const char *path, double factor, bool rows)
{
    gonio_material *material = open_good(path);
    gonio_i_random random;
    gonio_i_random_seed(&random, 3, 0);
    for (int k = 0; k < 500; k++) {
        const gonio_pair pair = {
            {1.5 * gonio_i_random_uniform(&random), 9.0 * k / 500.0 - 3.0},
            {1.5 * gonio_i_random_uniform(&random), 2.0 * M_PI * gonio_i_random_uniform(&random)}};
        const size_t in = patch_of(pair.incident.theta, pair.incident.phi + M_PI);
        const size_t out = patch_of(pair.outgoing.theta, pair.outgoing.phi);
        double value[3];
        assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, value), GONIO_OK);
        const double expected = factor * (rows ? klems_value(out, in) : klems_value(in, out));
        assert_true(fabs(value[0] - expected) < 1e-9);
    }
    gonio_material_free(&material);
}

static void test_klems(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.xml", folder);
    xml x = begin_xml("", "Columns");
    say_matrix(&x, "Integral", "Solar", "Reflection Front", 3.0, ",\t");
    say_matrix(&x, "Integral", "Visible", "Transmission Front", 4.0, ",");
    say_matrix(&x, "Integral", "Visible", "Reflection Back", 5.0, ",");
    say_matrix(&x, "Integral", "Visible", "Reflection Front", 2.0, "\n");
    end_xml(&x, path);
    check_klems(path, 2.0, false);
    gonio_material *material = open_good(path);
    assert_int_equal(gonio_material_describe(material)->channels, 1);
    assert_true(gonio_material_describe(material)->anisotropic);
    assert_non_null(strstr(gonio_material_format(material), "Front"));
    gonio_material_free(&material);
    check_mutations(path, folder);

    x = begin_xml("", "Rows");
    say_matrix(&x, "Integral", "Visible", "Reflection Back", 5.0, " ");
    end_xml(&x, path);
    check_klems(path, 5.0, true);
    support_remove(folder);
}

static void test_klems_in_channels(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.xml", folder);
    xml x = begin_xml("", "Columns");
    say_matrix(&x, "Micrometer", "0.55", "Reflection Front", 1.0, ",");
    say_matrix(&x, "Nanometer", "650", "Reflection Front", 2.0, ",");
    end_xml(&x, path);
    gonio_material *material = open_good(path);
    const gonio_material_view *view = gonio_material_describe(material);
    assert_int_equal(view->channels, 2);
    assert_true(fabs(view->wavelength[0] - 550.0) < 1e-9 && view->wavelength[1] == 650.0);
    gonio_material_free(&material);

    /* X, Y and Z alike are white. */
    x = begin_xml("", "Columns");
    say_matrix(&x, "Integral", "CIE-X", "Reflection Front", 1.0, ",");
    say_matrix(&x, "Integral", "Visible", "Reflection Front", 1.0, ",");
    say_matrix(&x, "Integral", "CIE-Z", "Reflection Front", 1.0, ",");
    end_xml(&x, path);
    material = open_good(path);
    view = gonio_material_describe(material);
    assert_int_equal(view->channels, 3);
    assert_null(view->wavelength);
    const gonio_pair pair = {{0.5, 0.0}, {0.7, 1.0}};
    double value[3];
    assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, value), GONIO_OK);
    const double expected = klems_value(patch_of(0.5, M_PI), patch_of(0.7, 1.0));
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(value[c] - expected) < 1e-9);
    }
    gonio_material_free(&material);
    support_remove(folder);
}

static void test_compressed_klems(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.xml", folder);
    xml x = begin_xml("", "Columns");
    say_matrix(&x, "Integral", "Visible", "Reflection Front", 1.0, ",");
    end_xml(&x, path);
    size_t size = 0;
    unsigned char *bytes = read_bytes(path, &size);
    snprintf(path, sizeof path, "%s/x.xml.gz", folder);
    gzFile out = gzopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(gzwrite(out, bytes, (unsigned)size), (int)size);
    assert_int_equal(gzclose(out), Z_OK);
    free(bytes);
    check_klems(path, 1.0, false);
    bytes = read_bytes(path, &size);
    write_bytes(path, bytes, size - 9);
    check_refused(path, "gzip");
    free(bytes);
    check_mutations(path, folder);
    support_remove(folder);
}

static void say_tree(const char *path, const char *structure, const char *tree)
{
    xml x = begin_xml("", structure);
    say(&x, "<WavelengthData><Wavelength unit=\"Integral\">Visible</Wavelength>"
            "<WavelengthDataBlock><WavelengthDataDirection>Reflection Front"
            "</WavelengthDataDirection><AngleBasis>LBNL/Shirley-Chiu</AngleBasis>"
            "<ScatteringDataType>BRDF</ScatteringDataType><ScatteringData>");
    say(&x, tree);
    say(&x, "</ScatteringData></WavelengthDataBlock></WavelengthData>");
    end_xml(&x, path);
}

static double value_at(const gonio_material *material, double theta_i, double phi_i, double theta_o,
                       double phi_o)
{
    const gonio_pair pair = {{theta_i * degree, phi_i * degree},
                             {theta_o * degree, phi_o * degree}};
    double value = 0.0;
    assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, &value), GONIO_OK);
    return value;
}

/* The incident direction is the first dimension; the outgoing one is seen from where light goes:
 * with light from 0 degrees it goes to 180. */
static void test_tensor_trees(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.xml", folder);
    say_tree(path, "TensorTree3", "{ 0.318309886 }");
    gonio_material *material = open_good(path);
    assert_false(gonio_material_describe(material)->anisotropic);
    assert_true(fabs(value_at(material, 20.0, 30.0, 50.0, 70.0) - 0.318309886) < 1e-7);
    gonio_material_free(&material);

    /* Eight boxes, the first dimension the lowest bit; one of them a grid, the last fastest. */
    say_tree(path, "TensorTree3",
             "{ {10} {11} {12} {13} {14} {15} { 20, 21, 22, 23, 24, 25, 26, 27 } {17} }");
    material = open_good(path);
    assert_true(value_at(material, 40.0, 0.0, 30.0, 180.0 - 20.0) == 12.0); /* x upper, y lower */
    assert_true(value_at(material, 40.0, 0.0, 30.0, 0.0 - 20.0) == 14.0);
    assert_true(value_at(material, 40.0, 0.0, 30.0, 0.0 + 20.0) == 10.0);
    assert_true(value_at(material, 40.0, 50.0, 30.0, 50.0 + 20.0) == 10.0); /* isotropic */
    /* x and y upper: 20 degrees off, at sin theta_o of 0.17 and 0.98 the square's inner, outer x;
     * y = 0.5 + 0.5 r 20/45 is in the lower half of its box; sin theta_i above 0.5: lower too. */
    assert_true(value_at(material, 50.0, 0.0, 10.0, 180.0 + 20.0) == 20.0);
    assert_true(value_at(material, 50.0, 0.0, 80.0, 180.0 + 20.0) == 22.0);
    assert_true(value_at(material, 20.0, 0.0, 80.0, 180.0 + 20.0) == 26.0);
    assert_true(value_at(material, 20.0, 0.0, 85.0, 180.0 + 40.0) == 27.0);
    gonio_material_free(&material);
    check_mutations(path, folder);

    say_tree(path, "TensorTree4", "{0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15}");
    material = open_good(path);
    assert_true(gonio_material_describe(material)->anisotropic);
    /* Light goes to 20 degrees: x and y upper, 8 + 4; outgoing at 160: x lower, y upper, 1. */
    assert_true(value_at(material, 40.0, 200.0, 30.0, 160.0) == 13.0);
    assert_true(value_at(material, 40.0, 20.0, 30.0, -20.0) == 2.0);
    gonio_material_free(&material);
    support_remove(folder);
}

static void test_trees_that_lie(void **state)
{
    (void)state;
    static const char *const trees[][2] = {
        {"", "without '{'"},          {"{1", "finite"},       {"{1 2 3}", "wrong number"},
        {"{{1} {2}}", "without '{'"}, {"{nan}", "finite"},    {"{1} {2}", "text after"},
        {"{1e40}", "finite"},         {"{}", "wrong number"},
    };
    char *folder = support_folder();
    char path[4096];
    char deep[8192] = "";
    snprintf(path, sizeof path, "%s/x.xml", folder);
    for (size_t k = 0; k < sizeof trees / sizeof *trees; k++) {
        say_tree(path, "TensorTree3", trees[k][0]);
        check_refused(path, trees[k][1]);
    }
    memset(deep, '{', 1000);
    say_tree(path, "TensorTree4", deep);
    check_refused(path, "deep");
    support_remove(folder);
}

static void test_xml_that_lies(void **state)
{
    (void)state;
    static const char bomb[] = "<!DOCTYPE b [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;\">"
                               "<!ENTITY c \"&b;&b;&b;&b;&b;&b;\">]>";
    static const char outside[] = "<!DOCTYPE b [<!ENTITY a SYSTEM \"file:///etc/passwd\">]>";
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.xml", folder);
    xml x = begin_xml(bomb, "&c;");
    end_xml(&x, path);
    check_refused(path, "entity");
    x = begin_xml(outside, "&a;");
    end_xml(&x, path);
    check_refused(path, "entity");
    x = begin_xml("", "Columns");
    end_xml(&x, path);
    check_refused(path, "no reflection data");
    x = begin_xml("", "TensorTree9");
    say_matrix(&x, "Integral", "Visible", "Reflection Front", 1.0, ",");
    end_xml(&x, path);
    check_refused(path, "TensorTree9");
    x = begin_xml("", "Columns");
    say_matrix(&x, "Integral", "Visible", "Reflection Front", 1.0, ",");
    char *number = strstr(x.text, "0.001000,");
    assert_non_null(number);
    memcpy(number, "nan     ", 8);
    end_xml(&x, path);
    check_refused(path, "finite");
    x = begin_xml("", "Columns");
    say_matrix(&x, "Integral", "Visible", "Reflection Front", 1.0, ",");
    number = strstr(x.text, "0.001000,");
    memset(number, ' ', 8);
    end_xml(&x, path);
    check_refused(path, "145 x 145");
    x = begin_xml("", "Columns");
    say_matrix(&x, "Integral", "Visible", "Reflection Front", 1.0, ",");
    x.length /= 2;
    write_bytes(path, x.text, x.length);
    free(x.text);
    check_refused(path, "cut short");
    x = begin_xml("", "Columns");
    for (int k = 0; k < 100; k++) {
        say(&x, "<Deep>");
    }
    end_xml(&x, path);
    check_refused(path, "deep");
    x = begin_xml("", "Columns");
    say(&x, "<AngleBasis><AngleBasisName>LBNL/Klems Full</AngleBasisName><AngleBasisBlock>"
            "<ThetaBounds><LowerTheta>0</LowerTheta><UpperTheta>90</UpperTheta></ThetaBounds>"
            "<nPhis>1e9</nPhis></AngleBasisBlock></AngleBasis>");
    end_xml(&x, path);
    check_refused(path, "patches");
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_klems),
        cmocka_unit_test(test_klems_in_channels),
        cmocka_unit_test(test_compressed_klems),
        cmocka_unit_test(test_tensor_trees),
        cmocka_unit_test(test_trees_that_lie),
        cmocka_unit_test(test_xml_that_lies),
    };
    return cmocka_run_group_tests_name("BSDF-XML", tests, NULL, NULL);
}
