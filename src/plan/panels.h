/* The candidate rows in single precision, laid out for the filter (filter.h), and its inner loops.
 *
 * Sixteen rows make a panel, value[k][row]: all loops then run over rows, in vector registers, with
 * the other operand broadcast. Rows are padded with zeros to whole panels, components to multiples
 * of 8. */
#ifndef GONIO_PANELS_H
#define GONIO_PANELS_H

#include <stddef.h>

#include "../core/core.h"

enum { GONIO_I_PANEL = 16, GONIO_I_COLUMNS = 8 };

typedef struct gonio_i_panels {
    size_t count;      /* panels */
    size_t components; /* padded */
    float *values;     /* [count][components][GONIO_I_PANEL] */
    float *length;     /* [count x GONIO_I_PANEL]: Euclidean norms of the rows, rounded up */
} gonio_i_panels;

/* Lays out vectors[rows][components]; false after a message when out of memory. */
bool gonio_i_panels_make(gonio_context *context, const double *vectors, size_t rows,
                         size_t components, gonio_i_panels *panels);
void gonio_i_panels_free(gonio_i_panels *panels);

/* The loops below work on panels first .. last - 1; arrays over rows are whole (count x
 * GONIO_I_PANEL). */

/* gain[row] = 1 + |L'u|^2 for a lower triangular L[components][components], padded with zeros. */
void gonio_i_panels_gain(const gonio_i_panels *panels, size_t first, size_t last, const float *l,
                         float *gain);

/* w[j][row] = u'c_j for GONIO_I_COLUMNS columns at once, c[components][GONIO_I_COLUMNS]; w: `rows`
 * apart.
 */
void gonio_i_panels_products(const gonio_i_panels *panels, size_t first, size_t last,
                             const float *c, size_t rows, float *w);

/* What filter.h needs to know about rounding. */
typedef struct gonio_i_margins {
    float gain;    /* |error of gain| <= gain (2 |u| sqrt(gain) + gain |u|^2) */
    float product; /* |error of w| <= product |u| */
} gonio_i_margins;

/* The test of filter.h: pass[u] unless loss gain + w^2 < 0 whatever the rounding errors. loss < 0.
 */
void gonio_i_mark(size_t n, const float *gain, const float *w, const float *length, float loss,
                  gonio_i_margins margins, unsigned char *pass);

#endif
