/* The field of columns in every row: see fields.h.
 *
 * A row's f and kernels are the same for all columns, so that the fields are a product of two
 * matrices. Each of its sums is added up in the order of a column's terms, so that a field does not
 * depend on the columns beside it, nor on the width of the processor's vectors: this file is
 * compiled without fused multiply-add. */
#include "fields.h"

#include <stdlib.h>
#include <string.h>

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
} filler;

static void fill_panels(filler *f)
{
    for (size_t j = 0; j < f->count; j++) {
        double *panel = f->panel + j / WIDE * f->size * WIDE + j % WIDE;
        for (size_t term = 0; term < f->size; term++) {
            panel[term * WIDE] = f->columns[j].terms[term];
        }
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

/* HIGH rows of a panel of columns. */
static void fill_tile(const filler *f, size_t row, size_t rows, const double *terms, size_t first)
{
    const size_t components = f->sites->components;
    const size_t n = f->sites->n;
    const double *panel = f->panel + first * f->size;
    const size_t columns = f->count - first < WIDE ? f->count - first : WIDE;
    double sum[HIGH * WIDE] = {0.0};
    for (size_t h = 0; h < rows; h++) {
        for (size_t w = 0; w < WIDE; w++) {
            sum[h * WIDE + w] = f->sites->prior->view->mean[row + h];
        }
    }
    add_terms(terms, f->size, panel, components, sum);
    add_terms(terms + components, f->size, panel + components * WIDE, n, sum);
    add_terms(terms + components + n, f->size, panel + (components + n) * WIDE, n, sum);
    if (f->sites->back != NULL) {
        const size_t back = components + 2 * n;
        add_terms(terms + back, f->size, panel + back * WIDE, n, sum);
    }
    for (size_t w = 0; w < columns; w++) {
        for (size_t h = 0; h < rows; h++) {
            f->columns[first + w].field[row + h] = sum[h * WIDE + w];
        }
    }
}

/* terms: scratch of [BLOCK][size]. */
static void fill_block(const filler *f, size_t row, size_t rows, double *terms)
{
    for (size_t k = 0; k < rows; k++) {
        fill_terms(f, row + k, terms + k * f->size);
    }
    for (size_t first = 0; first < f->count; first += WIDE) {
        for (size_t k = 0; k < rows; k += HIGH) {
            const size_t high = rows - k < HIGH ? rows - k : HIGH;
            fill_tile(f, row + k, high, terms + k * f->size, first);
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
        if (terms == NULL) {
#pragma omp atomic write
            failed = true;
        }
#pragma omp for schedule(static)
        for (size_t row = 0; row < rows; row += BLOCK) {
            if (terms != NULL) {
                fill_block(f, row, rows - row < BLOCK ? rows - row : BLOCK, terms);
            }
        }
        free(terms);
    }
    return failed ? GONIO_ERROR_MEMORY : GONIO_OK;
}

gonio_status gonio_i_fields_fill(gonio_context *context, const gonio_i_sites *sites,
                                 const gonio_i_field_column *columns, size_t count)
{
    filler f = {.sites = sites, .columns = columns, .count = count, .size = gonio_i_terms(sites)};
    const size_t panels = (count + WIDE - 1) / WIDE;
    f.panel = gonio_i_allocate(context, panels * f.size * WIDE, sizeof *f.panel);
    if (f.panel == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    fill_panels(&f);
    const gonio_status status = fill_rows(context, &f);
    free(f.panel);
    return status;
}
