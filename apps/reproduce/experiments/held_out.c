/* Trials with the paper's basis, by digests: see held_out.h. */
#include "held_out.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linalg/linalg.h"

gonio_status gonio_i_trial_begin(gonio_context *context, const gonio_i_collection *collection,
                                 const size_t *subset, size_t count, size_t components,
                                 const size_t *test, size_t tests, gonio_i_trial *trial)
{
    const gonio_basis_options options = {
        .size = sizeof options, .components = components, .subset = subset, .subset_count = count};
    *trial = (gonio_i_trial){.collection = collection, .test = test, .tests = tests};
    const gonio_status status =
        gonio_basis_learn(context, collection->database, &options, &trial->basis);
    if (status != GONIO_OK) {
        return status;
    }
    trial->view = gonio_basis_describe(trial->basis);
    const size_t values = trial->view->rows * trial->view->components;
    trial->vectors = gonio_i_allocate(context, values, sizeof *trial->vectors);
    return trial->vectors == NULL ? GONIO_ERROR_MEMORY
                                  : gonio_basis_rows(context, trial->basis, 0, trial->view->rows,
                                                     trial->view->components, trial->vectors);
}

void gonio_i_trial_end(gonio_i_trial *trial)
{
    gonio_basis_free(&trial->basis);
    free(trial->vectors);
    trial->vectors = NULL;
}

/* ---- from coefficients to errors ---- */

/* A noise-free reading of a test material, less the mean. */
static double centred_reading(const gonio_i_trial *t, size_t test, size_t row)
{
    const size_t cell = (size_t)t->view->cell[row / GONIO_CHANNELS];
    return t->collection->mean[t->test[test]][cell * GONIO_CHANNELS + row % GONIO_CHANNELS] -
           t->view->mean[row];
}

/* Column `column` of V C' + m, in all cells. */
static void expand_column(const gonio_i_trial *t, const double *product, size_t column, double *g)
{
    for (int32_t cell = 0; cell < GONIO_CELLS; cell++) {
        const size_t first = gonio_basis_position(t->basis, cell) * GONIO_CHANNELS;
        for (size_t row = first; row < first + GONIO_CHANNELS; row++) {
            g[(size_t)cell * GONIO_CHANNELS + row - first] =
                t->view->mean[row] + product[row * t->tests + column];
        }
    }
}

/* c[tests][components]. */
static gonio_status errors_of(gonio_context *context, const gonio_i_trial *t, const double *c,
                              gonio_error *errors)
{
    double *product = gonio_i_allocate(context, t->view->rows * t->tests, sizeof *product);
    double *g = gonio_i_allocate(context, (size_t)GONIO_CELLS * GONIO_CHANNELS, sizeof *g);
    gonio_status status = product == NULL || g == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = gonio_i_product_transposed(context, t->vectors, t->view->rows, t->view->components,
                                            c, t->tests, product, t->tests);
    }
    for (size_t k = 0; k < t->tests && status == GONIO_OK; k++) {
        expand_column(t, product, k, g);
        status = gonio_i_digest_compare(context, t->collection->digest[t->test[k]], g, &errors[k]);
    }
    free(product);
    free(g);
    return status;
}

/* ---- coefficients ---- */

gonio_status gonio_i_trial_all_rows(gonio_context *context, const gonio_i_trial *trial,
                                    gonio_error *errors)
{
    const size_t components = trial->view->components;
    double *c = gonio_i_allocate(context, trial->tests * components, sizeof *c);
    if (c == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t test = 0; test < trial->tests; test++) {
        for (size_t row = 0; row < trial->view->rows; row++) {
            const double b = centred_reading(trial, test, row);
            for (size_t k = 0; k < components; k++) {
                c[test * components + k] += trial->vectors[row * components + k] * b;
            }
        }
    }
    const gonio_status status = errors_of(context, trial, c, errors);
    free(c);
    return status;
}

/* X and, for each test material, b_X - m_X. */
static void fill_equations(const gonio_i_trial *t, const size_t *rows, size_t count, double *x,
                           double *b)
{
    const size_t components = t->view->components;
    for (size_t i = 0; i < count; i++) {
        memcpy(x + i * components, t->vectors + rows[i] * components, components * sizeof *x);
        for (size_t test = 0; test < t->tests; test++) {
            b[test * count + i] = centred_reading(t, test, rows[i]);
        }
    }
}

gonio_status gonio_i_trial_rows(gonio_context *context, const gonio_i_trial *trial,
                                const size_t *rows, size_t count, gonio_error *errors)
{
    const size_t components = trial->view->components;
    double *x = gonio_i_allocate(context, count * components, sizeof *x);
    double *b = gonio_i_allocate(context, trial->tests * count, sizeof *b);
    double *c = gonio_i_allocate(context, trial->tests * components, sizeof *c);
    size_t rank = 0;
    double condition = 0.0;
    gonio_status status = x == NULL || b == NULL || c == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        fill_equations(trial, rows, count, x, b);
        status = gonio_i_least_squares(context, x, count, components, b, trial->tests, c, &rank,
                                       &condition);
    }
    if (status == GONIO_OK && rank == components) {
        status = errors_of(context, trial, c, errors);
    }
    for (size_t k = 0; k < trial->tests && rank < components; k++) {
        for (int m = 0; m < GONIO_MOST_METRICS; m++) {
            errors[k].value[m] = NAN;
        }
    }
    free(x);
    free(b);
    free(c);
    return status;
}

gonio_status gonio_i_trial_plan(gonio_context *context, const gonio_i_trial *trial,
                                const char *method, size_t samples, uint64_t seed,
                                double *condition, gonio_error *errors)
{
    gonio_plan_options options;
    gonio_selection_report report = {0};
    gonio_plan_options_default(&options);
    options.method = method;
    options.count = samples;
    options.restarts = 1;
    options.seed = seed;
    options.keep_history = false;
    size_t *rows = gonio_i_allocate(context, samples, sizeof *rows);
    gonio_status status = rows == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status =
            gonio_plan_select(context, trial->vectors, trial->view->rows, trial->view->components,
                              trial->view->components, &options, rows, &report);
    }
    if (status == GONIO_OK) {
        *condition = report.condition_number;
        status = gonio_i_trial_rows(context, trial, rows, samples, errors);
    }
    free(report.history);
    free(rows);
    return status;
}

/* ---- a method ---- */

gonio_status gonio_i_trial_method(gonio_context *context, const gonio_i_collection *collection,
                                  const gonio_i_method_entry *method, gonio_i_size size,
                                  const gonio_i_split *split, uint64_t seed, double *condition,
                                  gonio_error *errors)
{
    if (method->representation != GONIO_BIVARIATE || method->channels != GONIO_JOINT ||
        method->mapping != GONIO_LOG || method->without_mean) {
        return gonio_i_trial_tables(context, collection, method, size, split, seed, condition,
                                    errors);
    }
    gonio_i_trial trial;
    gonio_status status =
        gonio_i_trial_begin(context, collection, split->basis, split->basis_count, size.components,
                            split->test, split->test_count, &trial);
    if (status == GONIO_OK) {
        status = gonio_i_trial_plan(context, &trial, method->plan, size.samples, seed, condition,
                                    errors);
    }
    gonio_i_trial_end(&trial);
    return status;
}
