/* The field of columns in every row: see fields.h.
 *
 * A row's f and kernels are the same for all columns, so that the fields are a product of two
 * matrices. Each of its sums is added up in the order of a column's terms, so that a field does not
 * depend on the columns beside it, nor on the width of the processor's vectors: this file is
 * compiled without fused multiply-add.
 *
 * Of very many columns the terms are combinations of a few, to a tolerance: then the fields are the
 * same combinations of the fields of those few. */
#include "fields.h"

#include <stdlib.h>
#include <string.h>

#include "combinations.h"

/* From so many columns on they are combinations of at most half as many: more are no gain. */
enum { MANY_COLUMNS = 96 };

/* What combinations may leave of a column's terms, as lengths in log units: its error in a row is
 * at most TOLERANCE (1 + 3 n)^(1/2), as |V_x| and k are at most 1; in the root mean square over
 * the rows it is a hundredth of that or less. */
static const double TOLERANCE = 1e-4;

enum {
    WIDE = 8,   /* columns of a panel */
    HIGH = 4,   /* rows that are summed at the same time */
    BLOCK = 32, /* rows whose terms are made at a time */
    LANES = 4,
    VECTORS = WIDE / LANES,
};

typedef double lanes __attribute__((vector_size(LANES * sizeof(double))));

typedef struct filler {
    const gonio_i_sites *sites;
    const gonio_i_field_column *columns;
    size_t count;
    size_t size;   /* gonio_i_terms */
    double *panel; /* [panels][size][WIDE]: the columns' terms; 0 past the last */
    /* Of many columns: */
    gonio_i_combinations few;
    double *few_panel; /* [panels of the few][size][WIDE]: terms of the few; then `panel` has the
                        * weights of the columns, [panels][few.count][WIDE] */
} filler;

/* What a term is multiplied by so that its share of a field is at most its own length: see
 * TOLERANCE. */
static double scale_of(const gonio_i_sites *sites, size_t term)
{
    return term < sites->components ? sites->prior->deviation[term] : 1.0;
}

static size_t panels_of(size_t columns)
{
    return (columns + WIDE - 1) / WIDE;
}

/* A vector as one of a panel's. */
static void put_in_panel(const double *vector, size_t size, size_t column, double *panels)
{
    double *panel = panels + column / WIDE * size * WIDE + column % WIDE;
    for (size_t term = 0; term < size; term++) {
        panel[term * WIDE] = vector[term];
    }
}

/* f, smooth, peaked and back of a row: [size]. */
static void fill_terms(const filler *f, size_t row, double *terms)
{
    const gonio_i_sites *sites = f->sites;
    double *smooth = terms + sites->components;
    double *peaked = smooth + sites->n;
    int channel = 0;
    const gonio_i_place here =
        gonio_i_place_of(gonio_i_row_coordinates(sites->prior->view, row, &channel));
    gonio_i_prior_row(sites->prior, row, terms);
    for (size_t i = 0; i < sites->n; i++) {
        smooth[i] = gonio_i_smooth(&here, &sites->place[i]);
        peaked[i] = gonio_i_peaked(&here, &sites->place[i]);
    }
    for (size_t i = 0; i < sites->n && sites->back != NULL; i++) {
        peaked[sites->n + i] = gonio_i_back(&here, &sites->place[i]);
    }
}

/* sum[HIGH][WIDE] += terms[HIGH][count] (`size` apart) times panel[count][WIDE]. Each lane adds up
 * one sum: compilers left alone change the order of the loops. */
GONIO_I_VECTORISED static void add_terms(const double *restrict terms, size_t size,
                                         const double *restrict panel, size_t count,
                                         double *restrict sum)
{
    lanes part[HIGH][VECTORS] = {{{0.0}}};
    for (size_t k = 0; k < count; k++) {
        lanes weight[VECTORS];
        memcpy(weight, panel + k * WIDE, sizeof weight);
        for (size_t h = 0; h < HIGH; h++) {
            for (size_t v = 0; v < VECTORS; v++) {
                part[h][v] += terms[h * size + k] * weight[v];
            }
        }
    }
    for (size_t h = 0; h < HIGH; h++) {
        lanes whole[VECTORS];
        memcpy(whole, sum + h * WIDE, sizeof whole);
        for (size_t v = 0; v < VECTORS; v++) {
            whole[v] += part[h][v];
        }
        memcpy(sum + h * WIDE, whole, sizeof whole);
    }
}

/* Adds HIGH rows of a panel of columns, part by part. */
static void add_parts(const filler *f, const double *terms, const double *panel, double *sum)
{
    const size_t components = f->sites->components;
    const size_t n = f->sites->n;
    add_terms(terms, f->size, panel, components, sum);
    add_terms(terms + components, f->size, panel + components * WIDE, n, sum);
    add_terms(terms + components + n, f->size, panel + (components + n) * WIDE, n, sum);
    if (f->sites->back != NULL) {
        const size_t back = components + 2 * n;
        add_terms(terms + back, f->size, panel + back * WIDE, n, sum);
    }
}

/* HIGH rows of a panel of columns. terms: of the rows, or the fields of the few there. */
static void fill_tile(const filler *f, size_t row, size_t rows, const double *terms, size_t first)
{
    const size_t few = f->few.count;
    const size_t columns = f->count - first < WIDE ? f->count - first : WIDE;
    double sum[HIGH * WIDE] = {0.0};
    for (size_t h = 0; h < rows; h++) {
        for (size_t w = 0; w < WIDE; w++) {
            sum[h * WIDE + w] = f->sites->prior->view->mean[row + h];
        }
    }
    if (few > 0) {
        add_terms(terms, few, f->panel + first * few, few, sum);
    } else {
        add_parts(f, terms, f->panel + first * f->size, sum);
    }
    for (size_t w = 0; w < columns; w++) {
        for (size_t h = 0; h < rows; h++) {
            f->columns[first + w].field[row + h] = sum[h * WIDE + w];
        }
    }
}

