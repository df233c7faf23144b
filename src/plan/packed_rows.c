/* The inner loops of the filter: see packed_rows.h. */
#include "packed_rows.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = GONIO_I_PANEL, COLUMNS = GONIO_I_COLUMNS, LANES = 16, HALVES = WIDTH / LANES };
enum { BLOCK = 4 }; /* rows of T at a time */

/* Half a panel's row of values as one vector (an extension of gcc and clang), so that sums stay in
 * registers. There are two halves, so that each broadcast value is used twice. */
typedef float lanes __attribute__((vector_size(LANES * sizeof(float))));
typedef int32_t masks __attribute__((vector_size(LANES * sizeof(int32_t))));
typedef unsigned char flags __attribute__((vector_size(LANES)));

/* The limit of the memory for panels. */
static const size_t most_kept = (size_t)512 << 20;

static size_t round_up(size_t n, size_t multiple)
{
    return (n + multiple - 1) / multiple * multiple;
}

/* The number of values in the panels of `rows` rows. */
static size_t size_of(const gonio_i_packed_rows *packed, size_t rows)
{
    return rows * packed->components;
}

/* ---- layout ---- */

/* Fills in a panel from rows `stride` apart. */
GONIO_I_VECTORISED static void transpose(const double *restrict rows, size_t stride, size_t count,
                                         size_t k, float *restrict panel)
{
    for (size_t i = 0; i < count; i++) {
        for (size_t a = 0; a < k; a++) {
            panel[a * WIDTH + i] = (float)rows[i * stride + a];
        }
    }
}

/* Fills in the panel from row `first` on. The last panel may have fewer rows. */
static void lay_out(const gonio_i_packed_rows *packed, size_t first, float *panel)
{
    const gonio_i_selection_problem *p = packed->problem;
    const size_t rows = first < p->rows ? p->rows - first : 0;
    const size_t count = rows < WIDTH ? rows : WIDTH;
    if (count < WIDTH || packed->components > p->components) {
        memset(panel, 0, size_of(packed, WIDTH) * sizeof *panel);
    }
    transpose(gonio_i_row(p, first), p->stride, count, p->components, panel);
}

static float length_of(const double *u, size_t k)
{
    double squares = 0.0;
    for (size_t a = 0; a < k; a++) {
        squares += u[a] * u[a];
    }
    return (float)(sqrt(squares) * (1.0 + 1e-6));
}

static float *aligned_floats(size_t count)
{
    return aligned_alloc(sizeof(lanes), count * sizeof(float));
}

bool gonio_i_packed_rows_make(const gonio_i_selection_problem *problem, gonio_i_packed_rows *packed)
{
    gonio_context *context = problem->context;
    *packed = (gonio_i_packed_rows){.problem = problem,
                                    .components = round_up(problem->components, BLOCK),
                                    .rows = round_up(problem->rows, WIDTH)};
    const size_t size = size_of(packed, packed->rows);
    const bool keep = size <= most_kept / sizeof(float);
    packed->values = keep ? aligned_floats(size) : NULL;
    packed->length = aligned_floats(packed->rows);
    if ((keep && packed->values == NULL) || packed->length == NULL) {
        gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
        return false;
    }
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(context))
    for (size_t first = 0; first < packed->rows; first += WIDTH) {
        if (keep) {
            lay_out(packed, first, packed->values + size_of(packed, first));
        }
        for (size_t u = first; u < first + WIDTH; u++) {
            packed->length[u] =
                u < problem->rows ? length_of(gonio_i_row(problem, u), problem->components) : 0.0F;
        }
    }
    return true;
}

void gonio_i_packed_rows_free(gonio_i_packed_rows *packed)
{
    free(packed->values);
    free(packed->length);
}

size_t gonio_i_packed_rows_chunks(const gonio_i_packed_rows *packed)
{
    return (packed->rows + GONIO_I_CHUNK - 1) / GONIO_I_CHUNK;
}

float *gonio_i_packed_rows_scratch(const gonio_i_packed_rows *packed, bool *failed)
{
    float *scratch = packed->values == NULL ? aligned_floats(size_of(packed, GONIO_I_CHUNK)) : NULL;
    *failed = packed->values == NULL && scratch == NULL;
    return scratch;
}

