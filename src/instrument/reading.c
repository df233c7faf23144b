/* What the numbers of an instrument's readings are, and how sure. */
#include <math.h>

#include "instrument.h"

double gonio_instrument_deviation(const gonio_instrument *instrument, double value)
{
    return hypot(instrument->view.noise * value, instrument->view.floor);
}

/* The reflectance factor of the reference, linear between its rows and constant outside. */
static double reference_factor(const gonio_instrument_view *view, double theta)
{
    const gonio_reference_row *row = view->reference_row;
    const size_t rows = view->reference_rows;
    if (rows == 0) {
        return 1.0;
    }
    size_t above = 0;
    while (above < rows && row[above].theta <= theta) {
        above++;
    }
    if (above == 0 || above == rows) {
        return row[above == 0 ? 0 : rows - 1].factor;
    }
    const double share = (theta - row[above - 1].theta) / (row[above].theta - row[above - 1].theta);
    return (1.0 - share) * row[above - 1].factor + share * row[above].factor;
}

double gonio_instrument_value_factor(const gonio_instrument *instrument, gonio_pair pair)
{
    const gonio_instrument_view *view = &instrument->view;
    const double cosine = cos(pair.outgoing.theta);
    switch (view->values) {
    case GONIO_VALUE_FACTOR:
        return M_PI;
    case GONIO_VALUE_PERCENT:
        return 100.0 * M_PI;
    case GONIO_VALUE_COSINE:
        return cosine;
    case GONIO_VALUE_FACTOR_COSINE:
        return M_PI * cosine;
    case GONIO_VALUE_RELATIVE:
        return M_PI / reference_factor(view, pair.outgoing.theta);
    case GONIO_VALUE_COUNTS:
        return view->counts * cosine;
    case GONIO_VALUE_BRDF:
        break;
    }
    return 1.0;
}
