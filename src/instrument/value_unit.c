/* What the numbers of readings are: see value_unit.h. */
#include "value_unit.h"

#include <math.h>

gonio_i_value_unit gonio_i_value_unit_of(const gonio_instrument *instrument)
{
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    return (gonio_i_value_unit){.kind = (int)view->values,
                                .counts = view->counts,
                                .rows = view->reference_rows,
                                .row = view->reference_row};
}

double gonio_i_reference_factor(const gonio_reference_row *row, size_t rows, double theta)
{
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

double gonio_i_value_factor(const gonio_i_value_unit *unit, double theta_o)
{
    switch (unit->kind) {
    case GONIO_VALUE_FACTOR:
        return M_PI;
    case GONIO_VALUE_PERCENT:
        return 100.0 * M_PI;
    case GONIO_VALUE_COSINE:
        return cos(theta_o);
    case GONIO_VALUE_FACTOR_COSINE:
        return M_PI * cos(theta_o);
    case GONIO_VALUE_RELATIVE:
        return M_PI / gonio_i_reference_factor(unit->row, unit->rows, theta_o);
    case GONIO_VALUE_COUNTS:
        return unit->counts * cos(theta_o);
    default:
        return 1.0;
    }
}
