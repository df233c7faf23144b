/* Errors between readings at the same directions: see evaluate.h. */
#include <gonio/evaluate.h>

#include <math.h>
#include <stdlib.h>

#include "../core/core.h"
#include "../metric/metric.h"

/* Values that both files have, of the readings that count; room for all of one channel. */
typedef struct pairs {
    size_t count;
    double *reference; /* [readings] each, 1/sr */
    double *other;
    double *cosines;
    double *terms; /* [2][readings] */
} pairs;

static gonio_status allocate_pairs(gonio_context *context, size_t readings, pairs *p)
{
    double *all = gonio_i_allocate(context, 5 * readings, sizeof *all);
    *p = (pairs){0, all, NULL, NULL, NULL};
    if (all == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    p->other = all + readings;
    p->cosines = all + 2 * readings;
    p->terms = all + 3 * readings;
    return GONIO_OK;
}

static void add_pair(gonio_pair pair, double rho, double other, pairs *p)
{
    double incident = 0.0;
    double outgoing = 0.0;
    gonio_cosines(gonio_half_difference_from_pair(pair), &incident, &outgoing);
    p->reference[p->count] = rho;
    p->other[p->count] = other;
    p->cosines[p->count] = fmax(incident * outgoing, 0.0);
    p->count++;
}

static bool same_wavelengths(const gonio_readings_view *a, const gonio_readings_view *b)
{
    bool same = (a->wavelength == NULL) == (b->wavelength == NULL);
    for (size_t c = 0; same && a->wavelength != NULL && c < a->channels; c++) {
        same = a->wavelength[c] == b->wavelength[c];
    }
    return same;
}

static gonio_status check(gonio_context *context, const gonio_readings *reference,
                          const gonio_readings *other)
{
    const gonio_readings_view *a = gonio_readings_describe(reference);
    const gonio_readings_view *b = gonio_readings_describe(other);
    if (a->count != b->count || a->channels != b->channels) {
        return gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                            "%s has %zu readings in %zu channels, %s has %zu in %zu", a->path,
                            a->count, a->channels, b->path, b->count, b->channels);
    }
    if (!same_wavelengths(a, b)) {
        return gonio_i_fail(context, GONIO_ERROR_MISMATCH, "%s and %s have other wavelengths",
                            a->path, b->path);
    }
    return GONIO_OK;
}

/* One channel; returns how many values were compared. */
static size_t add_channel(const gonio_readings *reference, const gonio_readings *other,
                          const bool *left_out, size_t channel, pairs *p, gonio_i_error_sums *sums)
{
    const gonio_readings_view *view = gonio_readings_describe(reference);
    p->count = 0;
    for (size_t k = 0; k < view->count; k++) {
        const double a = gonio_readings_value(reference, k, channel);
        const double b = gonio_readings_value(other, k, channel);
        if ((left_out == NULL || !left_out[k]) && !isnan(a) && !isnan(b)) {
            add_pair(view->pair[k], a, b, p);
        }
    }
    const gonio_i_compared values = {p->count, p->reference, p->other, p->cosines,
                                     gonio_readings_scale(reference, channel)};
    gonio_i_error_add_values(&values, p->terms, sums);
    return p->count;
}

/* Whether both have a value in some channel. */
static bool is_compared(const gonio_readings *reference, const gonio_readings *other, size_t k)
{
    const size_t channels = gonio_readings_describe(reference)->channels;
    bool any = false;
    for (size_t c = 0; c < channels; c++) {
        any = any || (!isnan(gonio_readings_value(reference, k, c)) &&
                      !isnan(gonio_readings_value(other, k, c)));
    }
    return any;
}

/* How many are not left out and have values in both. */
static size_t count_readings(const gonio_readings *reference, const gonio_readings *other,
                             const bool *left_out)
{
    size_t count = 0;
    for (size_t k = 0; k < gonio_readings_describe(reference)->count; k++) {
        count += (left_out == NULL || !left_out[k]) && is_compared(reference, other, k);
    }
    return count;
}

gonio_status gonio_compare_readings(gonio_context *context, const gonio_readings *reference,
                                    const gonio_readings *other, const bool *left_out,
                                    gonio_error *error, size_t *compared)
{
    const gonio_readings_view *view = gonio_readings_describe(reference);
    gonio_i_error_sums sums = {0};
    size_t values = 0;
    pairs p = {0};
    gonio_status status = check(context, reference, other);
    if (status == GONIO_OK) {
        status = allocate_pairs(context, view->count, &p);
    }
    for (size_t c = 0; c < view->channels && status == GONIO_OK; c++) {
        values += add_channel(reference, other, left_out, c, &p, &sums);
    }
    free(p.reference);
    if (status != GONIO_OK) {
        return status;
    }
    if (!(sums.metric[GONIO_E6].reference > 0.0)) {
        return gonio_i_fail(context, GONIO_ERROR_DATA,
                            "%s: no readings to compare, or all of them are zero", view->path);
    }
    *compared = count_readings(reference, other, left_out);
    *error = gonio_i_error_of(&sums, (double)values);
    return GONIO_OK;
}
