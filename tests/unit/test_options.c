/* Structs that begin with their size: callers of older and newer builds, callers that set nothing,
 * and no struct at all, which means the defaults. */
#include "../support.h"

#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "core/options.h"
#include "made_basis.h"
#include "made_material.h"
#include "made_readings.h"

/* ---- the copy ---- */

typedef struct settings {
    size_t size;
    int first;
    double second;
} settings;

static const settings usual = {sizeof(settings), 1, 2.0};

static void assert_usual(const settings *taken)
{
    assert_true(taken->size == usual.size && taken->first == usual.first &&
                taken->second == usual.second);
}

static void test_older_callers_leave_the_defaults(void **state)
{
    (void)state;
    const settings older = {.size = offsetof(settings, second), .first = 7, .second = 8.0};
    settings taken = usual;
    assert_true(gonio_i_copy_known(&older, &taken, sizeof taken));
    assert_int_equal(taken.size, sizeof taken);
    assert_int_equal(taken.first, 7);
    assert_true(taken.second == 2.0);
}

static void test_newer_callers_fields_are_left_out(void **state)
{
    (void)state;
    const struct {
        settings known;
        double third;
    } newer = {{sizeof newer, 7, 8.0}, 9.0};
    struct {
        settings taken;
        double behind;
    } room = {usual, 5.0};
    assert_true(gonio_i_copy_known(&newer, &room.taken, sizeof room.taken));
    assert_int_equal(room.taken.size, sizeof room.taken);
    assert_true(room.taken.first == 7 && room.taken.second == 8.0 && room.behind == 5.0);
}

static void test_sizes_that_were_not_set(void **state)
{
    (void)state;
    static const size_t sizes[] = {0, 1, sizeof(size_t) - 1, 4097, SIZE_MAX};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        const settings wild = {sizes[k], 7, 8.0};
        settings taken = usual;
        assert_false(gonio_i_copy_known(&wild, &taken, sizeof taken));
        assert_usual(&taken);
    }
    settings taken = usual;
    assert_true(gonio_i_copy_known(NULL, &taken, sizeof taken));
    assert_usual(&taken);
}

/* ---- defaults, given to callers of any build ---- */

/* The struct of `size` bytes, as a caller of another build has it. */
#define GIVER(function)                                                                            \
    static void give_##function(void *to, size_t size)                                             \
    {                                                                                              \
        function(to, size);                                                                        \
    }
GIVER(gonio_context_options_default_of)
GIVER(gonio_database_options_default_of)
GIVER(gonio_basis_options_default_of)
GIVER(gonio_recipe_default_of)
GIVER(gonio_recipe_paper_of)
GIVER(gonio_readings_options_default_of)
GIVER(gonio_instrument_options_default_of)
GIVER(gonio_plan_options_default_of)
GIVER(gonio_reconstruct_options_default_of)
GIVER(gonio_render_options_default_of)
GIVER(gonio_write_options_default_of)

static void give_recipe_for_grid(void *to, size_t size)
{
    gonio_recipe_for_grid_of(to, size, GONIO_FULL);
}

static const struct {
    void (*give)(void *to, size_t size);
    size_t size;
} givers[] = {
    {give_gonio_context_options_default_of, sizeof(gonio_context_options)},
    {give_gonio_database_options_default_of, sizeof(gonio_database_options)},
    {give_gonio_basis_options_default_of, sizeof(gonio_basis_options)},
    {give_gonio_recipe_default_of, sizeof(gonio_recipe)},
    {give_gonio_recipe_paper_of, sizeof(gonio_recipe)},
    {give_recipe_for_grid, sizeof(gonio_recipe)},
    {give_gonio_readings_options_default_of, sizeof(gonio_readings_options)},
    {give_gonio_instrument_options_default_of, sizeof(gonio_instrument_options)},
    {give_gonio_plan_options_default_of, sizeof(gonio_plan_options)},
    {give_gonio_reconstruct_options_default_of, sizeof(gonio_reconstruct_options)},
    {give_gonio_render_options_default_of, sizeof(gonio_render_options)},
    {give_gonio_write_options_default_of, sizeof(gonio_write_options)},
};

