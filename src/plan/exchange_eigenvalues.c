/* Eigenvalues after an exchange of rows: see exchange_eigenvalues.h. */
#include "exchange_eigenvalues.h"

#include <float.h>
#include <math.h>

#include "../core/core.h"

typedef struct sums {
    double yy, yz, zz; /* over 1/(d - x) */
    int above;         /* d_k > x */
    bool on_pole;      /* some d_k = x */
} sums;

/* (Local pointers, otherwise the compiler gathers values one by one.) */
GONIO_I_VECTORISED static sums sums_at(const gonio_i_exchange *e, double x)
{
    const double *restrict d = e->d;
    const double *restrict y = e->y;
    const double *restrict z = e->z;
    const size_t n = e->n;
    double yy = 0.0;
    double yz = 0.0;
    double zz = 0.0;
    double above = 0.0;
    double poles = 0.0;
#pragma omp simd reduction(+ : yy, yz, zz, above, poles)
    for (size_t k = 0; k < n; k++) {
        const double gap = d[k] - x;
        const double weight = 1.0 / gap;
        yy += y[k] * y[k] * weight;
        yz += y[k] * z[k] * weight;
        zz += z[k] * z[k] * weight;
        above += gap > 0.0 ? 1.0 : 0.0;
        poles += gap == 0.0 ? 1.0 : 0.0;
    }
    return (sums){yy, yz, zz, (int)above, poles > 0.0};
}

int gonio_i_exchange_count_above(const gonio_i_exchange *e, double x)
{
    sums s = sums_at(e, x);
    while (s.on_pole && x > 0.0) { /* step off */
        x = nextafter(x, 0.0);
        s = sums_at(e, x);
    }
    const double a = 1.0 - s.yy;
    const double c = -1.0 - s.zz;
    const double determinant = a * c - s.yz * s.yz;
    const int positive = determinant < 0.0 ? 1 : a + c > 0.0 ? 2 : 0;
    return s.above + positive - 1;
}

/* lambda_max(H) is at least the second largest d, and at least q'Hq for the leading eigenvector q.
 */
static double largest_at_least(const gonio_i_exchange *e)
{
    const size_t top = e->n - 1;
    const double largest =
        fmax(e->d[top - 1], e->d[top] - e->y[top] * e->y[top] + e->z[top] * e->z[top]);
    return largest * (1.0 - 4.0 * DBL_EPSILON);
}

/* The largest d, and what is put in. */
static double largest_at_most(const gonio_i_exchange *e)
{
    double sum = e->d[e->n - 1];
    for (size_t k = 0; k < e->n; k++) {
        sum += e->z[k] * e->z[k];
    }
    return sum * (1.0 + 4.0 * DBL_EPSILON);
}

double gonio_i_exchange_eigenvalue(const gonio_i_exchange *e, size_t k)
{
    double low = k > 0 ? e->d[k - 1] : 0.0; /* eigenvalues interlace */
    double high = k + 1 < e->n ? e->d[k + 1] : largest_at_most(e);
    while (high - low > 1e-10 * high) {
        const double middle = 0.5 * (low + high);
        if (gonio_i_exchange_count_above(e, middle) >= (int)(e->n - k)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

bool gonio_i_exchange_may_beat(const gonio_i_exchange *e, size_t part, double limit)
{
    const gonio_i_exchange lowest = {e->d, e->y, e->z, part};
    const double least = largest_at_least(e) / limit;
    return gonio_i_exchange_count_above(&lowest, least) == (int)part;
}

bool gonio_i_exchange_beats(const gonio_i_exchange *e, double limit)
{
    const int all = (int)e->n;
    double low = largest_at_least(e);
    if (gonio_i_exchange_count_above(e, low / limit) != all) {
        return false; /* most of them */
    }
    double high = largest_at_most(e);
    /* low <= lambda_max < high: narrowed until one of them decides. */
    while (high - low > 2.0 * DBL_EPSILON * high) {
        const double middle = 0.5 * (low + high);
        const bool below = gonio_i_exchange_count_above(e, middle) > 0;
        const bool lifted = gonio_i_exchange_count_above(e, middle / limit) == all;
        if (below != lifted) {
            return lifted;
        }
        low = below ? middle : low;
        high = below ? high : middle;
    }
    return gonio_i_exchange_count_above(e, high / limit) == all;
}
