/* The table of error metrics, and the sums over values that they are computed from: see metric.h.
 */
#include "metric.h"

#include <string.h>

#include "../core/core.h"
#include "../core/vector_math.h"

#define ROW(name) &gonio_i_metric_##name,
static const gonio_i_metric *const metrics[] = {GONIO_I_METRICS(ROW)};

enum { METRICS = sizeof metrics / sizeof *metrics };

_Static_assert((int)METRICS <= (int)GONIO_MOST_METRICS, "a gonio_error has room for every metric");

/* ---- the table ---- */

int gonio_i_metric_count(void)
{
    return METRICS;
}

const gonio_i_metric *gonio_i_metric_at(int metric)
{
    return metrics[metric];
}

const gonio_metric_view *gonio_metric_describe(int metric)
{
    return metric >= 0 && metric < METRICS ? &metrics[metric]->view : NULL;
}

int gonio_metric_find(const char *name)
{
    for (int k = 0; k < METRICS; k++) {
        if (strcmp(metrics[k]->view.name, name) == 0) {
            return k;
        }
    }
    return -1;
}

/* ---- sums ---- */

GONIO_I_VECTORISED void gonio_i_metric_add_terms(size_t n, const double *difference,
                                                 const double *reference, gonio_i_metric_sums *sums)
{
    double sum = 0.0;
    double square = 0.0;
    double squares = 0.0;
#pragma omp simd reduction(+ : sum, square, squares)
    for (size_t k = 0; k < n; k++) {
        sum += difference[k];
        square += difference[k] * difference[k];
        squares += reference[k] * reference[k];
    }
    sums->difference += sum;
    sums->square += square;
    sums->reference += squares;
}

void gonio_i_error_add_values(const gonio_i_compared *values, double *scratch,
                              gonio_i_error_sums *sums)
{
    double *difference = scratch;
    double *reference = scratch + values->count;
    for (int m = 0; m < METRICS; m++) {
        metrics[m]->terms(values, difference, reference);
        gonio_i_metric_add_terms(values->count, difference, reference, &sums->metric[m]);
    }
}

void gonio_i_error_add(gonio_i_error_sums *total, const gonio_i_error_sums *part)
{
    for (int m = 0; m < METRICS; m++) {
        total->metric[m].difference += part->metric[m].difference;
        total->metric[m].square += part->metric[m].square;
        total->metric[m].reference += part->metric[m].reference;
    }
}

gonio_error gonio_i_error_of(const gonio_i_error_sums *sums, double values)
{
    gonio_error error = {{0.0}};
    for (int m = 0; m < METRICS; m++) {
        error.value[m] = metrics[m]->finish(&sums->metric[m], values);
    }
    return error;
}