/* The fields of the few, [BLOCK][few.count], less the mean. */
static void fill_few(const filler *f, size_t rows, const double *terms, double *few)
{
    for (size_t first = 0; first < f->few.count; first += WIDE) {
        const size_t left = f->few.count - first;
        for (size_t k = 0; k < rows; k += HIGH) {
            double sum[HIGH * WIDE] = {0.0};
            add_parts(f, terms + k * f->size, f->few_panel + first * f->size, sum);
            for (size_t i = 0; i < HIGH * WIDE; i++) {
                if (i % WIDE < left) {
                    few[(k + i / WIDE) * f->few.count + first + i % WIDE] = sum[i];
                }
            }
        }
    }
}

/* terms, few: scratch of [BLOCK][size] and [BLOCK][few.count]. */
static void fill_block(const filler *f, size_t row, size_t rows, double *terms, double *few)
{
    for (size_t k = 0; k < rows; k++) {
        fill_terms(f, row + k, terms + k * f->size);
    }
    const double *from = terms;
    size_t size = f->size;
    if (f->few.count > 0) {
        fill_few(f, rows, terms, few);
        from = few;
        size = f->few.count;
    }
    for (size_t first = 0; first < f->count; first += WIDE) {
        for (size_t k = 0; k < rows; k += HIGH) {
            const size_t high = rows - k < HIGH ? rows - k : HIGH;
            fill_tile(f, row + k, high, from + k * size, first);
        }
    }
}

static gonio_status fill_rows(gonio_context *context, const filler *f)
{
    const size_t rows = f->sites->prior->view->rows;
    bool failed = false;
#pragma omp parallel num_threads(gonio_context_threads(context))
    {
        double *terms = gonio_i_allocate(context, BLOCK * f->size, sizeof *terms);
        double *few = gonio_i_allocate(context, BLOCK * f->few.count, sizeof *few);
        if (terms == NULL || few == NULL) {
#pragma omp atomic write
            failed = true;
        }
#pragma omp for schedule(static)
        for (size_t row = 0; row < rows; row += BLOCK) {
            if (terms != NULL && few != NULL) {
                fill_block(f, row, rows - row < BLOCK ? rows - row : BLOCK, terms, few);
            }
        }
        free(terms);
        free(few);
    }
    return failed ? GONIO_ERROR_MEMORY : GONIO_OK;
}

/* ---- panels ---- */

/* The few that many columns are combinations of; none if the columns are not many. */
static gonio_status find_few(gonio_context *context, filler *f)
{
    if (f->count < MANY_COLUMNS) {
        return GONIO_OK;
    }
    const size_t shapes = f->count < f->size ? f->count : f->size;
    double *vector = gonio_i_allocate(context, f->count * f->size, sizeof *vector);
    if (vector == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t j = 0; j < f->count * f->size; j++) {
        vector[j] = scale_of(f->sites, j % f->size) * f->columns[j / f->size].terms[j % f->size];
    }
    const gonio_status status = gonio_i_combinations_find(context, vector, f->count, f->size,
                                                          TOLERANCE, shapes / 2, &f->few);
    free(vector);
    return status;
}

static gonio_status fill_panels_of_few(gonio_context *context, filler *f)
{
    const size_t few = f->few.count;
    f->panel = gonio_i_allocate(context, panels_of(f->count) * few * WIDE, sizeof *f->panel);
    f->few_panel = gonio_i_allocate(context, panels_of(few) * f->size * WIDE, sizeof *f->few_panel);
    if (f->panel == NULL || f->few_panel == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < few * f->size; k++) {
        const double scale = scale_of(f->sites, k % f->size);
        f->few.few[k] = scale > 0.0 ? f->few.few[k] / scale : 0.0;
    }
    for (size_t k = 0; k < few; k++) {
        put_in_panel(f->few.few + k * f->size, f->size, k, f->few_panel);
    }
    for (size_t j = 0; j < f->count; j++) {
        put_in_panel(f->few.weight + j * few, few, j, f->panel);
    }
    return GONIO_OK;
}

static gonio_status fill_panels(gonio_context *context, filler *f)
{
    const gonio_status status = find_few(context, f);
    if (status != GONIO_OK || f->few.count > 0) {
        return status == GONIO_OK ? fill_panels_of_few(context, f) : status;
    }
    f->panel = gonio_i_allocate(context, panels_of(f->count) * f->size * WIDE, sizeof *f->panel);
    for (size_t j = 0; f->panel != NULL && j < f->count; j++) {
        put_in_panel(f->columns[j].terms, f->size, j, f->panel);
    }
    return f->panel != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

gonio_status gonio_i_fields_fill(gonio_context *context, const gonio_i_sites *sites,
                                 const gonio_i_field_column *columns, size_t count)
{
    filler f = {.sites = sites, .columns = columns, .count = count, .size = gonio_i_terms(sites)};
    gonio_status status = fill_panels(context, &f);
    if (status == GONIO_OK) {
        status = fill_rows(context, &f);
    }
    gonio_i_combinations_release(&f.few);
    free(f.panel);
    free(f.few_panel);
    return status;
}