/* An older caller's struct ends earlier: nothing behind its end is touched. A newer one's fields
 * that this build does not know of are 0. */
static void test_defaults_fit_the_callers_struct(void **state)
{
    (void)state;
    enum { ROOM = 512, UNTOUCHED = 0x5a };
    for (size_t k = 0; k < sizeof givers / sizeof *givers; k++) {
        const size_t now = givers[k].size;
        const size_t older = now - sizeof(int);
        const size_t newer = now + sizeof(double);
        unsigned char made[3][ROOM];
        memset(made, UNTOUCHED, sizeof made);
        const size_t sizes[3] = {now, older, newer};
        for (int c = 0; c < 3; c++) {
            size_t told = 0;
            givers[k].give(made[c], sizes[c]);
            memcpy(&told, made[c], sizeof told);
            assert_int_equal(told, sizes[c]);
            assert_int_equal(made[c][sizes[c]], UNTOUCHED);
            assert_memory_equal(made[c] + sizeof told, made[0] + sizeof told, older - sizeof told);
        }
        for (size_t b = now; b < newer; b++) {
            assert_int_equal(made[2][b], 0);
        }
    }
}

/* ---- every function that takes such a struct ---- */

enum { COUNT = 4 };

typedef struct fixture {
    gonio_context *context;
    gonio_database *database;
    gonio_basis *basis;
    gonio_plan *plan;
    gonio_readings *readings; /* of the plan, read */
    gonio_material *material;
    gonio_table *table;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->context = support_context();
    f->database = made_database(GONIO_BIVARIATE, GONIO_SEPARATE);
    f->basis = made_basis(f->context, GONIO_BIVARIATE, GONIO_SEPARATE, 1);
    gonio_plan_options few;
    gonio_plan_options_default(&few);
    few.count = COUNT;
    assert_int_equal(gonio_plan_create(f->context, f->basis, &few, &f->plan), GONIO_OK);
    assert_int_equal(gonio_readings_create_from_plan(f->context, f->plan, &f->readings), GONIO_OK);
    assert_int_equal(gonio_material_open(f->context, "atlas:gold-polished", &f->material),
                     GONIO_OK);
    f->table = made_table(f->material);
    assert_int_equal(gonio_measure(f->context, f->readings, f->table, NULL), GONIO_OK);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_table_free(&f->table);
    gonio_material_free(&f->material);
    gonio_readings_free(&f->readings);
    gonio_plan_free(&f->plan);
    gonio_basis_free(&f->basis);
    gonio_database_free(&f->database);
    gonio_context_free(&f->context);
    free(f);
    return 0;
}

/* A struct whose size nobody set. */
typedef union unset {
    size_t size;
    gonio_context_options context;
    gonio_database_options database;
    gonio_basis_options basis;
    gonio_recipe recipe;
    gonio_readings_options readings;
    gonio_readings_arrays arrays;
    gonio_instrument_options instrument;
    gonio_plan_options plan;
    gonio_reconstruct_options reconstruct;
    gonio_material_source source;
    gonio_page_content page;
    gonio_write_options write;
} unset;

static void assert_refused(gonio_status status, const char *type)
{
    assert_int_equal(status, GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(support_message(), type));
    assert_non_null(strstr(support_message(), "was not initialised"));
}

static void refuse_learning(fixture *f, const unset *no)
{
    gonio_database *database = NULL;
    gonio_basis *basis = NULL;
    const gonio_material *materials[] = {f->material};
    assert_refused(
        gonio_database_create(f->context, made_paths, MADE_MATERIALS, &no->database, &database),
        "gonio_database_options");
    assert_refused(
        gonio_database_create_from_materials(f->context, materials, 1, &no->database, &database),
        "gonio_database_options");
    assert_refused(gonio_basis_learn(f->context, f->database, &no->basis, &basis),
                   "gonio_basis_options");
    assert_refused(gonio_learn(f->context, made_paths, MADE_MATERIALS, &no->recipe, &basis),
                   "gonio_recipe");
    assert_true(database == NULL && basis == NULL);
}

