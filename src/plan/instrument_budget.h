/* The most telling readings of an instrument that fit into a time. */
#ifndef GONIO_INSTRUMENT_BUDGET_H
#define GONIO_INSTRUMENT_BUDGET_H

#include "instrument_planner.h"

/* Chooses p->chosen[p->count] for options->budget. Errors: _ARGUMENT if not one reading fits;
 * _MEMORY, _CANCELLED. */
gonio_status gonio_i_choose_in_budget(gonio_i_planner *p);

#endif
