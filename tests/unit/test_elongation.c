/* Elongated columns: what a lobe becomes across and along the plane of incidence, what stays. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>

#include "basis/elongation.h"
#include "made_basis.h"

typedef struct fixture {
    gonio_basis *basis;
    double *across;
    float *column; /* a lobe in the first channel, its theta_h alone */
    float *elongated;
} fixture;

static double theta_h_of(const gonio_basis *basis, size_t position)
{
    return gonio_bin_centre(gonio_cell_bin(basis->representation, basis->cell[position])).theta_h;
}

static fixture make(gonio_representation representation)
{
    fixture f = {.basis = made_basis(NULL, representation, GONIO_SEPARATE, 1)};
    f.across = malloc(f.basis->cells * sizeof *f.across);
    f.column = calloc(3 * f.basis->rows, sizeof *f.column);
    f.elongated = calloc(3 * f.basis->rows, sizeof *f.elongated);
    assert_true(f.across != NULL && f.column != NULL && f.elongated != NULL);
    for (size_t k = 0; k < f.basis->cells; k++) {
        f.column[k] = (float)-theta_h_of(f.basis, k);
    }
    gonio_i_elongation_of_cells(f.basis, f.across);
    return f;
}

static void end(fixture *f)
{
    gonio_basis_free(&f->basis);
    free(f->across);
    free(f->column);
    free(f->elongated);
}

/* The logarithm of how much wider the lobe is at a bin than it was. */
static double log_width(const fixture *f, gonio_bin bin)
{
    const int32_t cell = (bin.theta_h * GONIO_THETA_D_BINS + bin.theta_d) * GONIO_SECTORS +
                         bin.phi_d / GONIO_SECTOR_BINS;
    const size_t position = gonio_basis_position(f->basis, cell);
    return log((double)f->column[position] / (double)f->elongated[position]);
}

/* Near the mirror direction the half vector lies along the plane of incidence at phi_d = 0, and
 * across it at 90 degrees. So widths are r^(-1/2) and r^(1/2) times as large. */
static void test_a_lobe_is_longer_across(void **state)
{
    (void)state;
    const double log_ratio = 0.6;
    fixture f = make(GONIO_SECTORED);
    gonio_i_elongate(f.basis, f.across, log_ratio, f.column, f.elongated);
    for (int theta_h = 20; theta_h < 25; theta_h++) {
        const double along = log_width(&f, (gonio_bin){theta_h, 45, 7});
        const double across = log_width(&f, (gonio_bin){theta_h, 45, 97});
        assert_true(fabs(along + 0.5 * log_ratio) < 0.1 * log_ratio);
        assert_true(fabs(across - 0.5 * log_ratio) < 0.1 * log_ratio);
    }
    /* where both directions are on one side of the normal, the half vector is along the plane */
    assert_true(fabs(log_width(&f, (gonio_bin){60, 2, 97}) + 0.5 * log_ratio) < 0.1 * log_ratio);
    end(&f);
}

/* A ratio of one, and any on a grid without azimuths. */
static void test_what_changes_nothing(void **state)
{
    (void)state;
    static const struct {
        gonio_representation representation;
        double log_ratio;
    } cases[] = {{GONIO_SECTORED, 0.0}, {GONIO_BIVARIATE, 1.0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        fixture f = make(cases[k].representation);
        gonio_i_elongate(f.basis, f.across, cases[k].log_ratio, f.column, f.elongated);
        assert_memory_equal(f.elongated, f.column, 3 * f.basis->rows * sizeof *f.column);
        end(&f);
    }
}

/* The other channels have columns of their own. */
static void test_channels_stay_apart(void **state)
{
    (void)state;
    fixture f = make(GONIO_SECTORED);
    for (size_t k = 0; k < f.basis->cells; k++) {
        f.column[2 * f.basis->rows + k] = 3.0F;
    }
    gonio_i_elongate(f.basis, f.across, 1.0, f.column, f.elongated);
    for (size_t k = 0; k < f.basis->cells; k++) {
        assert_true(f.elongated[f.basis->rows + k] == 0.0F);
        assert_true(f.elongated[2 * f.basis->rows + k] == 3.0F);
    }
    end(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_lobe_is_longer_across),
        cmocka_unit_test(test_what_changes_nothing),
        cmocka_unit_test(test_channels_stay_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
