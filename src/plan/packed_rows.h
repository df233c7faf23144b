/* The candidate rows in single precision, laid out for the filter (swap_filter.h), and its inner
 * loops.
 *
 * A panel holds thirty-two rows, value[k][row]. So all loops run over rows, in vector registers,
 * with the other operand broadcast. A chunk is several panels, and fits into the cache. Rows are
 * padded with zeros to whole panels, components to multiples of 4.
 *
 * The panels of up to about a million rows are kept. With more rows, the panels of a chunk are made
 * each time they are needed. This takes little time and saves the memory. */
#ifndef GONIO_PACKED_ROWS_H
#define GONIO_PACKED_ROWS_H

#include <stddef.h>

#include "method.h"

enum { GONIO_I_PANEL = 32, GONIO_I_CHUNK_PANELS = 32 };
enum { GONIO_I_CHUNK = GONIO_I_PANEL * GONIO_I_CHUNK_PANELS }; /* rows */
enum { GONIO_I_COLUMNS = 8 };                                  /* products at a time */

typedef struct gonio_i_packed_rows {
    const gonio_i_selection_problem *problem;
    size_t components; /* padded */
    size_t rows;       /* padded to whole panels */
    float *values;     /* [panel][components][GONIO_I_PANEL]; NULL if not kept */
    float *length;     /* [rows]: Euclidean norms, rounded up */
} gonio_i_packed_rows;

/* Lays out the rows of a problem; false after a message when out of memory. */
bool gonio_i_packed_rows_make(const gonio_i_selection_problem *problem,
                              gonio_i_packed_rows *packed);
void gonio_i_packed_rows_free(gonio_i_packed_rows *packed);

size_t gonio_i_packed_rows_chunks(const gonio_i_packed_rows *packed);

/* Scratch for the panels of a chunk, aligned for the loops below. NULL if panels are kept, or if
 * out of memory (then *failed is set). */
float *gonio_i_packed_rows_scratch(const gonio_i_packed_rows *packed, bool *failed);

/* One chunk: its rows first .. first + count - 1 (padded) and their panels, laid out in the scratch
 * unless they are kept. */
typedef struct gonio_i_chunk {
    size_t first;
    size_t count;
    size_t components;
    const float *values;
    const float *length; /* of its rows */
} gonio_i_chunk;

gonio_i_chunk gonio_i_packed_rows_chunk(const gonio_i_packed_rows *packed, size_t chunk,
                                        float *scratch);

/* gain[row] <= 1 + |T u|^2, a lower bound as close as rounding allows, for a lower triangular T,
 * t[column][row] = T_row,column (padded with zeros), whose products have errors of at most
 * |error of T u| <= margin |u|. gain: of the chunk's rows. */
void gonio_i_chunk_gain(const gonio_i_chunk *chunk, const float *t, float margin, float *gain);

/* The test of swap_filter.h for one column or GONIO_I_COLUMNS at once, c[components][columns]:
 * pass[column][row] is 1 unless (u'c)^2 <= loss gain for certain, where |error of u'c| <= margin
 * |u|; the columns of pass lie `apart`. loss > 0. */
typedef struct gonio_i_test {
    size_t columns; /* 1 or GONIO_I_COLUMNS */
    const float *c;
    const float *gain; /* as above */
    float loss[GONIO_I_COLUMNS];
    float margin[GONIO_I_COLUMNS];
} gonio_i_test;

void gonio_i_chunk_mark(const gonio_i_chunk *chunk, const gonio_i_test *test, unsigned char *pass,
                        size_t apart);

#endif
