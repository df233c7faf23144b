/* Errors between readings at the same directions: see evaluate.h. */
#include <math.h>
#include <stdlib.h>

#include "../core/core.h"
#include "metrics.h"

/* One value of one reading. */
static void add_value(gonio_half_difference at, double s, double rho, double other,
                      gonio_i_error_sums *sums)
{
    double incident = 0.0;
    double outgoing = 0.0;
    gonio_cosines(at, &incident, &outgoing);
    const double cosines = fmax(incident * outgoing, 0.0);
    const double w = gonio_i_ratio_weight(cosines);
    const double g = log1p(rho / s);
    const double difference = g - log1p(other / s);
    const double cube = cbrt(rho * cosines);
    const double cubes = cube - cbrt(other * cosines);
    const double ratio = log((rho * w + GONIO_I_RATIO_OFFSET) / (other * w + GONIO_I_RATIO_OFFSET));
    const gonio_i_error_sums part = {difference * difference, g * g, cubes * cubes, cube * cube,
                                     ratio * ratio};
    gonio_i_error_add(sums, &part);
}

static gonio_status check(gonio_context *context, const gonio_readings *reference,
                          const gonio_readings *other)
{
    const gonio_readings_view a = gonio_readings_describe(reference);
    const gonio_readings_view b = gonio_readings_describe(other);
    if (a.count != b.count || a.channels != b.channels ||
        (a.wavelength == NULL) != (b.wavelength == NULL)) {
        return gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                            "%s has %zu readings in %zu channels, %s has %zu in %zu", a.path,
                            a.count, a.channels, b.path, b.count, b.channels);
    }
    return GONIO_OK;
}

gonio_status gonio_compare_readings(gonio_context *context, const gonio_readings *reference,
                                    const gonio_readings *other, const bool *left_out,
                                    gonio_error *error, size_t *compared)
{
    const gonio_readings_view view = gonio_readings_describe(reference);
    gonio_i_error_sums sums = {0};
    size_t values = 0;
    const gonio_status status = check(context, reference, other);
    *compared = 0;
    for (size_t k = 0; k < view.count && status == GONIO_OK; k++) {
        if (left_out != NULL && left_out[k]) {
            continue;
        }
        const gonio_half_difference at = gonio_half_difference_from_pair(view.pair[k]);
        for (size_t c = 0; c < view.channels; c++) {
            const double a = gonio_readings_value(reference, k, c);
            const double b = gonio_readings_value(other, k, c);
            if (!isnan(a) && !isnan(b)) {
                add_value(at, gonio_readings_scale(reference, c), a, b, &sums);
                values++;
            }
        }
        ++*compared;
    }
    if (status == GONIO_OK && !(sums.log_reference > 0.0)) {
        return gonio_i_fail(context, GONIO_ERROR_DATA, "%s: nothing to compare, or only darkness",
                            view.path);
    }
    *error = gonio_i_error_of(&sums, (double)values);
    return status;
}
