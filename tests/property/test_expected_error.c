/* Plans of least expected error against plain dense algebra: what remains, brute force, single
 * exchanges, prefixes; and on a basis: candidates, targets, the methods' defaults. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../unit/made_basis.h"
#include "core/random.h"
#include "plan/expected_error_choices.h"
#include "plan/expected_error_search.h"
#include "prior/after_readings.h"

/* Where threads are not the question: on so small problems they would only wait for each other. */
static gonio_context *one_thread;

enum { MOST_K = 8, MOST_ROWS = 80 };

typedef struct problem {
    size_t rows, k;
    float f[MOST_ROWS * MOST_K];
    double loss[MOST_ROWS];
    bool allowed[MOST_ROWS];
    double covariance[MOST_K * MOST_K];
    bool plain; /* the covariance is I */
    double variance;
} problem;

/* Rows of lengths over a decade, one in five not allowed; a full covariance, or I for each third
 * seed. */
static problem make_problem(size_t rows, size_t k, uint64_t seed)
{
    problem p = {.rows = rows, .k = k, .plain = seed % 3 == 2, .variance = 0.01};
    gonio_i_random random;
    gonio_i_random_seed(&random, seed, 0);
    for (size_t i = 0; i < rows; i++) {
        const double length = exp(-2.0 * gonio_i_random_uniform(&random));
        for (size_t j = 0; j < k; j++) {
            p.f[i * k + j] = (float)(length * gonio_i_random_normal(&random) / (1.0 + (double)j));
        }
        p.loss[i] = gonio_i_random_uniform(&random);
        p.allowed[i] = i % 5 != 3;
    }
    double root[MOST_K * MOST_K];
    for (size_t i = 0; i < k * k; i++) {
        root[i] = p.plain ? 0.0 : 0.3 * gonio_i_random_normal(&random);
    }
    for (size_t a = 0; a < k; a++) {
        for (size_t b = 0; b < k; b++) {
            p.covariance[a * k + b] = a == b ? 1.0 : 0.0;
            for (size_t c = 0; c < k; c++) {
                p.covariance[a * k + b] += root[a * k + c] * root[b * k + c];
            }
        }
    }
    return p;
}

/* a becomes its inverse (Gauss and Jordan); a is symmetric and positive. */
static void invert(long double *a, size_t n)
{
    for (size_t c = 0; c < n; c++) {
        const long double pivot = a[c * n + c];
        assert_true(pivot > 0.0L);
        a[c * n + c] = 1.0L;
        for (size_t j = 0; j < n; j++) {
            a[c * n + j] /= pivot;
        }
        for (size_t i = 0; i < n; i++) {
            const long double factor = a[i * n + c];
            if (i != c) {
                a[i * n + c] = 0.0L;
                for (size_t j = 0; j < n; j++) {
                    a[i * n + j] -= factor * a[c * n + j];
                }
            }
        }
    }
}

/* sum_x w(x) f(x) P f(x)', P = (C^-1 + F'F/sigma^2)^-1. */
static double left_by(const problem *p, const size_t *chosen, size_t n)
{
    const size_t k = p->k;
    long double a[MOST_K * MOST_K];
    for (size_t i = 0; i < k * k; i++) {
        a[i] = (long double)p->covariance[i];
    }
    invert(a, k);
    for (size_t j = 0; j < n; j++) {
        const float *f = p->f + chosen[j] * k;
        for (size_t i = 0; i < k * k; i++) {
            a[i] += (long double)f[i / k] * (long double)f[i % k] / (long double)p->variance;
        }
    }
    invert(a, k);
    long double sum = 0.0L;
    for (size_t x = 0; x < p->rows; x++) {
        const float *f = p->f + x * k;
        for (size_t i = 0; i < k * k; i++) {
            sum += (long double)p->loss[x] * (long double)f[i / k] * a[i] * (long double)f[i % k];
        }
    }
    return (double)sum;
}

