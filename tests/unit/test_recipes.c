/* Recipes against the steps that they stand for; their defaults. */
#include "../support.h"

#include <string.h>

#include <gonio/gonio.h>

#include "learned_basis.h"

/* Learned by the steps that a recipe stands for. */
static gonio_basis *learn_by_steps(const gonio_database_options *grid,
                                   const gonio_basis_options *options)
{
    gonio_database *database = NULL;
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_database_create(NULL, paths, 3, grid, &database), GONIO_OK);
    assert_int_equal(gonio_basis_learn(NULL, database, options, &basis), GONIO_OK);
    gonio_database_free(&database);
    return basis;
}

static void assert_learns(const gonio_recipe *recipe, gonio_basis *expected)
{
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_learn(NULL, paths, 3, recipe, &basis), GONIO_OK);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    assert_true(view->checksum == gonio_basis_describe(expected)->checksum);
    gonio_basis_free(&basis);
    gonio_basis_free(&expected);
}

static void test_recipes(void **state)
{
    (void)state;
    const gonio_database_options papers = {
        .size = sizeof papers, .representation = GONIO_BIVARIATE, .channels = GONIO_JOINT};
    const gonio_database_options relative = {.size = sizeof relative,
                                             .representation = GONIO_BIVARIATE,
                                             .channels = GONIO_SEPARATE,
                                             .mapping = GONIO_LOG_RELATIVE};
    const gonio_basis_options nothing = {.size = sizeof nothing, .components = 0};
    const gonio_basis_options without_mean = {
        .size = sizeof without_mean, .without_mean = true, .components = 4};
    gonio_recipe recipe;
    gonio_recipe_paper(&recipe);
    assert_learns(&recipe, learn_by_steps(&papers, &nothing));
    recipe.channels = GONIO_SEPARATE;
    recipe.mapping = GONIO_LOG_RELATIVE;
    recipe.without_mean = true;
    recipe.components = 4;
    assert_learns(&recipe, learn_by_steps(&relative, &without_mean));
}

/* The library's defaults are one: of the recipe, of no recipe, of databases and of bases. */
static void test_the_default_recipe(void **state)
{
    (void)state;
    gonio_database_options grid;
    gonio_basis_options options;
    gonio_recipe recipe;
    gonio_database_options_default(&grid);
    gonio_basis_options_default(&options);
    gonio_recipe_default(&recipe);
    assert_true(grid.representation == recipe.representation && grid.channels == recipe.channels &&
                grid.mapping == recipe.mapping && options.mixtures == recipe.mixtures &&
                options.components == recipe.components && options.seed == recipe.seed);
    options.mixtures = 20;
    recipe.mixtures = 20;
    if (support_small()) { /* the usual number of mixtures and analytic materials has no code of its
                              own */
        options.analytic = 20;
        recipe.analytic = 20;
    }
    assert_learns(&recipe, learn_by_steps(NULL, &options));
    if (support_small()) {
        return;
    }
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_learn(NULL, paths, 2, NULL, &basis), GONIO_OK);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    assert_true(view->representation == GONIO_SECTORED && view->channels == GONIO_SEPARATE);
    assert_int_equal(view->mixtures, GONIO_DEFAULT_MIXTURES);
    gonio_basis_free(&basis);
}

/* A caller that knows fewer fields gets the default of the others. */
static void test_recipes_of_older_callers(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_basis *basis = NULL;
    gonio_recipe recipe;
    gonio_recipe_paper(&recipe);
    recipe.size = offsetof(gonio_recipe, components);
    recipe.components = 1000; /* not looked at */
    recipe.mixtures = 1;
    recipe.scratch = "/nonexistent";
    assert_int_equal(gonio_learn(context, paths, 3, &recipe, &basis), GONIO_OK);
    assert_int_equal(gonio_basis_describe(basis)->components, 2);
    assert_int_equal(gonio_basis_describe(basis)->mixtures, 0);
    gonio_basis_free(&basis);
    recipe = (gonio_recipe){.size = 0};
    assert_int_equal(gonio_learn(context, paths, 3, &recipe, &basis), GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(support_message(), "gonio_recipe_default"));
    gonio_recipe_default(&recipe);
    assert_int_equal(gonio_learn(context, paths, 0, &recipe, &basis), GONIO_ERROR_ARGUMENT);
    assert_null(basis);
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_recipes),
        cmocka_unit_test(test_the_default_recipe),
        cmocka_unit_test(test_recipes_of_older_callers),
    };
    return cmocka_run_group_tests_name("recipes", tests, NULL, NULL);
}