static void refuse_readings(fixture *f, const unset *no)
{
    const gonio_readings_view *view = gonio_readings_describe(f->readings);
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = view->count,
                                          .channels = view->channels,
                                          .pair = view->pair};
    gonio_readings *readings = NULL;
    assert_refused(gonio_readings_create(f->context, &no->arrays, NULL, &readings),
                   "gonio_readings_arrays");
    assert_refused(gonio_readings_create(f->context, &arrays, &no->readings, &readings),
                   "gonio_readings_options");
    assert_refused(gonio_readings_read(f->context, "/nonexistent", &no->readings, &readings),
                   "gonio_readings_options");
    assert_refused(gonio_readings_set_values(f->context, f->readings, view->channels, NULL,
                                             view->value, &no->readings),
                   "gonio_readings_options");
    assert_refused(gonio_measure(f->context, f->readings, f->table, &no->instrument),
                   "gonio_instrument_options");
    assert_null(readings);
}

static void refuse_plans(fixture *f, const unset *no)
{
    static const double vectors[] = {1.0, 2.0};
    size_t chosen[1];
    gonio_selection_report report;
    gonio_plan *plan = NULL;
    assert_refused(gonio_plan_create(f->context, f->basis, &no->plan, &plan), "gonio_plan_options");
    assert_refused(gonio_plan_select(f->context, vectors, 2, 1, 1, &no->plan, chosen, &report),
                   "gonio_plan_options");
    assert_refused(
        gonio_plan_next(f->context, f->basis, f->readings, NULL, &no->plan, NULL, NULL, &plan),
        "gonio_plan_options");
    assert_refused(gonio_plan_next(f->context, f->basis, f->readings, &no->reconstruct, NULL, NULL,
                                   NULL, &plan),
                   "gonio_reconstruct_options");
    assert_null(plan);
}

static void refuse_reconstructions(fixture *f, const unset *no)
{
    static const size_t row[] = {0};
    static const double b[GONIO_CHANNELS] = {0.0};
    const gonio_readings *readings[] = {f->readings};
    static const char *const paths[] = {"/nonexistent/table.binary"};
    const gonio_reconstruct_options *options = &no->reconstruct;
    gonio_reconstruction *made = NULL;
    gonio_material *material = NULL;
    assert_refused(gonio_reconstruct(f->context, f->basis, f->readings, options, &made),
                   "gonio_reconstruct_options");
    assert_refused(gonio_reconstruct_rows_with(f->context, f->basis, options, row, 1, b, &made),
                   "gonio_reconstruct_options");
    assert_refused(
        gonio_reconstruct_material(f->context, f->basis, f->material, row, 1, options, &material),
        "gonio_reconstruct_options");
    assert_refused(
        gonio_reconstruct_tables(f->context, f->basis, readings, paths, 1, options, &made),
        "gonio_reconstruct_options");
    assert_true(made == NULL && material == NULL);
}

static void refuse_the_rest(fixture *f, const unset *no)
{
    gonio_context *context = NULL;
    gonio_material *material = NULL;
    assert_int_equal(gonio_context_create(&context, &no->context), GONIO_ERROR_ARGUMENT);
    assert_refused(gonio_material_create(f->context, "a", "b", &no->source, &material),
                   "gonio_material_source");
    assert_refused(gonio_page_write(f->context, &no->page, "/nonexistent"), "gonio_page_content");
    assert_refused(gonio_material_write(f->context, f->material, "/nonexistent", &no->write),
                   "gonio_write_options");
    assert_true(context == NULL && material == NULL);
}

static void test_every_function_refuses_what_was_not_initialised(void **state)
{
    static const size_t sizes[] = {0, SIZE_MAX};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        unset no = {0};
        no.size = sizes[k];
        refuse_learning(*state, &no);
        refuse_readings(*state, &no);
        refuse_plans(*state, &no);
        refuse_reconstructions(*state, &no);
        refuse_the_rest(*state, &no);
    }
}