/* Returns how many readings were found. */
static size_t find_enough(gonio_context *context, const problem *p, size_t count, double enough,
                          size_t *chosen, double *remaining)
{
    size_t found = 0;
    const gonio_i_expected_error_problem given = {.context = context,
                                                  .f = p->f,
                                                  .rows = p->rows,
                                                  .components = p->k,
                                                  .covariance = p->plain ? NULL : p->covariance,
                                                  .loss = p->loss,
                                                  .allowed = p->allowed,
                                                  .variance = p->variance,
                                                  .count = count,
                                                  .enough = enough};
    assert_int_equal(gonio_i_expected_error_search(&given, chosen, remaining, &found), GONIO_OK);
    return found;
}

static void find(gonio_context *context, const problem *p, size_t count, size_t *chosen,
                 double *remaining)
{
    assert_int_equal(find_enough(context, p, count, 0.0, chosen, remaining), count);
}

static bool holds(const size_t *chosen, size_t n, size_t row)
{
    for (size_t j = 0; j < n; j++) {
        if (chosen[j] == row) {
            return true;
        }
    }
    return false;
}

static void test_what_remains(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) {
        const problem p = make_problem(70, 2 + seed, seed);
        size_t chosen[40];
        double remaining[41];
        find(one_thread, &p, 40, chosen, remaining);
        for (size_t n = 1; n <= 40; n++) {
            const double expected = left_by(&p, chosen, n);
            assert_true(fabs(remaining[n] - expected) <= 1e-10 * expected);
            assert_true(n == 1 || remaining[n] <= remaining[n - 1]);
            assert_true(p.allowed[chosen[n - 1]]);
            assert_false(holds(chosen, n - 1, chosen[n - 1]));
        }
    }
}

/* A search that ends when little enough is left finds the first readings of one that goes on. */
static void test_enough(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) {
        const problem p = make_problem(70, 2 + seed, seed);
        size_t all[40];
        size_t chosen[40];
        double remaining[41];
        double left[41];
        find(one_thread, &p, 40, all, remaining);
        size_t before = 0;
        for (size_t n = 1; n < 30; n++) {
            const double enough = 1.001 * remaining[n];
            const size_t found = find_enough(one_thread, &p, 40, enough, chosen, left);
            assert_true(found >= n && found >= before && found <= 40);
            assert_true(left[found] < enough);
            assert_memory_equal(chosen, all, found * sizeof *all);
            assert_memory_equal(left, remaining, (found + 1) * sizeof *left);
            before = found;
        }
        assert_true(find_enough(one_thread, &p, 40, 1.001 * remaining[1], chosen, left) < 40);
    }
}

/* The least that any choice of `count` rows, `first` or later, leaves. */
static double best_of_all(const problem *p, size_t *trial, size_t done, size_t count, size_t first)
{
    if (done == count) {
        return left_by(p, trial, count);
    }
    double best = INFINITY;
    for (size_t row = first; row < p->rows; row++) {
        if (p->allowed[row]) {
            trial[done] = row;
            best = fmin(best, best_of_all(p, trial, done + 1, count, row + 1));
        }
    }
    return best;
}

static void test_against_all_choices(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 8; seed++) {
        const problem p = make_problem(16, 4, seed);
        for (size_t n = 1; n <= 4; n++) {
            size_t chosen[4];
            size_t trial[4];
            double remaining[5];
            find(one_thread, &p, n, chosen, remaining);
            const double best = best_of_all(&p, trial, 0, n, 0);
            assert_true(remaining[n] >= best * (1.0 - 1e-9));
            /* One reading is the best; a few, after exchanges, nearly so. */
            assert_true(remaining[n] <= best * (n == 1 ? 1.0 + 1e-9 : 1.05));
        }
    }
}

/* No exchange of a reading of the last block for another row leaves less: blocks end at 5, 10, 20.
 */
