/* Eigenvalues after an exchange of rows: see inertia.h. */
#include "inertia.h"

#include <float.h>
#include <math.h>

#include "../core/core.h"

typedef struct sums {
    double yy, yz, zz; /* over 1/(d - x) */
    int above;         /* d_k > x */
    int poles;         /* d_k = x */
} sums;

GONIO_I_VECTORISED static sums sums_at(const gonio_i_exchange *e, double x)
{
    double yy = 0.0;
    double yz = 0.0;
    double zz = 0.0;
    int above = 0;
    int poles = 0;
#pragma omp simd reduction(+ : yy, yz, zz, above, poles)
    for (size_t k = 0; k < e->n; k++) {
        const double gap = e->d[k] - x;
        const double weight = 1.0 / gap;
        yy += e->y[k] * e->y[k] * weight;
        yz += e->y[k] * e->z[k] * weight;
        zz += e->z[k] * e->z[k] * weight;
        above += gap > 0.0;
        poles += gap == 0.0;
    }
    return (sums){yy, yz, zz, above, poles};
}

int gonio_i_exchange_count_above(const gonio_i_exchange *e, double x)
{
    sums s = sums_at(e, x);
    while (s.poles > 0 && x > 0.0) { /* step off */
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
    return fmax(e->d[top - 1], e->d[top] - e->y[top] * e->y[top] + e->z[top] * e->z[top]);
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

bool gonio_i_exchange_beats(const gonio_i_exchange *e, double limit)
{
    const int all = (int)e->n;
    double low = largest_at_least(e) * (1.0 - 4.0 * DBL_EPSILON);
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