/* ---- no struct ---- */

static void assert_same_plan(const gonio_plan *a, const gonio_plan *b)
{
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->entries, b->entries, a->count * sizeof *a->entries);
    assert_string_equal(a->method, b->method);
}

static void test_no_options_are_the_defaults_of_a_plan(void **state)
{
    const fixture *f = *state;
    gonio_plan_options options;
    gonio_plan *plans[2] = {NULL};
    gonio_plan_options_default(&options);
    assert_int_equal(gonio_plan_create(f->context, f->basis, NULL, &plans[0]), GONIO_OK);
    assert_int_equal(gonio_plan_create(f->context, f->basis, &options, &plans[1]), GONIO_OK);
    assert_int_equal(plans[0]->count, 80);
    assert_same_plan(plans[0], plans[1]);
    gonio_plan_free(&plans[0]);
    gonio_plan_free(&plans[1]);
}

static void test_no_options_are_the_defaults_of_the_next_readings(void **state)
{
    const fixture *f = *state;
    gonio_plan_options where;
    gonio_reconstruct_options how;
    gonio_plan *plans[2] = {NULL};
    double expected[2] = {0.0, 0.0};
    gonio_plan_options_default(&where);
    gonio_reconstruct_options_default(&how);
    assert_int_equal(gonio_plan_next(f->context, f->basis, f->readings, NULL, NULL, &expected[0],
                                     NULL, &plans[0]),
                     GONIO_OK);
    assert_int_equal(gonio_plan_next(f->context, f->basis, f->readings, &how, &where, &expected[1],
                                     NULL, &plans[1]),
                     GONIO_OK);
    assert_int_equal(plans[0]->count, 5);
    assert_same_plan(plans[0], plans[1]);
    assert_true(expected[0] > 0.0 && expected[0] == expected[1]);
    gonio_plan_free(&plans[0]);
    gonio_plan_free(&plans[1]);
}

static void test_no_options_choose_rows_too(void **state)
{
    (void)state;
    enum { ROWS = 90, K = 2 };
    double vectors[ROWS * K];
    for (size_t k = 0; k < ROWS * K; k++) {
        vectors[k] = (double)((k * 7919) % 101) / 101.0 - 0.5;
    }
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    size_t chosen[2][80];
    gonio_selection_report report[2];
    assert_int_equal(gonio_plan_select(NULL, vectors, ROWS, K, K, NULL, chosen[0], &report[0]),
                     GONIO_OK);
    assert_int_equal(gonio_plan_select(NULL, vectors, ROWS, K, K, &options, chosen[1], &report[1]),
                     GONIO_OK);
    assert_memory_equal(chosen[0], chosen[1], sizeof chosen[0]);
    assert_true(report[0].condition_number == report[1].condition_number);
    free(report[0].history);
    free(report[1].history);
}

static void test_no_options_are_the_defaults_of_a_reconstruction(void **state)
{
    const fixture *f = *state;
    gonio_reconstruct_options options;
    gonio_reconstruction *made[2] = {NULL};
    gonio_reconstruct_options_default(&options);
    assert_int_equal(gonio_reconstruct(f->context, f->basis, f->readings, NULL, &made[0]),
                     GONIO_OK);
    assert_int_equal(gonio_reconstruct(f->context, f->basis, f->readings, &options, &made[1]),
                     GONIO_OK);
    assert_true(made[0]->predicted_e6 > 0.0 && made[0]->predicted_e6 == made[1]->predicted_e6);
    assert_memory_equal(made[0]->coefficients, made[1]->coefficients,
                        made[0]->columns * made[0]->components * sizeof(double));
    gonio_reconstruction_free(&made[0]);
    gonio_reconstruction_free(&made[1]);
}