static void test_no_exchange_helps(void **state)
{
    (void)state;
    static const size_t blocks[][2] = {{0, 5}, {5, 10}, {10, 20}};
    for (uint64_t seed = 0; seed < 8; seed++) {
        const problem p = make_problem(60, 6, seed);
        size_t chosen[20];
        double remaining[21];
        find(one_thread, &p, 20, chosen, remaining);
        for (size_t b = 0; b < 3; b++) {
            const size_t end = blocks[b][1];
            size_t trial[20];
            memcpy(trial, chosen, sizeof trial);
            for (size_t i = blocks[b][0]; i < end; i++) {
                for (size_t row = 0; row < p.rows; row++) {
                    if (p.allowed[row] && !holds(chosen, end, row)) {
                        trial[i] = row;
                        assert_true(left_by(&p, trial, end) >= remaining[end] * (1.0 - 1e-9));
                    }
                }
                trial[i] = chosen[i];
            }
        }
    }
}

static void test_prefixes_and_threads(void **state)
{
    (void)state;
    const problem p = make_problem(80, 8, 3);
    size_t long_plan[40];
    double remaining[41];
    find(one_thread, &p, 40, long_plan, remaining);
    for (size_t n = 5; n <= 20; n *= 2) {
        size_t chosen[20];
        find(one_thread, &p, n, chosen, NULL);
        assert_memory_equal(chosen, long_plan, n * sizeof *chosen);
    }
    for (int threads = 1; threads <= 3; threads += 2) {
        const gonio_context_options options = {.size = sizeof options, .threads = threads};
        gonio_context *context = NULL;
        size_t chosen[40];
        assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
        find(context, &p, 40, chosen, NULL);
        assert_memory_equal(chosen, long_plan, sizeof chosen);
        gonio_context_free(&context);
    }
    /* All that is allowed. */
    size_t all[64];
    find(one_thread, &p, 64, all, NULL);
    for (size_t row = 0; row < 80; row++) {
        assert_int_equal(holds(all, 64, row), p.allowed[row]);
    }
}

/* ---- on a basis ---- */

static gonio_basis *basis;

static int set_up(void **state)
{
    (void)state;
    const gonio_context_options options = {.size = sizeof options, .threads = 1};
    assert_int_equal(gonio_context_create(&one_thread, &options), GONIO_OK);
    basis = made_basis(one_thread, GONIO_BIVARIATE, GONIO_SEPARATE, 0);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    gonio_basis_free(&basis);
    gonio_context_free(&one_thread);
    return 0;
}

static gonio_plan_options options_for(size_t count)
{
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    options.count = count;
    return options;
}

static gonio_plan *plan_with(const gonio_plan_options *options)
{
    gonio_plan *plan = NULL;
    assert_int_equal(gonio_plan_create(one_thread, basis, options, &plan), GONIO_OK);
    return plan;
}

static void test_plans_are_nested_and_say_what_to_expect(void **state)
{
    (void)state;
    for (int metric = GONIO_E6; metric <= GONIO_LOG_RELATIVE_ERROR; metric++) {
        gonio_plan_options options = options_for(20);
        options.metric = (gonio_metric)metric;
        gonio_plan *plan = plan_with(&options);
        assert_string_equal(plan->method, "expected-error");
        assert_int_equal(plan->count, 20);
        for (size_t k = 0; k < plan->count; k++) {
            assert_true(isfinite(plan->expected[k]) && plan->expected[k] > 0.0);
            assert_true(k == 0 || plan->expected[k] <= plan->expected[k - 1]);
            assert_true(plan->entries[k].pair.incident.theta < M_PI / 2.0);
            assert_true(plan->entries[k].pair.outgoing.theta < M_PI / 2.0);
        }
        options.count = 10;
        gonio_plan *half = plan_with(&options);
        for (size_t k = 0; k < half->count; k++) {
            assert_int_equal(half->entries[k].cell, plan->entries[k].cell);
            assert_true(fabs(half->expected[k] - plan->expected[k]) <= 1e-9 * plan->expected[k]);
        }
        gonio_plan_free(&half);
        gonio_plan_free(&plan);
    }
}

