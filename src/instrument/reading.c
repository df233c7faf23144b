/* What the numbers of an instrument's readings are, and how sure. */
#include <math.h>

#include "instrument.h"
#include "value_unit.h"

double gonio_instrument_deviation(const gonio_instrument *instrument, double value)
{
    return hypot(instrument->view.noise * value, instrument->view.floor);
}

double gonio_instrument_value_factor(const gonio_instrument *instrument, gonio_pair pair)
{
    const gonio_i_value_unit unit = gonio_i_value_unit_of(instrument);
    return gonio_i_value_factor(&unit, pair.outgoing.theta);
}