gonio_i_chunk gonio_i_packed_rows_chunk(const gonio_i_packed_rows *packed, size_t chunk,
                                        float *scratch)
{
    const size_t first = chunk * GONIO_I_CHUNK;
    const size_t rest = packed->rows - first;
    const size_t count = rest < GONIO_I_CHUNK ? rest : GONIO_I_CHUNK;
    for (size_t row = 0; packed->values == NULL && row < count; row += WIDTH) {
        lay_out(packed, first + row, scratch + size_of(packed, row));
    }
    return (gonio_i_chunk){
        .first = first,
        .count = count,
        .components = packed->components,
        .values = packed->values == NULL ? scratch : packed->values + size_of(packed, first),
        .length = packed->length + first};
}

/* ---- loops ---- */

static const lanes *panel_at(const gonio_i_chunk *chunk, size_t row)
{
    return (const lanes *)(const void *)(chunk->values + row * chunk->components);
}

/* gain[row] = 1 + |T u|^2 for a panel. */
static inline __attribute__((always_inline)) void panel_gain(const lanes *u, size_t k,
                                                             const float *t, float *gain)
{
    const lanes zero = {0.0F};
    lanes total[HALVES] = {zero + 1.0F, zero + 1.0F};
    for (size_t j = 0; j < k; j += BLOCK) {
        lanes sum[BLOCK][HALVES] = {{zero}};
        for (size_t i = 0; i < j + BLOCK; i++) {
            for (size_t c = 0; c < BLOCK; c++) {
                sum[c][0] += u[2 * i] * t[i * k + j + c];
                sum[c][1] += u[2 * i + 1] * t[i * k + j + c];
            }
        }
        for (size_t c = 0; c < BLOCK; c++) {
            total[0] += sum[c][0] * sum[c][0];
            total[1] += sum[c][1] * sum[c][1];
        }
    }
    memcpy(gain, total, sizeof total);
}

GONIO_I_VECTORISED void gonio_i_chunk_gain(const gonio_i_chunk *chunk, const float *t, float margin,
                                           float *gain)
{
    for (size_t row = 0; row < chunk->count; row += WIDTH) {
        panel_gain(panel_at(chunk, row), chunk->components, t, gain + row);
    }
    const float rounding = 1.0F - (float)(chunk->components + 8) * FLT_EPSILON;
    for (size_t row = 0; row < chunk->count; row++) {
        const float error = margin * chunk->length[row];
        gain[row] = gain[row] * rounding - error * (2.0F * sqrtf(gain[row]) + error);
    }
}

/* pass[row] of half a panel, from the products w. */
static inline __attribute__((always_inline)) void
mark(lanes w, lanes length, lanes gain, float loss, float margin, unsigned char *pass)
{
    const masks no_sign = {0};
    const lanes size = (lanes)((masks)w & (no_sign + INT32_MAX)); /* |w| */
    const lanes most = size + margin * length;
    const masks passes = most * most > loss * gain;
    const flags one = __builtin_convertvector(passes, flags) & 1;
    memcpy(pass, &one, sizeof one);
}

static inline __attribute__((always_inline)) void mark_panel(const gonio_i_chunk *chunk,
                                                             const gonio_i_test *t, size_t row,
                                                             size_t columns, unsigned char *pass,
                                                             size_t apart)
{
    const lanes *u = panel_at(chunk, row);
    const lanes zero = {0.0F};
    lanes sum[COLUMNS][HALVES] = {{zero}};
    for (size_t i = 0; i < chunk->components; i++) {
        for (size_t j = 0; j < columns; j++) {
            sum[j][0] += u[2 * i] * t->c[i * columns + j];
            sum[j][1] += u[2 * i + 1] * t->c[i * columns + j];
        }
    }
    lanes gain[HALVES];
    lanes length[HALVES];
    memcpy(gain, t->gain + row, sizeof gain);
    memcpy(length, chunk->length + row, sizeof length);
    for (size_t j = 0; j < columns; j++) {
        for (size_t half = 0; half < HALVES; half++) {
            mark(sum[j][half], length[half], gain[half], t->loss[j], t->margin[j],
                 pass + j * apart + row + half * LANES);
        }
    }
}

GONIO_I_VECTORISED void gonio_i_chunk_mark(const gonio_i_chunk *chunk, const gonio_i_test *test,
                                           unsigned char *pass, size_t apart)
{
    for (size_t row = 0; row < chunk->count; row += WIDTH) {
        if (test->columns == 1) { /* a constant lets the sums stay in registers */
            mark_panel(chunk, test, row, 1, pass, apart);
        } else {
            mark_panel(chunk, test, row, COLUMNS, pass, apart);
        }
    }
}