static void test_metrics_differ(void **state)
{
    (void)state;
    gonio_plan_options options = options_for(10);
    gonio_plan *plain = plan_with(&options);
    for (int metric = GONIO_CUBE_ROOT; metric <= GONIO_LOG_RELATIVE_ERROR; metric++) {
        options.metric = (gonio_metric)metric;
        gonio_plan *other = plan_with(&options);
        bool differ = false;
        for (size_t k = 0; k < 10; k++) {
            differ = differ || other->entries[k].cell != plain->entries[k].cell;
        }
        assert_true(differ);
        gonio_plan_free(&other);
    }
    gonio_plan_free(&plain);
}

static void test_the_fewest_readings_for_a_target(void **state)
{
    (void)state;
    gonio_plan_options options = options_for(40);
    gonio_plan *all = plan_with(&options);
    for (size_t n = 1; n <= 30; n += 7) {
        options.target = 1.0000001 * all->expected[n - 1];
        gonio_plan *plan = plan_with(&options);
        assert_true(plan->count <= n);
        assert_true(plan->expected[plan->count - 1] <= options.target);
        assert_true(plan->count == 1 || all->expected[plan->count - 2] > options.target);
        for (size_t k = 0; k < plan->count; k++) {
            assert_int_equal(plan->entries[k].cell, all->entries[k].cell);
        }
        gonio_plan_free(&plan);
    }
    options.target = 0.5 * all->expected[39];
    gonio_context *context = support_context();
    gonio_plan *none = NULL;
    assert_int_equal(gonio_plan_create(context, basis, &options, &none), GONIO_ERROR_ARGUMENT);
    assert_null(none);
    assert_non_null(strstr(support_message(), "above the target of"));
    gonio_context_free(&context);
    gonio_plan_free(&all);
}

enum { CANDIDATES = 30 };

static void make_candidates(gonio_pair pairs[CANDIDATES])
{
    gonio_i_random random;
    gonio_i_random_seed(&random, 5, 0);
    for (size_t k = 0; k < CANDIDATES; k++) {
        pairs[k] = (gonio_pair){
            {1.4 * gonio_i_random_uniform(&random), 6.0 * gonio_i_random_uniform(&random)},
            {1.4 * gonio_i_random_uniform(&random), 6.0 * gonio_i_random_uniform(&random)}};
    }
}

static void test_candidates(void **state)
{
    (void)state;
    gonio_pair pairs[CANDIDATES];
    make_candidates(pairs);
    gonio_plan_options options = options_for(12);
    options.candidates = pairs;
    options.candidate_count = CANDIDATES;
    gonio_plan *plan = plan_with(&options);
    bool used[CANDIDATES] = {false};
    assert_int_equal(plan->count, 12);
    for (size_t k = 0; k < plan->count; k++) {
        size_t which = 0;
        while (which < CANDIDATES &&
               memcmp(&pairs[which], &plan->entries[k].pair, sizeof pairs[which]) != 0) {
            which++;
        }
        assert_true(which < CANDIDATES && !used[which]);
        used[which] = true;
        assert_int_equal(plan->entries[k].channel, GONIO_ALL_CHANNELS);
        assert_true(isfinite(plan->expected[k]));
    }
    gonio_plan_free(&plan);
    options.count = CANDIDATES;
    plan = plan_with(&options);
    assert_int_equal(plan->count, CANDIDATES);
    gonio_plan_free(&plan);
    options.count = CANDIDATES + 1;
    gonio_context *context = support_context();
    assert_int_equal(gonio_plan_create(context, basis, &options, &plan), GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(support_message(), "only 30 directions to choose from"));
    options.count = 5;
    options.candidate_count = 100001;
    assert_int_equal(gonio_plan_create(context, basis, &options, &plan), GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(support_message(), "100001 candidates are more than 100000"));
    gonio_context_free(&context);
}

