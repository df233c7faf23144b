/* Cells of tables with more in them than a number: units, per cent signs, uncertainties. */
#include "../support.h"

#include "csv_tables.h"

/* A table of which the last reading has a value and a deviation. */
typedef struct table {
    const char *text;
    double value;
    double deviation; /* 0: there are none */
} table;

static void test_cells(void **state)
{
    static const table tables[] = {
        {"theta_i,theta_o,R\n30,20,98.5%\n30,40,97 %\n", 0.97 / M_PI, 0.0},
        {"theta_i;theta_o;brf\n30;20;\n30;40;97,5 %\n", 0.975 / M_PI, 0.0},
        {"theta_i,theta_o,brdf\n30,20,0.3 ± 0.01\n30,40,0.4 +/- 0.02\n", 0.4, 0.02},
        {"theta_i,theta_o,brdf\n30,20,(0.3+-0.01) 1/sr\n30,40,(0.4 ± 0.02)  1/sr\n", 0.4, 0.02},
        {"theta_i,theta_o,brdf\n30,20,0.312(5)\n30,40,4.00(12)e-1\n", 0.4, 0.012},
        {"theta_i,theta_o,brf\n30,40,98.5% ± 0.5%\n", 0.985 / M_PI, 0.005 / M_PI},
        {"theta_i,theta_o,brdf s,brdf p\n30,40,0.3 ± 0.03,0.5 ± 0.04\n", 0.4, 0.025},
        {"theta_i,theta_o,brdf\n30,40,0.3 sr^-1\n", 0.3, 0.0},
        {"theta_i,theta_o,brdf\n30,40,-10 dB\n", 0.1, 0.0},
        {"theta_i,theta_o,wavelength,brdf\n0.3 rad,0.2 rad,550 nm,0.3 sr-1\n", 0.3, 0.0},
    };
    (void)state;
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++) {
        gonio_context *context = support_context();
        gonio_readings *readings = read_table(context, tables[k].text, true);
        assert_non_null(readings);
        const gonio_readings_view *view = gonio_readings_describe(readings);
        const size_t last = view->count - 1;
        const size_t channel = 0;
        assert_near(gonio_readings_value(readings, last, channel), tables[k].value);
        assert_int_equal(view->deviation != NULL, tables[k].deviation > 0.0);
        if (view->deviation != NULL) {
            assert_near(view->deviation[last * view->channels + channel], tables[k].deviation);
        }
        gonio_readings_free(&readings);
        gonio_context_free(&context);
    }
}

/* Cells unlike the first of their column, or that say two things, are refused by their place. */
static void test_refused(void **state)
{
    static const refused_text tables[] = {
        {"theta_i,theta_o,brf\n30,20,98.5%\n30,30,97\n", "r.csv:3: brf (%) '97' has no unit"},
        {"theta_i,theta_o,brdf\n30,20,0.3\n30,40,0.4 1/sr\n",
         "r.csv:3: brdf '0.4 1/sr' is not a finite number as the column's"},
        {"theta_i,theta_o,brdf\n30,20,0.3 1/sr\n30,40,9 %\n", "r.csv:3: brdf (1/sr) '9 %' has not"},
        {"theta_i,theta_o,brdf\n30,20,0.3\n30,40,0.4 ± 1\n", "r.csv:3: brdf '0.4 ± 1' has an unc"},
        {"theta_i,theta_o,brdf [1/sr]\n30,20,97 %\n", "has another unit than the column's name"},
        {"theta_i,theta_o,brdf\n30,20,0.3 W/m2\n",
         "is not a finite number in a unit that is known"},
        {"theta_i,theta_o,brdf\n30,20,0.3 (5)\n", "is not a finite number in a unit that is known"},
        {"theta_i,theta_o,brdf\n30,20,0.3 ± 3 %\n", "leaves open what its uncertainty is"},
        {"theta_i,theta_o,brdf,sigma\n30,20,0.3 ± 0.01,0.3\n", "delete one"},
    };
    (void)state;
    assert_refused(tables, sizeof tables / sizeof *tables);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cells),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests_name("csv forms", tests, NULL, NULL);
}
