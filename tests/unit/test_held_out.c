/* Trials by digests and by whole tables are the same; splits. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "experiments/splits.h"
#include "experiments/held_out.h"

/* With grey ones, whose channels are the same column twice. */
static const char *const paths[] = {"atlas:gold-polished", "atlas:oak-sawn",    "atlas:red-cotton",
                                    "atlas:grey-flannel",  "atlas:brass-satin", "atlas:grey-primer",
                                    "atlas:navy-lacquer",  "atlas:jade-carved"};

enum { PATHS = sizeof paths / sizeof *paths };

/* One thread: on a busy machine several that wait for each other take many times as long. */
static gonio_context *context;
static gonio_i_collection collection;
static gonio_i_splits splits;

static int set_up(void **state)
{
    (void)state;
    const gonio_context_options options = {.size = sizeof options, .threads = 1};
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    assert_int_equal(gonio_i_collect(context, paths, PATHS, false, &collection), GONIO_OK);
    assert_int_equal(gonio_i_splits_make(context, &collection, 10, 3, &splits), GONIO_OK);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    gonio_i_splits_free(&splits);
    gonio_i_collection_free(&collection);
    gonio_context_free(&context);
    return 0;
}

static void assert_close(double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fabs(expected))) {
        fail_msg("%.17g where %.17g is expected (relative %g)", value, expected, relative);
    }
}

static void assert_same_error(gonio_error a, gonio_error b)
{
    const gonio_metric sizes[] = {GONIO_E6, GONIO_CUBE_ROOT, GONIO_LOG_RELATIVE_ERROR};
    for (size_t m = 0; m < sizeof sizes / sizeof *sizes; m++) {
        assert_close(a.value[sizes[m]], b.value[sizes[m]], 1e-6);
    }
    assert_true(fabs(a.value[GONIO_BIAS] - b.value[GONIO_BIAS]) <= 1e-5 * a.value[GONIO_E6]);
}

/* For all methods of the paper's basis. The tables' way learns from the split alone, and so from
 * the same cells here, where no material has holes. */
static void test_digests_and_tables_agree(void **state)
{
    (void)state;
    const gonio_i_size size = {4, 12};
    const gonio_i_split *split = &splits.split[0];
    const gonio_i_study quick = {.quick = true}; /* without the methods of the full grid */
    for (size_t m = 0; m < gonio_i_methods(&quick); m += support_small() ? 6 : 3) {
        const gonio_i_method_entry *method = gonio_i_method_at(m);
        gonio_error *errors[2];
        double condition[2] = {NAN, NAN};
        for (int k = 0; k < 2; k++) {
            errors[k] = calloc(split->test_count, sizeof **errors);
            assert_int_equal((k == 0 ? gonio_i_trial_method
                                     : gonio_i_trial_tables)(context, &collection, method, size,
                                                             split, 1, &condition[k], errors[k]),
                             GONIO_OK);
        }
        assert_close(condition[0], condition[1], 1e-9);
        for (size_t t = 0; t < split->test_count; t++) {
            assert_same_error(errors[0][t], errors[1][t]);
            assert_true(errors[0][t].value[GONIO_E6] > 0.0);
        }
        free(errors[0]);
        free(errors[1]);
    }
}

/* Other bases go by tables. */
static void test_other_bases(void **state)
{
    (void)state;
    const gonio_i_size size = {3, 20};
    const gonio_i_split *split = &splits.split[1];
    gonio_i_method_entry method = *gonio_i_method_at(GONIO_I_CHOSEN);
    gonio_error *errors = calloc(split->test_count, sizeof *errors);
    for (int k = 0; k < (support_small() ? 2 : 3); k++) {
        double condition = NAN;
        method.representation = k == 0 ? GONIO_BIVARIATE : GONIO_FULL;
        method.channels = k == 2 ? GONIO_JOINT : GONIO_SEPARATE;
        assert_int_equal(
            gonio_i_trial_method(context, &collection, &method, size, split, 1, &condition, errors),
            GONIO_OK);
        assert_true(condition >= 1.0);
        for (size_t t = 0; t < split->test_count; t++) {
            assert_true(errors[t].value[GONIO_E6] > 0.0 && errors[t].value[GONIO_E6] < 1000.0);
        }
    }
    free(errors);
}

/* The methods of the full grid, whose sizes follow the materials. */
static void test_compared_methods(void **state)
{
    (void)state;
    const gonio_i_split *split = &splits.split[0];
    const gonio_i_study quick = {.quick = true, .splits = splits};
    const gonio_i_study full = {.splits = splits};
    gonio_error *errors = calloc(split->test_count, sizeof *errors);
    assert_true(gonio_i_methods(&full) == gonio_i_methods(&quick) + 3);
    /* The last two are run below too. */
    const size_t end = gonio_i_methods(&quick) + (support_small() ? 1 : 3);
    for (size_t m = gonio_i_methods(&quick); m < end; m++) {
        const gonio_i_method_entry *method = gonio_i_method_at(m);
        const gonio_i_size size = gonio_i_method_size(&full, method);
        double condition = NAN;
        assert_true(size.components <= split->basis_count);
        assert_true(size.samples >= size.components);
        assert_int_equal(
            gonio_i_trial_method(context, &collection, method, size, split, 1, &condition, errors),
            GONIO_OK);
        assert_true(condition >= 1.0);
        for (size_t t = 0; t < split->test_count; t++) {
            assert_true(errors[t].value[GONIO_E6] > 0.0 && errors[t].value[GONIO_E6] < 200.0);
        }
    }
    free(errors);
}

