/* What the parts of a plan for an instrument share: see instrument_planner.h. */
#include "instrument_planner.h"

#include <stdlib.h>

#include "method.h"
#include "plan.h"

gonio_i_expected_error_problem gonio_i_planner_problem(const gonio_i_planner *p, size_t count,
                                                       double price, int sweeps)
{
    const gonio_i_choices *c = &p->offered.choices;
    return (gonio_i_expected_error_problem){.context = p->context,
                                            .f = c->f,
                                            .rows = c->rows,
                                            .components = c->components,
                                            .covariance =
                                                p->known != NULL ? p->known->covariance : NULL,
                                            .allowed = c->allowed,
                                            .variance = c->noise * c->noise,
                                            .count = count,
                                            .weights = p->weights,
                                            .row_variance = p->offered.variance,
                                            .group = p->offered.incidence,
                                            .groups = (size_t)p->offered.incidences,
                                            .price = price,
                                            .sweeps = sweeps};
}

gonio_status gonio_i_planner_make_room(gonio_i_planner *p, size_t count)
{
    if (count <= p->room) {
        return GONIO_OK;
    }
    free(p->chosen);
    free(p->remaining);
    p->chosen = gonio_i_allocate(p->context, count, sizeof *p->chosen);
    p->remaining = gonio_i_allocate(p->context, count + 1, sizeof *p->remaining);
    p->room = p->chosen != NULL && p->remaining != NULL ? count : 0;
    return p->room > 0 ? GONIO_OK : GONIO_ERROR_MEMORY;
}

gonio_status gonio_i_planner_choose(gonio_i_planner *p, size_t count, double price, int sweeps)
{
    gonio_i_expected_error_problem problem = gonio_i_planner_problem(p, count, price, sweeps);
    problem.enough = p->known == NULL ? gonio_i_enough_for(&p->error, p->options->target) : 0.0;
    gonio_status status = gonio_i_planner_make_room(p, count);
    if (status == GONIO_OK) {
        status = gonio_i_expected_error_search(&problem, p->chosen, p->remaining, &p->count);
    }
    return status;
}

gonio_status gonio_i_planner_run(const gonio_i_planner *p, size_t count,
                                 gonio_i_order_effort effort, gonio_i_run *run)
{
    return gonio_i_run_create(p->context, p->options->instrument, p->offered.setting, p->chosen,
                              count, p->options->nested, effort, run);
}
