/* Bases for the published methods, of a few built-in materials. */
#ifndef METHODS_FIXTURE_H
#define METHODS_FIXTURE_H

#include <math.h>
#include <stdlib.h>

#include <gonio/gonio.h>

enum { MATERIALS = 7, MOST = 3 * MATERIALS };

static const char *const paths[MATERIALS] = {
    "atlas:gold-polished", "atlas:red-glossy-plastic", "atlas:burgundy-velvet", "atlas:oak-sawn",
    "atlas:plaster-cast",  "atlas:steel-brushed",      "atlas:white-linen"};

typedef struct fixture {
    gonio_context *context;
    gonio_basis *relative; /* bivariate, separate, centred: what nielsen and frost work on */
    gonio_basis *plain;    /* bivariate, joint, without mean: what matusik works on */
} fixture;

static inline gonio_database *make_database(gonio_representation representation,
                                            gonio_channel_model channels, gonio_mapping mapping)
{
    const gonio_database_options how = {.size = sizeof how,
                                        .representation = representation,
                                        .channels = channels,
                                        .mapping = mapping};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(NULL, paths, MATERIALS, &how, &database), GONIO_OK);
    return database;
}

static inline gonio_basis *learn(gonio_channel_model channels, gonio_mapping mapping,
                                 gonio_basis_options options)
{
    gonio_database *database = make_database(GONIO_BIVARIATE, channels, mapping);
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_basis_learn(NULL, database, &options, &basis), GONIO_OK);
    gonio_database_free(&database);
    return basis;
}

static inline int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->context = support_context();
    f->relative =
        learn(GONIO_SEPARATE, GONIO_LOG_RELATIVE,
              (gonio_basis_options){.size = sizeof(gonio_basis_options), .components = 12});
    f->plain =
        learn(GONIO_JOINT, GONIO_LOG,
              (gonio_basis_options){.size = sizeof(gonio_basis_options), .without_mean = true});
    *state = f;
    return 0;
}

static inline int tear_down(void **state)
{
    fixture *f = *state;
    gonio_basis_free(&f->relative);
    gonio_basis_free(&f->plain);
    gonio_context_free(&f->context);
    free(f);
    return 0;
}

static inline void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

/* Solves a x = b (n x n, n <= MOST), by elimination with pivoting; a and b are used up. */
static inline void eliminate(size_t n, double *a, double *b)
{
    for (size_t c = 0; c < n; c++) {
        size_t pivot = c;
        for (size_t r = c + 1; r < n; r++) {
            pivot = fabs(a[r * n + c]) > fabs(a[pivot * n + c]) ? r : pivot;
        }
        for (size_t k = 0; k < n; k++) {
            const double swap = a[c * n + k];
            a[c * n + k] = a[pivot * n + k];
            a[pivot * n + k] = swap;
        }
        const double swap = b[c];
        b[c] = b[pivot];
        b[pivot] = swap;
        for (size_t r = 0; r < n; r++) {
            const double factor = r == c ? 0.0 : a[r * n + c] / a[c * n + c];
            for (size_t k = 0; k < n; k++) {
                a[r * n + k] -= factor * a[c * n + k];
            }
            b[r] -= factor * b[c];
        }
    }
    for (size_t c = 0; c < n; c++) {
        b[c] /= a[c * n + c];
    }
}

#endif