/* The method that suits the basis; and condition, which is what it is for the bare rows. */
static void test_methods(void **state)
{
    (void)state;
    const gonio_basis_view *view = gonio_basis_describe(basis);
    gonio_plan_options options = options_for(8);
    options.method = "condition";
    options.components = 4;
    options.restarts = 2;
    gonio_plan *plan = plan_with(&options);
    size_t rows[8];
    size_t chosen[8];
    gonio_selection_report report;
    assert_int_equal(gonio_plan_rows(NULL, plan, basis, rows), GONIO_OK);
    double *vectors = support_vectors(basis);
    assert_int_equal(gonio_plan_select(one_thread, vectors, view->rows, view->components, 4,
                                       &options, chosen, &report),
                     GONIO_OK);
    assert_memory_equal(rows, chosen, sizeof rows);
    assert_true(plan->condition_number == report.condition_number);
    assert_null(plan->expected);
    free(report.history);
    free(vectors);
    gonio_plan_free(&plan);

    gonio_database *database = made_database(GONIO_BIVARIATE, GONIO_JOINT);
    gonio_basis *papers = NULL;
    assert_int_equal(gonio_basis_learn(one_thread, database, NULL, &papers), GONIO_OK);
    options = options_for(4);
    assert_int_equal(gonio_plan_create(one_thread, papers, &options, &plan), GONIO_OK);
    assert_string_equal(plan->method, "condition");
    gonio_plan_free(&plan);
    gonio_basis_free(&papers);
    gonio_database_free(&database);
    assert_string_equal(gonio_plan_method_reconstruction("expected-error"), "posterior");
    assert_string_equal(gonio_plan_method_reconstruction("condition"), "least-squares");
}

/* I - f' (f f' + v I)^-1 f is (I + f' f / v)^-1. */
static void test_covariance_after_readings(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        const problem p = make_problem(2 + seed, MOST_K, seed);
        double f[MOST_ROWS * MOST_K];
        double covariance[MOST_K * MOST_K];
        long double direct[MOST_K * MOST_K];
        for (size_t i = 0; i < p.rows * p.k; i++) {
            f[i] = (double)p.f[i];
        }
        for (size_t a = 0; a < p.k * p.k; a++) {
            direct[a] = a % (p.k + 1) == 0 ? 1.0L : 0.0L;
            for (size_t i = 0; i < p.rows; i++) {
                direct[a] += (long double)f[i * p.k + a / p.k] * f[i * p.k + a % p.k] / p.variance;
            }
        }
        invert(direct, p.k);
        assert_int_equal(
            gonio_i_covariance_after(one_thread, f, p.rows, p.k, p.variance, covariance), GONIO_OK);
        for (size_t a = 0; a < p.k * p.k; a++) {
            assert_true(fabs(covariance[a] - (double)direct[a]) < 1e-10);
        }
    }
}

static double variance_at(const gonio_i_choices *p, size_t row)
{
    const size_t k = p->components;
    const float *f = p->f + row * k;
    double sum = 0.0;
    for (size_t a = 0; a < k; a++) {
        for (size_t b = 0; b < k && p->covariance != NULL; b++) {
            sum += (double)f[a] * p->covariance[a * k + b] * (double)f[b];
        }
        sum += p->covariance == NULL ? (double)f[a] * (double)f[a] : 0.0;
    }
    return sum;
}

/* After readings the choices are those of a plan with the remainder that they chose, of which less
 * is left near what was read. */