static void test_no_options_are_the_defaults_of_a_context(void **state)
{
    (void)state;
    gonio_context_options options;
    gonio_context *contexts[2] = {NULL};
    gonio_context_options_default(&options);
    assert_true(options.message == NULL && options.progress == NULL && options.threads == 0);
    assert_int_equal(gonio_context_create(&contexts[0], NULL), GONIO_OK);
    assert_int_equal(gonio_context_create(&contexts[1], &options), GONIO_OK);
    assert_int_equal(gonio_context_threads(contexts[0]), gonio_context_threads(NULL));
    assert_int_equal(gonio_context_threads(contexts[1]), gonio_context_threads(NULL));
    gonio_context_free(&contexts[0]);
    gonio_context_free(&contexts[1]);
}

static void test_no_options_are_the_defaults_of_a_writer(void **state)
{
    const fixture *f = *state;
    gonio_write_options options;
    gonio_write_options_default(&options);
    assert_true(options.size == sizeof options && options.format == NULL);
    assert_int_equal(gonio_material_write(f->context, f->material, "/nonexistent/a.csv", NULL),
                     GONIO_ERROR_IO);
    assert_int_equal(gonio_material_write(f->context, f->material, "/nonexistent/a.csv", &options),
                     GONIO_ERROR_IO);
}

/* Repeats and negative values are refused unless options accept them. */
static void test_no_options_are_the_defaults_of_readings(void **state)
{
    const fixture *f = *state;
    static const gonio_pair pair[2] = {{{0.1, 0.0}, {0.2, 3.0}}, {{0.1, 0.0}, {0.2, 3.0}}};
    static const double value[2] = {-1.0, 1.0};
    gonio_readings_options options;
    gonio_readings_options_default(&options);
    assert_true(options.values_needed);
    for (size_t count = 1; count <= 2; count++) {
        const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                              .count = count,
                                              .channels = 1,
                                              .pair = pair,
                                              .value = count == 1 ? value : NULL};
        gonio_readings *readings = NULL;
        assert_int_equal(gonio_readings_create(f->context, &arrays, NULL, &readings),
                         GONIO_ERROR_DATA);
        assert_int_equal(gonio_readings_create(f->context, &arrays, &options, &readings),
                         GONIO_ERROR_DATA);
        assert_null(readings);
    }
}

/* From rows of the basis too it is posterior for a basis with mixtures, least squares without. */
static void test_the_default_method_depends_on_the_basis(void **state)
{
    const fixture *f = *state;
    static const size_t row[] = {5, 500};
    static const double b[2 * GONIO_CHANNELS] = {1.0, 2.0, 1.0, 2.0, 1.0, 2.0};
    const gonio_basis_options none = {.size = sizeof none, .components = 2, .mixtures = 0};
    gonio_basis *plain = NULL;
    assert_int_equal(gonio_basis_learn(f->context, f->database, &none, &plain), GONIO_OK);
    for (int k = 0; k < 2; k++) {
        gonio_reconstruction *made = NULL;
        assert_int_equal(gonio_reconstruct_rows_with(f->context, k == 0 ? plain : f->basis, NULL,
                                                     row, 2, b, &made),
                         GONIO_OK);
        assert_int_equal(made->field != NULL, k == 1);
        gonio_reconstruction_free(&made);
    }
    gonio_basis_free(&plain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_older_callers_leave_the_defaults),
        cmocka_unit_test(test_newer_callers_fields_are_left_out),
        cmocka_unit_test(test_sizes_that_were_not_set),
        cmocka_unit_test(test_defaults_fit_the_callers_struct),
        cmocka_unit_test(test_every_function_refuses_what_was_not_initialised),
        cmocka_unit_test(test_no_options_are_the_defaults_of_a_context),
        cmocka_unit_test(test_no_options_are_the_defaults_of_a_writer),
        cmocka_unit_test(test_no_options_are_the_defaults_of_readings),
        cmocka_unit_test(test_no_options_are_the_defaults_of_a_plan),
        cmocka_unit_test(test_no_options_are_the_defaults_of_the_next_readings),
        cmocka_unit_test(test_no_options_choose_rows_too),
        cmocka_unit_test(test_no_options_are_the_defaults_of_a_reconstruction),
        cmocka_unit_test(test_the_default_method_depends_on_the_basis),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
