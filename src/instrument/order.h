/* Orders of readings: see order.c. */
#ifndef GONIO_ORDER_H
#define GONIO_ORDER_H

#include <gonio/instrument.h>

/* How much work goes into an order: with little it is found ten times faster, and takes up to one
 * per cent more time (docs/instrument.md). */
typedef enum gonio_i_order_effort { GONIO_I_ROUGH_ORDER, GONIO_I_FINE_ORDER } gonio_i_order_effort;

/* As gonio_instrument_order, which makes a fine one. */
gonio_status gonio_i_order(gonio_context *context, const gonio_instrument *instrument,
                           const gonio_setting *setting, const size_t *first, size_t count,
                           const gonio_setting *start, gonio_i_order_effort effort, size_t *order,
                           gonio_setting *chosen);

#endif
