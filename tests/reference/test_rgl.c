/* RGL files: values at random pairs of directions as two independent readers give them. */
#include <gonio/material.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <jansson.h>

#include "../support.h"

enum { COLUMNS = 7 };

static double entry(const json_t *row, size_t k)
{
    return json_number_value(json_array_get(row, k));
}

static gonio_pair pair_of(const json_t *row)
{
    const double degree = M_PI / 180.0;
    return (gonio_pair){{entry(row, 0) * degree, entry(row, 1) * degree},
                        {entry(row, 2) * degree, entry(row, 3) * degree}};
}

/* 1e-5 relative. A negative value is none. */
static void check_values(gonio_pair pair, const gonio_material *material, const json_t *row)
{
    double values[GONIO_CHANNELS];
    assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, values), GONIO_OK);
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        const double expected = entry(row, 4 + c);
        if (expected < 0.0) {
            assert_true(isnan(values[c]));
        } else {
            assert_true(fabs(values[c] - expected) <= 1e-5 * expected + 1e-6);
        }
    }
}

static void test_values(void **state)
{
    (void)state;
    char path[4096];
    support_need_shared();
    snprintf(path, sizeof path, "%s/reference/rgl.json", support_shared());
    json_t *all = json_load_file(path, 0, NULL);
    assert_non_null(all);
    const char *name = NULL;
    json_t *rows = NULL;
    json_object_foreach(json_object_get(all, "materials"), name, rows)
    {
        snprintf(path, sizeof path, "%s/data/rgl/%s", support_shared(), name);
        gonio_material *material = NULL;
        assert_int_equal(gonio_material_open(NULL, path, &material), GONIO_OK);
        print_message("%s: %s, %zu rows\n", name, gonio_material_format(material),
                      json_array_size(rows));
        for (size_t k = 0; k < json_array_size(rows); k++) {
            const json_t *row = json_array_get(rows, k);
            check_values(pair_of(row), material, row);
        }
        gonio_material_free(&material);
    }
    json_decref(all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_values)};
    return cmocka_run_group_tests_name("rgl", tests, NULL, NULL);
}
