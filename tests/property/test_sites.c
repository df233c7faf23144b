/* Sites that columns share, and fits over them, are bit for bit those made for each column. */
#include "posterior_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { SITES = 9, SHARING = 7 };

/* The readings of a material as columns of other values; the last one lacks a reading. */
typedef struct shared {
    gonio_i_observation reading[SHARING][SITES];
    gonio_i_column column[SHARING];
} shared;

static void share(const drawn *d, shared *s)
{
    for (size_t c = 0; c < SHARING; c++) {
        s->column[c] = (gonio_i_column){c + 1 < SHARING ? SITES : SITES - 1, s->reading[c]};
        for (size_t i = 0; i < SITES; i++) {
            s->reading[c][i] = d->reading[i];
            s->reading[c][i].g *= 1.0 + 0.1 * (double)c;
            s->reading[c][i].variance *= 1.0 + 0.3 * (double)c;
            s->reading[c][i].channel = (int)c;
        }
    }
    s->reading[2][3].bound = 1;
    s->reading[3][4].bound = -1;
}

/* Columns that were read at the same directions share their sites, whatever was read. */
static void test_sites_are_shared(void **state)
{
    (void)state;
    drawn d = draw(7, 0.1);
    shared s;
    gonio_i_sites *sites[SHARING];
    size_t group[SHARING];
    share(&d, &s);
    s.reading[1][5].at.phi_d += 1e-12; /* not the same direction */
    assert_int_equal(
        gonio_i_sites_share(fixture.context, fixture.mixture, s.column, SHARING, sites), GONIO_OK);
    assert_int_equal(gonio_i_sites_group(fixture.mixture, s.column, SHARING, group), 3);
    for (size_t c = 0; c < SHARING; c++) {
        const bool alone = c == 1 || c == SHARING - 1;
        assert_int_equal(group[c], c == 1 ? 1 : alone ? 2 : 0);
        assert_true((sites[c] == sites[0]) == !alone);
        assert_int_equal(sites[c]->n, s.column[c].count);
        for (size_t j = 0; j < c; j++) {
            assert_true((sites[c] == sites[j]) == (group[c] == group[j]));
        }
    }
    gonio_i_sites_release(sites, SHARING);
    for (size_t c = 0; c < SHARING; c++) {
        assert_null(sites[c]);
    }
    free(d.z);
}

static void assert_same_fit(const gonio_i_fit *a, const gonio_i_fit *b)
{
    assert_int_equal(a->n, b->n);
    assert_memory_equal(a->y, b->y, a->n * sizeof *a->y);
    assert_memory_equal(a->variance, b->variance, a->n * sizeof *a->variance);
    assert_memory_equal(a->left_out, b->left_out, a->n * sizeof *a->left_out);
    assert_memory_equal(a->lower, b->lower, a->n * a->n * sizeof *a->lower);
    assert_memory_equal(a->weight, b->weight, a->samples * sizeof *a->weight);
    assert_memory_equal(a->centre, b->centre, a->components * sizeof *a->centre);
    assert_memory_equal(a->solved, b->solved, a->n * sizeof *a->solved);
    assert_memory_equal(&a->evidence, &b->evidence, sizeof a->evidence);
}

/* A fit over shared sites, in which other values were before, is bit for bit one over sites of its
 * own; and it leaves the sites as they were. */
static void test_fits_of_shared_sites(void **state)
{
    (void)state;
    const gonio_i_model models[] = {{GONIO_I_KERNEL_WIDTH, ALPHA, PEAK, 0.0}, {1.0, 0.5, 0.0, 0.0}};
    drawn d = draw(7, 0.1);
    shared s;
    share(&d, &s);
    gonio_i_sites *sites = NULL;
    gonio_i_sites *untouched = NULL;
    gonio_i_fit fit = begin_fit(fixture.mixture, &s.column[0], &sites);
    assert_int_equal(
        gonio_i_sites_create(fixture.context, fixture.mixture, &s.column[0], &untouched), GONIO_OK);
    for (size_t c = 0; c + 1 < SHARING; c++) {
        gonio_i_sites *own = NULL;
        gonio_i_fit alone = begin_fit(fixture.mixture, &s.column[c], &own);
        gonio_i_fit_read(&fit, &s.column[c]);
        for (int m = 0; m < 2; m++) {
            size_t outlying[2];
            assert_int_equal(gonio_i_fit_solve(&fit, &models[m]), GONIO_OK);
            assert_int_equal(gonio_i_fit_solve(&alone, &models[m]), GONIO_OK);
            assert_same_fit(&fit, &alone);
            assert_int_equal(gonio_i_fit_settle(&fit, true, &outlying[0]), GONIO_OK);
            assert_int_equal(gonio_i_fit_settle(&alone, true, &outlying[1]), GONIO_OK);
            assert_same_fit(&fit, &alone);
            assert_int_equal(outlying[0], outlying[1]);
        }
        end_fit(&alone, &own);
    }
    assert_memory_equal(sites->f, untouched->f, SITES * sites->components * sizeof *sites->f);
    assert_memory_equal(sites->seen, untouched->seen,
                        SITES * fixture.mixture->samples * sizeof *sites->seen);
    assert_memory_equal(sites->gram, untouched->gram, SITES * SITES * sizeof *sites->gram);
    assert_memory_equal(sites->smooth, untouched->smooth, SITES * SITES * sizeof *sites->smooth);
    assert_memory_equal(sites->peaked, untouched->peaked, SITES * SITES * sizeof *sites->peaked);
    gonio_i_sites_free(&untouched);
    end_fit(&fit, &sites);
    free(d.z);
}

/* Columns found together, some over the same sites, are bit for bit those found one by one. */
static void test_columns_together(void **state)
{
    (void)state;
    const size_t rows = fixture.mixture->view->rows;
    const size_t components = fixture.mixture->components;
    const gonio_i_posterior_options options = {.smoothness = ALPHA, .deviation = true};
    drawn d = draw(8, 0.1);
    shared s;
    share(&d, &s);
    gonio_i_posterior all = {.coefficients = calloc(SHARING * components, sizeof(double)),
                             .field = calloc(SHARING * rows, sizeof(double)),
                             .deviation = calloc(SHARING * rows, sizeof(double))};
    gonio_i_posterior one = {.coefficients = calloc(components, sizeof(double)),
                             .field = calloc(rows, sizeof(double)),
                             .deviation = calloc(rows, sizeof(double))};
    assert_int_equal(
        gonio_i_posterior_find(fixture.context, fixture.mixture, s.column, SHARING, &options, &all),
        GONIO_OK);
    for (size_t c = 0; c < SHARING; c++) {
        assert_int_equal(gonio_i_posterior_find(fixture.context, fixture.mixture, &s.column[c], 1,
                                                &options, &one),
                         GONIO_OK);
        assert_memory_equal(one.field, all.field + c * rows, rows * sizeof(double));
        assert_memory_equal(one.deviation, all.deviation + c * rows, rows * sizeof(double));
        assert_memory_equal(one.coefficients, all.coefficients + c * components,
                            components * sizeof(double));
    }
    gonio_i_posterior *both[] = {&all, &one};
    for (int k = 0; k < 2; k++) {
        free(both[k]->coefficients);
        free(both[k]->field);
        free(both[k]->deviation);
    }
    free(d.z);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sites_are_shared),
        cmocka_unit_test(test_fits_of_shared_sites),
        cmocka_unit_test(test_columns_together),
    };
    return cmocka_run_group_tests_name("sites", tests, fixture_set_up, fixture_tear_down);
}