static void test_after_readings_of_a_material(void **state)
{
    (void)state;
    gonio_pair pairs[CANDIDATES];
    make_candidates(pairs);
    const gonio_half_difference read[2] = {gonio_half_difference_from_pair(pairs[0]),
                                           gonio_half_difference_from_pair(pairs[7])};
    const gonio_i_known known = {.read = read,
                                 .count = 2,
                                 .goes_on = true,
                                 .alpha = 0.2, /* as of a plan */
                                 .peak = 8.0};
    gonio_plan_options options = options_for(4);
    options.candidates = pairs;
    options.candidate_count = CANDIDATES;
    gonio_i_choices before = {.context = one_thread};
    gonio_i_choices after = {.context = one_thread, .known = &known};
    assert_int_equal(gonio_i_prior_create(one_thread, basis, &before.prior), GONIO_OK);
    assert_int_equal(gonio_i_prior_create(one_thread, basis, &after.prior), GONIO_OK);
    assert_int_equal(gonio_i_choices_of_candidates(&before, &options), GONIO_OK);
    assert_int_equal(gonio_i_choices_of_candidates(&after, &options), GONIO_OK);
    assert_int_equal(gonio_i_choices_leave_out_read(&after), GONIO_OK);
    assert_int_equal(after.rows, CANDIDATES + 2);
    assert_false(after.allowed[0] || after.allowed[7] || after.allowed[CANDIDATES] ||
                 after.allowed[CANDIDATES + 1]);
    const double noise = before.noise * before.noise;
    for (size_t row = 0; row < CANDIDATES; row++) {
        const double prior = variance_at(&before, row);
        const double left = variance_at(&after, row);
        assert_true(left <= prior * (1.0 + 1e-3) && left > 0.0);
        assert_true((row != 0 && row != 7) || left <= noise);
    }
    gonio_i_choices_free(&before);
    gonio_i_choices_free(&after);
}

static gonio_i_choices choices_after(const gonio_plan_options *options, const gonio_i_known *known)
{
    gonio_i_choices p = {.context = one_thread, .known = known};
    assert_int_equal(gonio_i_prior_create(one_thread, basis, &p.prior), GONIO_OK);
    assert_int_equal(gonio_i_choices_of_candidates(&p, options), GONIO_OK);
    return p;
}

/* A larger remainder leaves more to expect where nothing was read, and narrow peaks more at the
 * mirror direction. */
static void test_the_remainder_that_readings_chose(void **state)
{
    (void)state;
    gonio_pair pairs[CANDIDATES];
    make_candidates(pairs);
    pairs[1] = (gonio_pair){{0.5, 0.0}, {0.5, 3.141592653589793}};
    const gonio_half_difference read[1] = {gonio_half_difference_from_pair(pairs[0])};
    const gonio_i_known known[3] = {
        {.read = read, .count = 1, .goes_on = true, .alpha = 0.1},
        {.read = read, .count = 1, .goes_on = true, .alpha = 0.4},
        {.read = read, .count = 1, .goes_on = true, .alpha = 0.4, .peak = 8.0}};
    gonio_plan_options options = options_for(4);
    options.candidates = pairs;
    options.candidate_count = CANDIDATES;
    gonio_i_choices p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = choices_after(&options, &known[k]);
        p[k].known = NULL;
        p[k].covariance = NULL; /* the prior's */
    }
    for (size_t row = 0; row < CANDIDATES; row++) {
        assert_true(variance_at(&p[1], row) > variance_at(&p[0], row) + 0.1);
    }
    assert_true(variance_at(&p[2], 1) > variance_at(&p[1], 1) + 0.4);
    for (int k = 0; k < 3; k++) {
        gonio_i_choices_free(&p[k]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_remains),
        cmocka_unit_test(test_enough),
        cmocka_unit_test(test_against_all_choices),
        cmocka_unit_test(test_no_exchange_helps),
        cmocka_unit_test(test_prefixes_and_threads),
        cmocka_unit_test(test_plans_are_nested_and_say_what_to_expect),
        cmocka_unit_test(test_metrics_differ),
        cmocka_unit_test(test_the_fewest_readings_for_a_target),
        cmocka_unit_test(test_candidates),
        cmocka_unit_test(test_covariance_after_readings),
        cmocka_unit_test(test_after_readings_of_a_material),
        cmocka_unit_test(test_the_remainder_that_readings_chose),
        cmocka_unit_test(test_methods),
    };
    return cmocka_run_group_tests_name("expected error", tests, set_up, tear_down);
}