/* One after the other on what is left in the cache, or each on an empty one; and a basis of other
 * materials is another one. */
static void test_what_is_shared_changes_nothing(void **state)
{
    (void)state;
    const gonio_i_study full = {.splits = splits};
    const size_t last = gonio_i_methods(&full) - 1;
    gonio_error errors[2][PATHS];
    for (int alone = 0; alone < 2; alone++) {
        for (size_t m = last - 1; m <= last; m++) {
            const gonio_i_method_entry *method = gonio_i_method_at(m);
            const size_t s = alone ? 0 : last - m; /* at last split 0 in both cases */
            double condition = NAN;
            if (alone) {
                gonio_i_basis_cache_clear(collection.cache);
            }
            assert_int_equal(gonio_i_trial_method(context, &collection, method,
                                                  gonio_i_method_size(&full, method),
                                                  &splits.split[s], 1, &condition, errors[alone]),
                             GONIO_OK);
        }
    }
    assert_memory_equal(errors[0], errors[1], splits.split[0].test_count * sizeof(gonio_error));
}

/* The cache learns only what it does not have. */
static void test_basis_cache(void **state)
{
    (void)state;
    gonio_i_basis_cache cache = {0};
    const size_t subsets[2][3] = {{0, 1, 2}, {0, 1, 3}};
    const gonio_database_options how = {.size = sizeof how};
    gonio_basis_options options = {
        .size = sizeof options, .components = 2, .subset = subsets[0], .subset_count = 3};
    const gonio_basis *basis[4];
    uint64_t fingerprint[4];
    for (int k = 0; k < 4; k++) {
        options.subset = subsets[k / 2 % 2];
        options.without_mean = k == 3;
        assert_int_equal(
            gonio_i_basis_cache_learn(context, &cache, paths, PATHS, &how, &options, &basis[k]),
            GONIO_OK);
        fingerprint[k] = gonio_basis_describe(basis[k])->checksum;
        assert_int_equal(gonio_basis_describe(basis[k])->without_mean, k == 3);
        if (k == 1) {
            assert_ptr_equal(basis[0], basis[1]);
        }
    }
    assert_true(fingerprint[0] == fingerprint[1]);
    assert_true(fingerprint[1] != fingerprint[2]);
    assert_true(fingerprint[2] != fingerprint[3]);
    gonio_i_basis_cache_clear(&cache);
    assert_null(cache.basis);
}

/* Least squares from all rows is V'(b - m). */
static void test_all_rows(void **state)
{
    (void)state;
    const gonio_i_split *split = &splits.split[0];
    gonio_i_trial trial;
    gonio_error by_product = {0};
    gonio_error by_solving = {0};
    assert_int_equal(gonio_i_trial_begin(context, &collection, split->basis, split->basis_count, 4,
                                         split->test, 1, &trial),
                     GONIO_OK);
    size_t *rows = calloc(trial.view->rows, sizeof *rows);
    for (size_t k = 0; k < trial.view->rows; k++) {
        rows[k] = k;
    }
    assert_int_equal(gonio_i_trial_all_rows(context, &trial, &by_product), GONIO_OK);
    assert_int_equal(gonio_i_trial_rows(context, &trial, rows, trial.view->rows, &by_solving),
                     GONIO_OK);
    assert_same_error(by_product, by_solving);
    rows[3] = rows[0];
    rows[2] = rows[0];
    assert_int_equal(gonio_i_trial_rows(context, &trial, rows, 4, &by_solving), GONIO_OK);
    assert_true(isnan(by_solving.value[GONIO_E6])); /* two independent rows for four components */
    free(rows);
    gonio_i_trial_end(&trial);
}

static void test_splits_are_splits(void **state)
{
    (void)state;
    bool differ = false;
    for (size_t s = 0; s < splits.count; s++) {
        const gonio_i_split *split = &splits.split[s];
        int seen[PATHS] = {0};
        assert_int_equal(split->basis_count, 6);
        assert_int_equal(split->test_count, 2);
        for (size_t k = 0; k < split->basis_count; k++) {
            seen[split->basis[k]]++;
        }
        for (size_t k = 0; k < split->test_count; k++) {
            seen[split->test[k]]++;
            differ = differ || split->test[k] != splits.split[0].test[k];
        }
        for (size_t k = 0; k < PATHS; k++) {
            assert_int_equal(seen[k], 1);
        }
    }
    assert_true(differ);
    gonio_i_splits again;
    assert_int_equal(gonio_i_splits_make(context, &collection, 10, 3, &again), GONIO_OK);
    for (size_t s = 0; s < splits.count; s++) {
        assert_memory_equal(again.split[s].test, splits.split[s].test, 2 * sizeof(size_t));
    }
    gonio_i_splits_free(&again);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_digests_and_tables_agree),
        cmocka_unit_test(test_other_bases),
        cmocka_unit_test(test_compared_methods),
        cmocka_unit_test(test_all_rows),
        cmocka_unit_test(test_what_is_shared_changes_nothing),
        cmocka_unit_test(test_basis_cache),
        cmocka_unit_test(test_splits_are_splits),
    };
    return cmocka_run_group_tests_name("trial", tests, set_up, tear_down);
}
